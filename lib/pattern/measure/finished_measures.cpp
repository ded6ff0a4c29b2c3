#include <pattern/measure/cloth_rims.hpp>
#include <sloper/geometry/disjoint_sets.hpp>
#include <sloper/io/json.hpp>
#include <sloper/pattern/measure/finished_measures.hpp>
#include <sloper/pattern/measure/half_sewn.hpp>
#include <sloper/pattern/mesh/folds.hpp>
#include <sloper/pattern/mesh/mesh_pattern.hpp>

#include <algorithm>
#include <map>
#include <set>

namespace sloper::pattern {
namespace {

constexpr double COARSE = 0.02; // m, mesh edges: arcs lose less than 0.1 % to their chords
constexpr double PER_PIECE =
    0.25; // of the smallest panel's extent: pockets and belt loops have three vertices too
constexpr double FINEST = 0.002; // m

/// Coarse, but no coarser than the smallest piece can be meshed with.
double coarse_for(const Pattern& pattern) {
  double edge = COARSE;
  for (const Panel& panel : pattern.panels) {
    Vec2 low = Vec2::Constant(1e300), high = Vec2::Constant(-1e300);
    for (const PanelEdge& e : panel.loops[0])
      for (const Segment& s : e.path)
        for (double t : {0.0, 0.5, 1.0}) {
          low = low.cwiseMin(s.at(t));
          high = high.cwiseMax(s.at(t));
        }
    edge = std::min(edge, PER_PIECE * (high - low).maxCoeff());
  }
  return std::max(edge, FINEST);
}

std::vector<Opening> openings_of(const Pattern& pattern, const PanelMesh& mesh) {
  DisjointSets sewn(mesh.pattern.size());
  for (const MeshSeam& s : mesh.seams)
    for (std::size_t k = 0; k < s.a.size(); ++k)
      sewn.unite_into(s.a[k], s.b[k]);
  struct Side {
    int a, b, panel, n;
  };
  std::map<std::pair<int, int>, Side> sides; // by welded ends
  for (std::size_t p = 0; p < mesh.panels.size(); ++p)
    for (int t = mesh.panels[p].first_triangle;
         t < mesh.panels[p].first_triangle + mesh.panels[p].n_triangles; ++t)
      for (std::size_t k = 0; k < 3; ++k) {
        const int a = mesh.triangles[t][k], b = mesh.triangles[t][(k + 1) % 3];
        const int ra = sewn.find(a), rb = sewn.find(b);
        Side& side = sides
                         .try_emplace({std::min(ra, rb), std::max(ra, rb)},
                                      Side{a, b, static_cast<int>(p), 0})
                         .first->second;
        ++side.n;
      }
  DisjointSets loops(mesh.pattern.size());
  for (const auto& [ends, side] : sides)
    if (side.n == 1)
      loops.unite_into(ends.first, ends.second);
  std::map<int, Opening> found;
  std::map<int, std::map<int, std::set<std::string>>> names; // by opening, panel
  for (const auto& [ends, side] : sides) {
    if (side.n != 1)
      continue;
    const int id = loops.find(ends.first);
    const Vec2 &a = mesh.pattern[side.a], &b = mesh.pattern[side.b];
    found[id].length += (a - b).norm();
    found[id].rim.push_back({side.a, side.b});
    names[id][side.panel].insert(edge_nearest_to(pattern.panels[side.panel], 0.5 * (a + b)));
  }
  std::vector<Opening> out;
  for (auto& [id, opening] : found) {
    for (const auto& [panel, edges] : names[id])
      for (const std::string& edge : edges)
        opening.edges.push_back(pattern.panels[panel].name + ": " + edge);
    out.push_back(std::move(opening));
  }
  std::stable_sort(out.begin(), out.end(),
                   [](const Opening& a, const Opening& b) { return a.length > b.length; });
  return out;
}

} // namespace

FinishedMeasures finished_measures(const Pattern& pattern, const std::string& file) {
  const PanelMesh mesh = mesh_pattern(pattern, coarse_for(pattern), file);
  FinishedMeasures out;
  out.openings = openings_of(pattern, mesh);
  out.half_sewn = half_sewn(pattern, mesh);
  TrunkMeasures trunk = measure_trunk(pattern, mesh, out.openings);
  out.named = std::move(trunk.named);
  out.around = std::move(trunk.around);
  const Pattern sewn = with_folds(pattern, file);
  for (const Seam& s : sewn.seams)
    if (s.kind != "pleat")
      out.seams.push_back({s.name, 0.5 * (side_length(sewn, s.a) + side_length(sewn, s.b))});
  for (const Panel& p : pattern.panels)
    for (const auto& loop : p.loops) {
      std::vector<Path> paths;
      for (const PanelEdge& e : loop)
        paths.push_back(e.path);
      out.cloth_m2 += signed_area(paths);
    }
  return out;
}

io::Json measures_json(const FinishedMeasures& measures) {
  io::Json openings = io::Json::array(), seams = io::Json::array(), around = io::Json::array();
  for (const Opening& o : measures.openings)
    openings.push_back({{"edges", o.edges}, {"length_m", o.length}});
  for (const auto& [name, length] : measures.seams)
    seams.push_back({{"name", name}, {"length_m", length}});
  for (const auto& [depth, length] : measures.around)
    around.push_back({{"below_top_m", depth}, {"length_m", length}});
  io::Json named = io::Json::array();
  for (const NamedMeasure& m : measures.named)
    named.push_back({{"name", m.name}, {"length_m", m.value}, {"how", m.how}});
  return {{"named", named},
          {"openings", openings},
          {"seams", seams},
          {"around", around},
          {"cloth_m2", measures.cloth_m2}};
}

} // namespace sloper::pattern
