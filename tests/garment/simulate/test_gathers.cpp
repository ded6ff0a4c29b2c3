/// Gathers: cloth folded finer than the mesh does not stretch what it is gathered into.
#include <gtest/gtest.h>
#include <sloper/garment/sewing.hpp>
#include <sloper/io/json.hpp>
#include <sloper/pattern/mesh/mesh_pattern.hpp>
#include <sloper/pattern/read/read_pattern.hpp>

#include <algorithm>
#include <cmath>

using namespace sloper;
using namespace sloper::garment;

namespace {

/// A piece of 40 x 20 cm whose upper edge is gathered into a band of `band` cm; welded.
Garment gathered(double band) {
  const std::string b = std::to_string(band);
  const std::string text =
      R"({"format": "pattern", "version": 1, "length_unit": "cm", "name": "piece", "panels": [
    {"name": "piece", "outline": [{"edge": "hem", "path": [["M", 0, 0], ["L", 40, 0]]}, {"edge": "left", "path": [["L", 40, 20]]},
      {"edge": "top", "path": [["L", 0, 20]]}, {"edge": "right", "path": [["L", 0, 0]]}]},
    {"name": "band", "outline": [{"edge": "low", "path": [["M", 0, 0], ["L", )" +
      b + R"(, 0]]}, {"edge": "left", "path": [["L", )" + b + R"(, 4]]},
      {"edge": "up", "path": [["L", 0, 4]]}, {"edge": "right", "path": [["L", 0, 0]]}]}],
    "seams": [{"name": "top", "kind": "gather", "a": [{"panel": "piece", "edge": "top"}], "b": [{"panel": "band", "edge": "low", "from": 1, "to": 0}]}]})";
  const pattern::Pattern source =
      pattern::read_pattern_json(io::parse_json(text, "piece"), "piece");
  Garment garment;
  garment.panels = pattern::mesh_pattern(source, 0.015, "piece");
  weld(garment, garment.panels.placed);
  return garment;
}

/// Rest length over pattern length of the piece's springs whose middles lie that far below the
/// gather and that run along it or up.
std::pair<double, double> rest_share(const Garment& garment, double from, double to, bool level) {
  const cloth::ClothMesh mesh = cloth_mesh_of(garment);
  std::pair<double, double> range(1e300, -1e300);
  const pattern::PanelInfo& piece = garment.panels.panels[0];
  for (int f = 0; f < piece.n_triangles; ++f)
    for (int k = 0; k < 3; ++k) {
      const Triangle& t = garment.panels.triangles[piece.first_triangle + f];
      const Vec2 &p = garment.panels.pattern[t[k]], &q = garment.panels.pattern[t[(k + 1) % 3]];
      const double down = 0.2 - 0.5 * (p.y() + q.y()), slope = std::abs(q.y() - p.y()),
                   across = std::abs(q.x() - p.x());
      if (down < from || down > to || (level ? across < 5 * slope : slope < 5 * across))
        continue;
      const int i = garment.particle_of[t[k]], j = garment.particle_of[t[(k + 1) % 3]];
      const std::array<int, 2> edge{std::min(i, j), std::max(i, j)};
      const auto at = std::lower_bound(mesh.edges.begin(), mesh.edges.end(), edge);
      const double share = mesh.springs[at - mesh.edges.begin()].rest_length / (q - p).norm();
      range = {std::min(range.first, share), std::max(range.second, share)};
    }
  return range;
}

} // namespace

TEST(Gathers, ClothBesideThemHasTheLengthThatItsFoldsLeaveAndFartherOffItsOwn) {
  const Garment half = gathered(20);
  EXPECT_NEAR(rest_share(half, -1e-6, 1e-6, true).second, 0.5, 1e-6) << "along the seam";
  const auto beside = rest_share(half, 0.005, 0.016, true);
  EXPECT_GT(beside.first, 0.5);
  EXPECT_LT(beside.second, 0.9) << "the next row";
  EXPECT_NEAR(rest_share(half, 0.06, 0.2, true).first, 1, 1e-9);
  EXPECT_NEAR(rest_share(half, 0, 0.2, false).first, 1, 0.02) << "across the seam";
}

TEST(Gathers, EaseOfAFewHundredthsIsNone) {
  const Garment eased = gathered(39);
  EXPECT_NEAR(rest_share(eased, 0.004, 0.2, true).first, 1, 1e-9);
}
