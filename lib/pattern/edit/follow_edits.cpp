#include <pattern/mesh/smallest_angle.hpp>
#include <sloper/base/error.hpp>
#include <sloper/base/units.hpp>
#include <sloper/geometry/sparse_solver.hpp>
#include <sloper/pattern/edit/edits.hpp>

#include <algorithm>
#include <cmath>
#include <memory>

namespace sloper::pattern {

/// The panel edge and fraction of its length where a boundary point of `panel` lies.
struct PlaceOnEdge {
  int edge;
  double fraction;
  double off = 0; ///< m, of the point from there
};

/// One panel of a mesh, ready to follow its outline.
struct FollowedPanel {
  std::vector<std::array<int, 2>> edges; ///< of the mesh, global vertices
  std::vector<int> row;                  ///< by local vertex: of the system, -1 on the boundary
  std::vector<PlaceOnEdge> on;           ///< by local vertex: boundary only
  SparseSolver solver;
  int n_free = 0;
};

namespace {

/// Projects a boundary vertex to the nearest edge. Vertices lie on their edges exactly, so the
/// nearest is theirs; at corners either does.
PlaceOnEdge locate(const Panel& panel, const std::vector<ArcLength>& arcs, const Vec2& p) {
  PlaceOnEdge best{0, 0, 0};
  double least = 1e300;
  for (int e = 0; e < panel.n_edges(); ++e) {
    const ArcLength& arc = arcs[e];
    const int n = 64;
    int at = 0;
    double near = 1e300;
    for (int k = 0; k <= n; ++k) {
      const double d = (arc.at(arc.length() * k / n) - p).squaredNorm();
      if (d < near) {
        near = d;
        at = k;
      }
    }
    if (std::sqrt(near) > std::sqrt(least) + 2 * arc.length() / n)
      continue;
    double low = arc.length() * std::max(at - 1, 0) / n,
           high = arc.length() * std::min(at + 1, n) / n;
    for (int k = 0; k < 60; ++k) { // golden section; the distance has one minimum this near
      const double a = low + 0.381966 * (high - low), b = high - 0.381966 * (high - low);
      if ((arc.at(a) - p).squaredNorm() < (arc.at(b) - p).squaredNorm())
        high = b;
      else
        low = a;
    }
    for (double s : {0.5 * (low + high), 0.0, arc.length()}) {
      const double d = (arc.at(s) - p).squaredNorm();
      if (d < least - 1e-16) {
        least = d;
        best = {e, s / arc.length(), std::sqrt(d)};
      }
    }
  }
  return best;
}

/// Whether two patterns have the same panels, edges and seams, only elsewhere.
bool same_edges(const Pattern& a, const Pattern& b) {
  if (a.panels.size() != b.panels.size() || a.seams.size() != b.seams.size())
    return false;
  for (std::size_t p = 0; p < a.panels.size(); ++p) {
    if (a.panels[p].name != b.panels[p].name ||
        a.panels[p].loops.size() != b.panels[p].loops.size())
      return false;
    const auto meshed = [](const Panel& panel) {
      return std::count_if(panel.lines.begin(), panel.lines.end(),
                           [](const InnerLine& line) { return line.kind != "tape"; });
    };
    if (meshed(a.panels[p]) != meshed(b.panels[p]) ||
        a.panels[p].pleats.size() != b.panels[p].pleats.size())
      return false;
    for (std::size_t l = 0; l < a.panels[p].loops.size(); ++l) {
      if (a.panels[p].loops[l].size() != b.panels[p].loops[l].size())
        return false;
      for (std::size_t e = 0; e < a.panels[p].loops[l].size(); ++e)
        if (a.panels[p].loops[l][e].name != b.panels[p].loops[l][e].name)
          return false;
    }
  }
  for (std::size_t s = 0; s < a.seams.size(); ++s) {
    if (a.seams[s].name != b.seams[s].name || a.seams[s].open != b.seams[s].open)
      return false;
    for (const auto& [one, two] :
         {std::pair(&a.seams[s].a, &b.seams[s].a), std::pair(&a.seams[s].b, &b.seams[s].b)}) {
      if (one->size() != two->size())
        return false;
      for (std::size_t k = 0; k < one->size(); ++k)
        if ((*one)[k].panel != (*two)[k].panel || (*one)[k].edge != (*two)[k].edge ||
            (*one)[k].from != (*two)[k].from || (*one)[k].to != (*two)[k].to)
          return false;
    }
  }
  return true;
}

bool same_paths(const Panel& a, const Panel& b) {
  for (int e = 0; e < a.n_edges(); ++e) {
    const Path &p = a.edge(e).path, &q = b.edge(e).path;
    if (p.size() != q.size())
      return false;
    for (std::size_t s = 0; s < p.size(); ++s)
      if (p[s].p != q[s].p || p[s].line != q[s].line)
        return false;
  }
  return true;
}

/// Interior displacements are each the mean of their neighbours' (uniform weights on a quality
/// mesh).
void prepare(FollowedPanel& state, const Panel& panel, const PanelInfo& info,
             const PanelMesh& mesh) {
  std::vector<ArcLength> arcs;
  for (int e = 0; e < panel.n_edges(); ++e)
    arcs.emplace_back(panel.edge(e).path);
  auto& edges = state.edges;
  for (int t = info.first_triangle; t < info.first_triangle + info.n_triangles; ++t)
    for (std::size_t k = 0; k < 3; ++k) {
      const int a = mesh.triangles[t][k], b = mesh.triangles[t][(k + 1) % 3];
      edges.push_back({std::min(a, b), std::max(a, b)});
    }
  std::sort(edges.begin(), edges.end());
  std::vector<char> boundary(static_cast<std::size_t>(info.n_vertices),
                             0); // on an edge with one triangle
  for (std::size_t k = 0; k < edges.size();) {
    std::size_t next = k + 1;
    while (next < edges.size() && edges[next] == edges[k])
      ++next;
    if (next - k == 1)
      for (int v : edges[k])
        boundary[v - info.first_vertex] = 1;
    k = next;
  }
  edges.erase(std::unique(edges.begin(), edges.end()), edges.end());
  state.row.assign(boundary.size(), -1);
  state.on.assign(boundary.size(), PlaceOnEdge{0, 0, 0});
  for (std::size_t v = 0; v < boundary.size(); ++v)
    if (boundary[v])
      state.on[v] =
          locate(panel, arcs, mesh.pattern[static_cast<std::size_t>(info.first_vertex) + v]);
    else
      state.row[v] = state.n_free++;
  if (state.n_free == 0)
    return;
  std::vector<Eigen::Triplet<double>> entries;
  for (const auto& e : edges)
    for (int turn = 0; turn < 2; ++turn) {
      const int a = state.row[e[turn ? 1 : 0] - info.first_vertex],
                b = state.row[e[turn ? 0 : 1] - info.first_vertex];
      if (a < 0)
        continue;
      entries.emplace_back(a, a, 1.0);
      if (b >= 0)
        entries.emplace_back(a, b, -1.0);
    }
  Eigen::SparseMatrix<double> matrix(state.n_free, state.n_free);
  matrix.setFromTriplets(entries.begin(), entries.end());
  state.solver.compute(matrix);
}

} // namespace

struct MeshFollower::State {
  Pattern before;
  std::vector<Vec2> original;
  std::vector<FollowedPanel> panels;
};

MeshFollower::MeshFollower(const Pattern& before, const PanelMesh& mesh)
    : m_state(std::make_unique<State>()) {
  m_state->before = before;
  m_state->original = mesh.pattern;
  m_state->panels = std::vector<FollowedPanel>(mesh.panels.size());
  if (before.panels.size() != mesh.panels.size())
    throw input_error("mesh.other-pattern"_id, "", "pattern",
                      "the mesh was made from another pattern", "mesh the pattern again");
  for (std::size_t p = 0; p < mesh.panels.size(); ++p)
    prepare(m_state->panels[p], before.panels[p], mesh.panels[p], mesh);
}
MeshFollower::~MeshFollower() = default;
MeshFollower::MeshFollower(MeshFollower&&) noexcept = default;

double MeshFollower::off_outline() const {
  double most = 0;
  for (const FollowedPanel& s : m_state->panels)
    for (const PlaceOnEdge& on : s.on)
      most = std::max(most, on.off);
  return most;
}

bool MeshFollower::follow(const Pattern& after, PanelMesh& mesh, double least_angle_deg) const {
  if (!same_edges(m_state->before, after))
    return false;
  const std::vector<Vec2>& original = m_state->original;
  std::vector<Vec2> moved = original;
  for (std::size_t p = 0; p < mesh.panels.size(); ++p) {
    const PanelInfo& info = mesh.panels[p];
    const FollowedPanel& state = m_state->panels[p];
    const Panel& panel = after.panels[p];
    if (same_paths(m_state->before.panels[p], panel))
      continue;
    std::vector<ArcLength> arcs;
    for (int e = 0; e < panel.n_edges(); ++e)
      arcs.emplace_back(panel.edge(e).path);
    const std::size_t first = static_cast<std::size_t>(info.first_vertex);
    for (std::size_t v = 0; v < state.row.size(); ++v)
      if (state.row[v] < 0) {
        const ArcLength& arc = arcs[state.on[v].edge];
        moved[first + v] = arc.at(state.on[v].fraction * arc.length());
      }
    if (state.n_free > 0) {
      Eigen::MatrixXd right = Eigen::MatrixXd::Zero(state.n_free, 2);
      for (const auto& e : state.edges)
        for (int turn = 0; turn < 2; ++turn) {
          const std::size_t a = static_cast<std::size_t>(e[turn ? 1 : 0]) - first,
                            b = static_cast<std::size_t>(e[turn ? 0 : 1]) - first;
          if (state.row[a] >= 0 && state.row[b] < 0)
            right.row(state.row[a]) += (moved[first + b] - original[first + b]).transpose();
        }
      const Eigen::MatrixXd shift = state.solver.solve(right);
      for (std::size_t v = 0; v < state.row.size(); ++v)
        if (state.row[v] >= 0)
          moved[first + v] += shift.row(state.row[v]).transpose();
    }
    for (int t = info.first_triangle; t < info.first_triangle + info.n_triangles; ++t) {
      const Triangle& k = mesh.triangles[t];
      const auto angle = [&](const std::vector<Vec2>& at) {
        return smallest_angle(at[k[0]], at[k[1]], at[k[2]]);
      };
      if (const double now = angle(moved);
          now < units::radians(least_angle_deg) && now < angle(original) - 1e-9)
        return false;
    }
  }
  mesh.pattern = std::move(moved); // ids stay: they are those of the panel before the edits
  for (MeshSeam& s : mesh.seams)
    for (const Seam& seam : after.seams)
      if (seam.name == s.name) {
        s.length_a = side_length(after, seam.a);
        s.length_b = side_length(after, seam.b);
      }
  for (std::size_t p = 0; p < mesh.panels.size(); ++p)
    mesh.panels[p].grain = after.panels[p].grain;
  return true;
}

bool follow_edits(const Pattern& before, const Pattern& after, PanelMesh& mesh,
                  double least_angle_deg) {
  if (!same_edges(before, after))
    return false;
  if (!MeshFollower(before, mesh).follow(after, mesh, least_angle_deg))
    return false;
  mesh.source = std::make_shared<Pattern>(after);
  return true;
}

} // namespace sloper::pattern
