#include <gtest/gtest.h>
#include <sloper/base/units.hpp>
#include <sloper/pattern/read/read_pattern.hpp>

#include <sloper/io/json.hpp>

namespace sloper::pattern::test {
namespace {

/// Six gores around the body, tilted outwards by 40 degrees and then turned about the upright axis:
/// R = Ry Rx.
/// @param curves  "list" or "typed", as the two programs write a straight curve
std::string ring_of_gores(bool maya, const std::string& curves) {
  constexpr int GORES = 6;
  const std::string curve = curves == "list"
                                ? R"("curvature": [0.5, 0])"
                                : R"("curvature": {"type": "quadratic", "params": [[0.5, 0]]})";
  std::string panels, stitches;
  for (int k = 0; k < GORES; ++k) {
    const double turn = 2 * units::PI * k / GORES, tilt = -units::radians(40);
    Mat3 r = (Eigen::AngleAxisd(turn, Vec3::UnitY()) * Eigen::AngleAxisd(tilt, Vec3::UnitX()))
                 .toRotationMatrix();
    Vec3 angles(units::degrees(tilt), units::degrees(turn), 0); // Rz Ry Rx
    if (!maya)
      angles = r.eulerAngles(0, 1, 2) * (180 / units::PI);
    const Vec3 at = Vec3(30 * std::sin(turn), 60, 30 * std::cos(turn));
    const auto triple = [](const Vec3& v) {
      return "[" + std::to_string(v.x()) + ", " + std::to_string(v.y()) + ", " +
             std::to_string(v.z()) + "]";
    };
    const std::string name = "gore_" + std::to_string(k),
                      next = "gore_" + std::to_string((k + 1) % GORES);
    panels +=
        std::string(k ? ", " : "") + "\"" + name + R"(": {"translation": )" + triple(at) +
        R"(, "rotation": )" + triple(angles) +
        R"(, "vertices": [[-17, 0], [17, 0], [7, 55], [-7, 55]], "edges": [{"endpoints": [0, 1]}, {"endpoints": [1, 2], )" +
        curve + R"(}, {"endpoints": [2, 3]}, {"endpoints": [3, 0]}]})";
    stitches += std::string(k ? ", " : "") + R"([{"panel": ")" + name +
                R"(", "edge": 1}, {"panel": ")" + next + R"(", "edge": 3}])";
  }
  return R"({"pattern": {"panels": {)" + panels + R"(}, "stitches": [)" + stitches +
         R"(]}, "properties": {"units_in_meter": 100}})";
}

/// The largest difference in height of the two ends of a gore's waist, m.
double lean_of_waists(const std::string& text) {
  const Pattern p = read_garmentcode(io::parse_json(text, "spec.json"), "spec.json");
  double most = 0;
  for (const Panel& panel : p.panels) {
    const Segment& waist = panel.edge(2).path.front();
    const auto height = [&](const Vec2& q) {
      return (*panel.hint.rigid * Eigen::Vector4d(q.x(), q.y(), 0, 1)).y();
    };
    most = std::max(most, std::abs(height(waist.p[0]) - height(waist.p[3])));
  }
  return most;
}

TEST(SpecPlacement, RotationsAreInTheOrderThatBringsTheSeamsTogether) {
  EXPECT_LT(lean_of_waists(ring_of_gores(true, "list")), 1e-6);
  EXPECT_LT(lean_of_waists(ring_of_gores(false, "list")), 1e-6);
  EXPECT_LT(lean_of_waists(ring_of_gores(false, "typed")), 1e-6);
}

TEST(SpecPlacement, CurvesOfGarmentCodeTellItsOrderWhateverTheSeams) {
  EXPECT_GT(lean_of_waists(ring_of_gores(true, "typed")), 0.01);
}

TEST(SpecPlacement, PanelsThatAllLieInOnePlaneWereNeverPlaced) {
  const auto spec = [](double z) {
    const std::string panel =
        R"("vertices": [[0, 0], [40, 0], [40, 60], [0, 60]], "edges": [{"endpoints": [0, 1]}, {"endpoints": [1, 2]},
      {"endpoints": [2, 3]}, {"endpoints": [3, 0]}]})";
    return R"({"pattern": {"panels": {"front": {"translation": [0, 0, 0], "rotation": [0, 0, 0], )" +
           panel + R"(, "back": {"translation": [0, 0, )" + std::to_string(z) +
           R"(], "rotation": [0, 0, 0], )" + panel +
           R"(}, "stitches": [[{"panel": "front", "edge": 1}, {"panel": "back", "edge": 3}]]}, "properties": {"units_in_meter": 100}})";
  };
  const Pattern flat = read_garmentcode(io::parse_json(spec(0), "spec.json"), "spec.json");
  for (const Panel& panel : flat.panels)
    EXPECT_FALSE(panel.hint.rigid) << panel.name;
  ASSERT_EQ(flat.findings.size(), 1u);
  EXPECT_NE(flat.findings[0].text.find("placed in one plane"), std::string::npos);
  const Pattern placed = read_garmentcode(io::parse_json(spec(-40), "spec.json"), "spec.json");
  for (const Panel& panel : placed.panels)
    EXPECT_TRUE(panel.hint.rigid) << panel.name;
}

TEST(SpecPlacement, OnePanelThatIsPlacedWrongIsBroughtToItsSeams) {
  io::Json json = io::parse_json(ring_of_gores(false, "typed"), "spec.json");
  const Pattern right = read_garmentcode(json, "spec.json");
  json["pattern"]["panels"]["gore_2"]["translation"][1] = -35.0; // 60 in the others
  const Pattern mended = read_garmentcode(json, "spec.json");
  const Vec3 off =
      (mended.panels[2].hint.rigid->col(3) - right.panels[2].hint.rigid->col(3)).head<3>();
  EXPECT_LT(off.norm(), 0.05);
  ASSERT_EQ(mended.findings.size(), right.findings.size() + 1);
  EXPECT_EQ(mended.findings.back().text.rfind("gore_2: its translation puts it 95", 0), 0u)
      << mended.findings.back().text;
  for (std::size_t k : {0u, 1u, 3u, 4u, 5u})
    EXPECT_TRUE(mended.panels[k].hint.rigid->isApprox(*right.panels[k].hint.rigid));
}

} // namespace
} // namespace sloper::pattern::test
