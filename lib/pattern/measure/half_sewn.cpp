#include <pattern/measure/arm_rims.hpp>
#include <pattern/measure/cloth_rims.hpp>
#include <pattern/panel_words.hpp>
#include <sloper/base/units.hpp>
#include <sloper/pattern/measure/half_sewn.hpp>

#include <algorithm>
#include <cmath>

namespace sloper::pattern {
namespace {

// Chosen on the 120 random specifications of GarmentCode, whose points of three or more pieces have
// at most 288 degrees of cloth, hoods apart, whose rim has no other corner.
constexpr double POINT_OF_THREE = 300;    // degrees of cloth around a point with three pieces
constexpr double POINT_OF_MORE = 270;     // with four or more
constexpr double FLATTEST_PIECE = 125;    // degrees of a piece that ends there; a slit's runs on
constexpr double RIM_TURNS = 45;          // degrees off straight at a corner of a rim
constexpr double SHORTEST_OPENING = 0.03; // m: less is no seam that was forgotten

bool turns(const RimVertex& v) {
  return std::abs(v.cloth - units::PI) > units::radians(RIM_TURNS);
}

bool is_point(const RimVertex& v) {
  const double least = v.pieces > 3 ? POINT_OF_MORE : POINT_OF_THREE;
  return v.pieces >= 3 && v.cloth > units::radians(least) &&
         std::max(v.cloth_arriving, v.cloth_leaving) < units::radians(FLATTEST_PIECE);
}

/// From vertex k on, with the walk or against it, to the next corner of the rim, m.
double open_from(const ClothRim& rim, std::size_t k, bool onwards) {
  const std::size_t n = rim.vertices.size();
  double sum = 0;
  for (std::size_t steps = 0; steps < n; ++steps) {
    sum += rim.vertices[onwards ? k : (k + n - 1) % n].to_next;
    k = (k + (onwards ? 1 : n - 1)) % n;
    if (turns(rim.vertices[k]))
      break;
  }
  return sum;
}

} // namespace

std::vector<PatternFinding> half_sewn(const Pattern& pattern, const PanelMesh& mesh) {
  std::vector<PatternFinding> out;
  const std::vector<ClothRim> rims = cloth_rims(mesh);
  for (const ClothRim& rim : rims) {
    const std::size_t n = rim.vertices.size();
    if (std::count_if(rim.vertices.begin(), rim.vertices.end(), turns) < 2)
      continue; // the opening of a hood
    for (std::size_t k = 0; k < n; ++k) {
      const RimVertex &v = rim.vertices[k], &before = rim.vertices[(k + n - 1) % n],
                      &after = rim.vertices[(k + 1) % n];
      if (!is_point(v))
        continue;
      const int p = panel_of_vertex(mesh, v.arriving), q = panel_of_vertex(mesh, v.leaving);
      if (says_neck(words_of(pattern, p)) && says_neck(words_of(pattern, q)))
        continue; // the ends of a collar
      const double open[2] = {open_from(rim, k, false), open_from(rim, k, true)};
      if (std::min(open[0], open[1]) < SHORTEST_OPENING)
        continue;
      const auto edge = [&](int panel, int a, int b) {
        const Vec2 middle = 0.5 * (mesh.pattern[a] + mesh.pattern[b]);
        return pattern.panels[panel].name + ": " + edge_nearest_to(pattern.panels[panel], middle);
      };
      out.push_back({"error", "half-sewn", edge(p, before.leaving, v.arriving),
                     "is open over " + centimetres(open[0]) + " and " +
                         edge(q, v.leaving, after.arriving) + " over " + centimetres(open[1]) +
                         " from where they meet, and " + std::to_string(v.pieces) +
                         " pieces come together there as where a seam should go on: is one sewn "
                         "to the other?"});
    }
  }
  const std::vector<PatternFinding> arms = half_sewn_arms(pattern, mesh, rims);
  out.insert(out.end(), arms.begin(), arms.end());
  return out;
}

} // namespace sloper::pattern
