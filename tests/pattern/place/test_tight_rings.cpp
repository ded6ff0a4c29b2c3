#include <support/pattern_texts.hpp>

#include <gtest/gtest.h>
#include <pattern/place/tight_rings.hpp>
#include <sloper/base/units.hpp>

#include <cmath>

namespace sloper::pattern::test {
namespace {

constexpr double RADIUS = 0.07; // m, of a leg that is a cylinder

/// A cylinder alone, `height` m high: a left leg or a trunk.
body::Body column(body::Part part, double height) {
  constexpr int AROUND = 48;
  body::Body body;
  for (int k = 0; k < AROUND; ++k)
    for (const double y : {0.0, height}) {
      const double angle = 2 * units::PI * k / AROUND;
      body.skin.positions.push_back({RADIUS * std::sin(angle), y, RADIUS * std::cos(angle)});
    }
  for (int k = 0; k < AROUND; ++k) {
    const int a = 2 * k, b = 2 * ((k + 1) % AROUND);
    body.skin.triangles.push_back({a, b, b + 1});
    body.skin.triangles.push_back({a, b + 1, a + 1});
  }
  body.face_part.assign(body.skin.triangles.size(), part);
  return body;
}

/// Front and back of a cuff, each so wide, placed as flat pieces before and behind the leg.
Pattern cuff(double width_cm) {
  const std::string w = std::to_string(width_cm);
  const std::string outline = R"("outline": [{"edge": "hem", "path": [["M", 0, 0], ["L", )" + w +
                              R"(, 0]]}, {"edge": "end", "path": [["L", )" + w +
                              R"(, 5]]}, {"edge": "top", "path": [["L", 0, 5]]}, )" +
                              R"({"edge": "start", "path": [["L", 0, 0]]}]})";
  return own(
      R"({"format": "pattern", "version": 1, "length_unit": "cm", "name": "n", "panels": [{"name": "front", )" +
      outline + R"(, {"name": "back", )" + outline +
      R"(], "seams": [{"name": "a", "a": [{"panel": "front", "edge": "end"}], "b": [{"panel": "back", "edge": "start"}]},
      {"name": "b", "a": [{"panel": "back", "edge": "end"}], "b": [{"panel": "front", "edge": "start"}]}]})");
}

std::vector<std::string> found(double width_cm, const body::Body& body, double height,
                               const std::string& part) {
  const Pattern p = cuff(width_cm);
  PanelMesh mesh = mesh_pattern(p, 0.02, "test.json", 0);
  mesh.placed.resize(mesh.pattern.size());
  for (std::size_t k = 0; k < mesh.panels.size(); ++k) {
    mesh.panels[k].part = part;
    for (int v = mesh.panels[k].first_vertex;
         v < mesh.panels[k].first_vertex + mesh.panels[k].n_vertices; ++v) {
      const Vec2& at = mesh.pattern[v];
      const double x = at.x() - 0.005 * width_cm, away = RADIUS + 0.02;
      mesh.placed[v] = k == 0 ? Vec3(x, height + at.y(), away) : Vec3(-x, height + at.y(), -away);
    }
  }
  return tight_rings(p, mesh, BodySpace(body));
}

std::vector<std::string> found(double width_cm) {
  return found(width_cm, column(body::Part::LEG_L, 1), 0.5, "leg_l");
}

TEST(TightRings, RunAcrossTheSeamsBetweenPanels) {
  const std::vector<ClothRing> rings = cloth_rings(cuff(20));
  ASSERT_EQ(rings.size(), 2u) << "hem and top";
  for (const ClothRing& ring : rings) {
    EXPECT_EQ(ring.edges.size(), 2u);
    EXPECT_NEAR(ring.length, 0.4, 1e-9);
  }
}

TEST(TightRings, ACuffShorterThanTheLegIsNamedInCentimetres) {
  const std::vector<std::string> facts = found(16); // 32 cm on a leg of 44
  ASSERT_EQ(facts.size(), 1u) << "its two rims are as long";
  EXPECT_NE(facts[0].find("front, back: 32.00 cm around, on a left leg of 43.9"), std::string::npos)
      << facts[0];
  EXPECT_NE(facts[0].find("stretched by 37 %"), std::string::npos) << facts[0];
}

TEST(TightRings, ARingAboveTheBustIsANecklineAndNoWaistband) {
  const body::Body trunk = column(body::Part::TORSO, 1.7);
  const std::vector<std::string> waistband = found(16, trunk, 1.0, "torso");
  ASSERT_EQ(waistband.size(), 1u);
  EXPECT_NE(waistband[0].find("on a waist of"), std::string::npos) << waistband[0];
  EXPECT_TRUE(found(16, trunk, 1.4, "torso").empty());
}

TEST(TightRings, ACuffThatClosesIsNoFinding) {
  EXPECT_TRUE(found(25).empty());
  EXPECT_TRUE(found(20).empty()) << "10 % are left to the fabric";
}

} // namespace
} // namespace sloper::pattern::test
