#include <pattern/mesh/smallest_angle.hpp>
#include <pattern/mesh/triangulate.hpp>
#include <sloper/base/error.hpp>
#include <sloper/base/parallel.hpp>
#include <sloper/base/units.hpp>
#include <sloper/pattern/mesh/boundary.hpp>
#include <sloper/pattern/mesh/folds.hpp>
#include <sloper/pattern/mesh/mesh_pattern.hpp>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <map>
#include <optional>

namespace sloper::pattern {
namespace {

/// What drape cannot use: a triangle without area, or with next to none.
void require_area(const PanelMesh& mesh, const PanelInfo& panel, const std::string& file) {
  // A triangle of 15 mm that is 1.5 um high: strain from it would be noise of the coordinates.
  constexpr double LEAST_HEIGHT = 1e-4; // of the longest edge
  for (int t = panel.first_triangle; t < panel.first_triangle + panel.n_triangles; ++t) {
    const Triangle& tri = mesh.triangles[t];
    const Vec2 a = mesh.pattern[tri[0]], b = mesh.pattern[tri[1]], c = mesh.pattern[tri[2]];
    const Vec2 u = b - a, v = c - a;
    const double longest = std::max({u.squaredNorm(), v.squaredNorm(), (c - b).squaredNorm()});
    if (u.x() * v.y() - u.y() * v.x() > LEAST_HEIGHT * longest)
      continue;
    const Vec2 where = (a + b + c) / 3 * 100;
    char text[120];
    std::snprintf(text, sizeof text, "the mesh has a triangle without area at (%.1f, %.1f) cm",
                  where.x(), where.y());
    throw input_error("mesh.flat-triangle"_id, file, panel.name, text,
                      "move or leave out the corner or the line that lies there, or give another "
                      "--edge-length");
  }
}

void list_small_angles(PanelMesh& mesh, const PanelInfo& panel) {
  int n = 0;
  double worst = units::PI;
  Vec2 where = Vec2::Zero();
  for (int t = panel.first_triangle; t < panel.first_triangle + panel.n_triangles; ++t) {
    const Triangle& tri = mesh.triangles[t];
    const auto at = [&](std::size_t k) { return mesh.pattern[tri[k]]; };
    const double angle = smallest_angle(at(0), at(1), at(2));
    if (angle < units::radians(25))
      ++n;
    if (angle < worst) {
      worst = angle;
      where = (at(0) + at(1) + at(2)) / 3;
    }
  }
  if (n == 0)
    return;
  char text[160];
  std::snprintf(text, sizeof text,
                "%s: %d triangle%s below 25 degrees, the smallest %.1f at (%.1f, %.1f) cm",
                panel.name.c_str(), n, n == 1 ? "" : "s", units::degrees(worst), where.x() * 100,
                where.y() * 100);
  mesh.findings.push_back({"mesh.small-angle"_id, text});
}

/// Edge length of a panel, m.
double length_of(const MeshLengths& lengths, std::size_t panel) {
  return panel < lengths.of_panel.size() ? lengths.of_panel[panel] : lengths.usual;
}

/// What edges of panel `p` ask for, m: along seams that of seams, and that of the panel at the
/// other side where it is finer.
std::vector<double> length_along_edges(const Pattern& pattern, std::size_t p, double seam,
                                       const MeshLengths& lengths) {
  const double own = length_of(lengths, p);
  std::vector<double> out(static_cast<std::size_t>(pattern.panels[p].n_edges()), own);
  const auto look = [&](const std::vector<Run>& side, const std::vector<Run>& other) {
    double least = seam > 0 ? seam : own;
    for (const Run& run : other)
      least = std::min(least, length_of(lengths, run.panel));
    for (const Run& run : side)
      if (run.panel == static_cast<int>(p))
        out[run.edge] = std::min(out[run.edge], least);
  };
  for (const Seam& s : pattern.seams) {
    look(s.a, s.b);
    look(s.b, s.a);
  }
  return out;
}

/// Fine along the seams of a panel where that is asked for, and where finer panels are sewn to it.
SizeField size_field(const Pattern& pattern, std::size_t p, const Boundary::PanelBoundary& boundary,
                     double seam, const MeshLengths& lengths) {
  const double own = length_of(lengths, p);
  const std::vector<double> along = length_along_edges(pattern, p, seam, lengths);
  const double fine = *std::min_element(along.begin(), along.end());
  if (fine >= own)
    return SizeField(own);
  std::vector<std::array<Vec2, 2>> lines;
  std::size_t v = 0;
  for (const auto& loop : boundary.loops)
    for (std::size_t k = 0; k < loop.size(); ++k, ++v)
      if (along[boundary.edge_of[v]] < own)
        lines.push_back({loop[k], loop[(k + 1) % loop.size()]});
  return SizeField(own, fine, std::move(lines));
}

double distance_to_line(const std::vector<Vec2>& loop, bool closed, const Vec2& p) {
  double least = 1e300;
  for (std::size_t k = 0; k + (closed ? 0 : 1) < loop.size(); ++k) {
    const Vec2 a = loop[k], along = loop[(k + 1) % loop.size()] - a;
    const double t = along.squaredNorm() > 0
                         ? std::clamp((p - a).dot(along) / along.squaredNorm(), 0.0, 1.0)
                         : 0.0;
    least = std::min(least, (p - a - t * along).norm());
  }
  return least;
}

/// Distance to the chains of a line so far, less the stretch that the next point continues.
double distance_to_own(const std::vector<std::vector<Vec2>>& chains, const Vec2& p) {
  double least = 1e300;
  for (std::size_t k = 0; k + 1 < chains.size(); ++k)
    least = std::min(least, distance_to_line(chains[k], false, p));
  const std::vector<Vec2>& last = chains.back();
  if (last.size() > 2)
    least = std::min(least, distance_to_line({last.begin(), last.end() - 1}, false, p));
  return least;
}

/// Inner lines as chains of mesh points. A line that comes too near to the outline, to a line
/// before it or to itself is left out, with a finding. The chain of a closed line ends on the very
/// point that it starts from.
std::vector<std::vector<Vec2>> sampled_lines(const Panel& panel,
                                             const Boundary::PanelBoundary& boundary, double h,
                                             std::vector<Message>& findings) {
  constexpr double CLEAR = 0.55;    // edge lengths
  constexpr double CLOSED_M = 1e-6; // between the ends of a line; readers close gaps up to it
  std::vector<std::vector<Vec2>> out;
  for (const InnerLine& line : panel.lines) {
    const ArcLength arc(line.path);
    const int n = std::max(1, static_cast<int>(std::lround(arc.length() / h)));
    if (arc.length() < 0.5 * h)
      continue;
    const bool closed = (arc.at(0) - arc.at(arc.length())).norm() < CLOSED_M;
    if (closed && n < 3) {
      findings.push_back({"mesh.line-left-out"_id,
                          panel.name + ": line " + line.name + " is closed and only " +
                              centimetres(arc.length()) + " long, smaller than the mesh's edges (" +
                              centimetres(h) + "), and is left out"});
      continue;
    }
    std::vector<std::vector<Vec2>> chains(1);
    std::optional<Vec2> first; // of a closed line, where it is not left out
    int n_left_out = 0;
    double farthest = 0; // of what is left out, from the outline
    for (int k = 0; k <= n; ++k) {
      if (k == n && first) {
        chains.back().push_back(*first);
        continue;
      }
      Vec2 p = arc.at(arc.length() * k / n);
      bool fits = true;
      double to_outline = 1e300;
      for (const auto& loop : boundary.loops) {
        const auto on = std::find_if(loop.begin(), loop.end(),
                                     [&](const Vec2& q) { return (p - q).norm() < 1e-6; });
        if ((k == 0 || k == n) && on != loop.end()) {
          p = *on;
          break;
        }
        to_outline = std::min(to_outline, distance_to_line(loop, true, p));
        fits = to_outline > CLEAR * h;
      }
      for (const auto& other : out)
        fits = fits && distance_to_line(other, false, p) > CLEAR * h;
      fits = fits && distance_to_own(chains, p) > CLEAR * h;
      if (fits)
        chains.back().push_back(p);
      else {
        ++n_left_out;
        farthest = std::max(farthest, to_outline);
        chains.push_back({});
      }
      if (k == 0 && closed && fits)
        first = p;
    }
    for (auto& chain : chains)
      if (chain.size() >= 2)
        out.push_back(std::move(chain));
    if (line.kind == "roll" && n_left_out + 2 > n && farthest < LINE_ON_EDGE)
      continue; // along an edge, which the mesh has
    if (n_left_out > 2 ||
        n_left_out ==
            n + 1) // the ends of a line may be a little short of an outline that it does not reach
      findings.push_back({"mesh.line-left-out"_id,
                          panel.name + ": line " + line.name + " runs within " +
                              centimetres(CLEAR * h) + " of the outline or of another line; " +
                              std::to_string(n_left_out) + " of its " + std::to_string(n + 1) +
                              " points are left out"});
  }
  return out;
}

/// More vertices than any drape could bear come of a unit that is none, and would fill the memory
/// first.
void require_few_vertices(const Pattern& pattern, const PanelMesh& mesh, const std::string& file) {
  constexpr double MOST_VERTICES = 5e6;
  double area = 0;
  for (const Panel& p : pattern.panels)
    area += p.area();
  const double n = area / (mesh.edge_length * mesh.edge_length * std::sqrt(0.75));
  if (!(n <= MOST_VERTICES))
    throw input_error("mesh.too-many-vertices"_id, file, pattern.name,
                      "would have " + std::to_string(std::lround(std::min(n, 1e15))) +
                          " vertices at an edge length of " + centimetres(mesh.edge_length),
                      "give a larger --edge-length, or check the pattern's unit");
}

} // namespace

struct MeshMemory::Panels {
  struct Task { ///< what the triangles of a panel depend on
    std::vector<std::vector<Vec2>> loops, lines;
    std::vector<char> must_split;
    SizeField size;
    bool operator==(const Task&) const = default;
  };
  std::vector<Task> tasks;
  std::vector<FlatMesh> flat; ///< of each task
};
MeshMemory::MeshMemory() : m_panels(std::make_unique<Panels>()) {}
MeshMemory::~MeshMemory() = default;
MeshMemory::MeshMemory(MeshMemory&&) noexcept = default;

MeshLengths lengths_for_rolls(const Pattern& pattern, double usual, double seam) {
  MeshLengths out{.usual = usual, .seam = seam};
  for (const Panel& panel : pattern.panels)
    out.of_panel.push_back(edge_length_for_rolls(panel, usual));
  return out;
}

PanelMesh mesh_pattern(const Pattern& drawn, double edge_length, const std::string& file,
                       double seam_length, MeshMemory* memory) {
  return mesh_pattern(drawn, MeshLengths{.usual = edge_length, .seam = seam_length}, file, memory);
}

PanelMesh mesh_pattern(const Pattern& drawn, const MeshLengths& lengths, const std::string& file,
                       MeshMemory* memory) {
  const Pattern pattern = with_folds(drawn, file);
  PanelMesh mesh;
  mesh.name = pattern.name;
  mesh.edge_length = lengths.usual;
  mesh.seam_length = lengths.seam > 0 && lengths.seam < lengths.usual ? lengths.seam : 0;
  mesh.source = std::make_shared<Pattern>(drawn);
  mesh.findings = pattern.findings;
  const Boundary boundary =
      sample_boundary(pattern, lengths.usual, file, mesh.seam_length, lengths.of_panel);
  mesh.findings.insert(mesh.findings.end(), boundary.findings.begin(), boundary.findings.end());

  std::vector<FlatMesh> flat(pattern.panels.size());
  std::vector<std::string> failed(pattern.panels.size());
  std::vector<MeshMemory::Panels::Task> tasks;
  for (std::size_t p = 0; p < pattern.panels.size(); ++p) {
    const Boundary::PanelBoundary& b = boundary.panels[p];
    tasks.push_back({b.loops,
                     sampled_lines(pattern.panels[p], b, length_of(lengths, p), mesh.findings),
                     b.must_split, size_field(pattern, p, b, mesh.seam_length, lengths)});
  }
  require_few_vertices(pattern, mesh, file);
  parallel_for(pattern.panels.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t p = begin; p < end; ++p) {
      try {
        const auto& task = tasks[p];
        if (memory)
          if (const auto same =
                  std::find(memory->m_panels->tasks.begin(), memory->m_panels->tasks.end(), task);
              same != memory->m_panels->tasks.end()) {
            flat[p] = memory->m_panels->flat[same - memory->m_panels->tasks.begin()];
            continue;
          }
        flat[p] =
            triangulate(task.loops, task.size, task.must_split, pattern.panels[p].name, task.lines);
      } catch (const Error& e) {
        failed[p] = e.fact();
      }
    }
  });
  for (std::size_t p = 0; p < flat.size(); ++p)
    if (!failed[p].empty())
      throw input_error("pattern.outline-crosses"_id, file, pattern.panels[p].name, failed[p],
                        "pattern-mesh --check names the edges");

  for (std::size_t p = 0; p < flat.size(); ++p) {
    const Panel& source = pattern.panels[p];
    PanelInfo info;
    info.name = source.name;
    info.grain = source.grain;
    info.material = source.material;
    info.layer = source.layer;
    info.part = source.hint.part;
    info.first_vertex = static_cast<int>(mesh.pattern.size());
    info.n_vertices = static_cast<int>(flat[p].points.size());
    info.first_triangle = static_cast<int>(mesh.triangles.size());
    info.n_triangles = static_cast<int>(flat[p].triangles.size());
    for (std::size_t k = 0; k < boundary.panels[p].loops[0].size(); ++k)
      info.outline.push_back(info.first_vertex + static_cast<int>(k));
    Vec2 low = Vec2::Constant(1e300), high = Vec2::Constant(-1e300);
    for (const Vec2& q : flat[p].points) {
      low = low.cwiseMin(q);
      high = high.cwiseMax(q);
    }
    const Mat4 rigid = source.hint.rigid.value_or(Mat4::Identity());
    for (const Vec2& q : flat[p].points) {
      mesh.pattern.push_back(q);
      mesh.placed.push_back((rigid * Eigen::Vector4d(q.x(), q.y(), 0, 1)).head<3>());
      mesh.ids.push_back({static_cast<int>(p), (q.x() - low.x()) / (high.x() - low.x()),
                          (q.y() - low.y()) / (high.y() - low.y())});
    }
    for (const Triangle& t : flat[p].triangles)
      mesh.triangles.push_back(
          {t[0] + info.first_vertex, t[1] + info.first_vertex, t[2] + info.first_vertex});
    mesh.panels.push_back(info);
    require_area(mesh, mesh.panels.back(), file);
    list_small_angles(mesh, mesh.panels.back());
  }
  if (memory)
    *memory->m_panels = {std::move(tasks), std::move(flat)};
  for (std::size_t s = 0; s < pattern.seams.size(); ++s) {
    const Seam& seam = pattern.seams[s];
    MeshSeam out{
        seam.name, seam.kind, {}, {}, side_length(pattern, seam.a), side_length(pattern, seam.b),
        seam.open};
    for (std::size_t k = 0; k < boundary.seams[s].a.size(); ++k) {
      const auto &a = boundary.seams[s].a[k], &b = boundary.seams[s].b[k];
      out.a.push_back(mesh.panels[a[0]].first_vertex + a[1]);
      out.b.push_back(mesh.panels[b[0]].first_vertex + b[1]);
    }
    if (out.a.size() < 2) {
      mesh.findings.push_back(
          {"mesh.seam-left-out"_id,
           "seam " + seam.name + " is shorter than a fifth of the edge length and is left out"});
      continue;
    }
    mesh.seams.push_back(std::move(out));
  }
  return mesh;
}

} // namespace sloper::pattern
