#include <base/units.hpp>
#include <pattern/edits.hpp>
#include <pattern/triangulate.hpp>

#include <Eigen/SparseCholesky>

#include <algorithm>
#include <cmath>

namespace sloper::pattern {
namespace {

/// The panel edge and fraction of its length where a boundary point of `panel` lies.
struct OnEdge {
  int edge;
  double fraction;
};

/// Projects a boundary vertex to the nearest edge. Vertices lie on their edges exactly, so the nearest is theirs; at corners either does.
OnEdge locate(const Panel& panel, const std::vector<ArcLength>& arcs, const Vec2& p) {
  OnEdge best{0, 0};
  double least = 1e300;
  for (int e = 0; e < panel.n_edges(); ++e) {
    const ArcLength& arc = arcs[static_cast<std::size_t>(e)];
    const int n = 64;
    int at = 0;
    double near = 1e300;
    for (int k = 0; k <= n; ++k) {
      const double d = (arc.at(arc.length() * k / n) - p).squaredNorm();
      if (d < near) near = d, at = k;
    }
    if (std::sqrt(near) > std::sqrt(least) + 2 * arc.length() / n) continue;
    double low = arc.length() * std::max(at - 1, 0) / n, high = arc.length() * std::min(at + 1, n) / n;
    for (int k = 0; k < 60; ++k) { // golden section; the distance has one minimum this near
      const double a = low + 0.381966 * (high - low), b = high - 0.381966 * (high - low);
      if ((arc.at(a) - p).squaredNorm() < (arc.at(b) - p).squaredNorm()) high = b;
      else low = a;
    }
    for (double s : {0.5 * (low + high), 0.0, arc.length()}) {
      const double d = (arc.at(s) - p).squaredNorm();
      if (d < least - 1e-16) least = d, best = {e, s / arc.length()};
    }
  }
  return best;
}

} // namespace

/// Whether two patterns have the same panels, edges and seams, only elsewhere.
static bool same_edges(const Pattern& a, const Pattern& b) {
  if (a.panels.size() != b.panels.size() || a.seams.size() != b.seams.size()) return false;
  for (std::size_t p = 0; p < a.panels.size(); ++p) {
    if (a.panels[p].name != b.panels[p].name || a.panels[p].loops.size() != b.panels[p].loops.size()) return false;
    for (std::size_t l = 0; l < a.panels[p].loops.size(); ++l) {
      if (a.panels[p].loops[l].size() != b.panels[p].loops[l].size()) return false;
      for (std::size_t e = 0; e < a.panels[p].loops[l].size(); ++e)
        if (a.panels[p].loops[l][e].name != b.panels[p].loops[l][e].name) return false;
    }
  }
  for (std::size_t s = 0; s < a.seams.size(); ++s) {
    if (a.seams[s].name != b.seams[s].name) return false;
    for (const auto& [one, two] : {std::pair(&a.seams[s].a, &b.seams[s].a), std::pair(&a.seams[s].b, &b.seams[s].b)}) {
      if (one->size() != two->size()) return false;
      for (std::size_t k = 0; k < one->size(); ++k)
        if ((*one)[k].panel != (*two)[k].panel || (*one)[k].edge != (*two)[k].edge || (*one)[k].from != (*two)[k].from || (*one)[k].to != (*two)[k].to)
          return false;
    }
  }
  return true;
}

bool follow_edits(const Pattern& before, const Pattern& after, PanelMesh& mesh, double least_angle_deg) {
  if (!same_edges(before, after)) return false;
  std::vector<Vec2> moved = mesh.pattern;
  for (std::size_t p = 0; p < mesh.panels.size(); ++p) {
    const PanelInfo& info = mesh.panels[p];
    const Panel &old_panel = before.panels[p], &new_panel = after.panels[p];
    std::vector<ArcLength> old_arcs, new_arcs;
    for (int e = 0; e < old_panel.n_edges(); ++e) old_arcs.emplace_back(old_panel.edge(e).path), new_arcs.emplace_back(new_panel.edge(e).path);
    // Boundary vertices are those of an edge with one triangle.
    std::vector<std::array<int, 2>> edges;
    for (int t = info.first_triangle; t < info.first_triangle + info.n_triangles; ++t)
      for (std::size_t k = 0; k < 3; ++k) {
        const int a = mesh.triangles[static_cast<std::size_t>(t)][k], b = mesh.triangles[static_cast<std::size_t>(t)][(k + 1) % 3];
        edges.push_back({std::min(a, b), std::max(a, b)});
      }
    std::sort(edges.begin(), edges.end());
    std::vector<char> boundary(static_cast<std::size_t>(info.n_vertices), 0);
    for (std::size_t k = 0; k < edges.size();) {
      std::size_t next = k + 1;
      while (next < edges.size() && edges[next] == edges[k]) ++next;
      if (next - k == 1)
        for (int v : edges[k]) boundary[static_cast<std::size_t>(v - info.first_vertex)] = 1;
      k = next;
    }
    edges.erase(std::unique(edges.begin(), edges.end()), edges.end());
    // Interior displacements: each the mean of its neighbours' (uniform weights on a quality mesh).
    std::vector<int> row(boundary.size(), -1);
    int n_free = 0;
    for (std::size_t v = 0; v < boundary.size(); ++v) {
      const std::size_t g = static_cast<std::size_t>(info.first_vertex) + v;
      if (!boundary[v]) {
        row[v] = n_free++;
        continue;
      }
      const OnEdge on = locate(old_panel, old_arcs, mesh.pattern[g]);
      const ArcLength& arc = new_arcs[static_cast<std::size_t>(on.edge)];
      moved[g] = arc.at(on.fraction * arc.length());
    }
    if (n_free > 0) {
      std::vector<Eigen::Triplet<double>> entries;
      Eigen::MatrixXd right = Eigen::MatrixXd::Zero(n_free, 2);
      for (const auto& e : edges)
        for (int turn = 0; turn < 2; ++turn) {
          const std::size_t a = static_cast<std::size_t>(e[turn ? 1 : 0] - info.first_vertex),
                            b = static_cast<std::size_t>(e[turn ? 0 : 1] - info.first_vertex);
          if (row[a] < 0) continue;
          entries.emplace_back(row[a], row[a], 1.0);
          const std::size_t g = static_cast<std::size_t>(info.first_vertex) + b;
          if (row[b] >= 0) entries.emplace_back(row[a], row[b], -1.0);
          else right.row(row[a]) += (moved[g] - mesh.pattern[g]).transpose();
        }
      Eigen::SparseMatrix<double> matrix(n_free, n_free);
      matrix.setFromTriplets(entries.begin(), entries.end());
      const Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> solver(matrix);
      const Eigen::MatrixXd shift = solver.solve(right);
      for (std::size_t v = 0; v < row.size(); ++v)
        if (row[v] >= 0) moved[static_cast<std::size_t>(info.first_vertex) + v] += shift.row(row[v]).transpose();
    }
  }
  for (const Triangle& t : mesh.triangles)
    if (smallest_angle(moved[static_cast<std::size_t>(t[0])], moved[static_cast<std::size_t>(t[1])], moved[static_cast<std::size_t>(t[2])]) <
        units::radians(least_angle_deg))
      return false;
  mesh.pattern = std::move(moved); // ids stay: they are those of the panel before the edits
  for (MeshSeam& s : mesh.seams)
    for (const Seam& seam : after.seams)
      if (seam.name == s.name) s.length_a = side_length(after, seam.a), s.length_b = side_length(after, seam.b);
  for (std::size_t p = 0; p < mesh.panels.size(); ++p) mesh.panels[p].grain = after.panels[p].grain;
  return true;
}

} // namespace sloper::pattern
