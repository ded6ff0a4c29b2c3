#include <support/placement_patterns.hpp>

#include <gtest/gtest.h>
#include <sloper/pattern/edit/shoulder_folds.hpp>
#include <sloper/pattern/place/place_panels.hpp>
#include <sloper/pattern/seams/check_pattern.hpp>

namespace sloper::pattern::test {
namespace {

std::string points(const std::string& edge, const std::string& x, const std::string& y,
                   const std::string& start = "") {
  return R"({"edge": ")" + edge + R"(", "path": [)" + start + R"(["L", )" + x + ", " + y + "]]}";
}

/// 56 by 140 cm with a hole for the head, 14 cm deep in front, sleeves, both sides sewn from the
/// hem to the sleeve. Turned by a right angle, or lying as drawn.
std::string tunic_text(bool lying, const std::string& sides) {
  const auto at = [&](double x, double y) {
    return lying ? std::to_string(-y) + ", " + std::to_string(x)
                 : std::to_string(x) + ", " + std::to_string(y);
  };
  const auto edge = [&](const std::string& name, double x, double y, const std::string& start) {
    return R"({"edge": ")" + name + R"(", "path": [)" + start + R"(["L", )" + at(x, y) + "]]}";
  };
  const std::string move = R"(["M", )" + at(-28, -70) + "], ";
  std::string text =
      R"({"format": "pattern", "version": 1, "length_unit": "cm", "name": "tunic", "panels": [{"name": "body", "grain": [)" +
      std::string(lying ? "1, 0" : "0, 1") + R"(], "outline": [)" + edge("hem_f", 28, -70, move) +
      "," + edge("side_fl", 28, -20, "") + "," + edge("arm_l", 28, 20, "") + "," +
      edge("side_bl", 28, 70, "") + "," + edge("hem_b", -28, 70, "") + "," +
      edge("side_br", -28, 20, "") + "," + edge("arm_r", -28, -20, "") + "," +
      edge("side_fr", -28, -70, "") + R"(], "holes": [[{"edge": "neck_b", "path": [["M", )" +
      at(-10, 0) + R"(], ["C", )" + at(-10, 4) + ", " + at(10, 4) + ", " + at(10, 0) +
      R"(]]}, {"edge": "neck_f", "path": [["C", )" + at(10, -16) + ", " + at(-10, -16) + ", " +
      at(-10, 0) + "]]}]]}";
  std::string seams = sides;
  for (const std::string s : {"l", "r"}) {
    text += "," + rectangle("sleeve_" + s, 40, 35);
    seams += R"(, {"name": "under_)" + s + R"(", "a": [{"panel": "sleeve_)" + s +
             R"(", "edge": "l"}], "b": [{"panel": "sleeve_)" + s + R"(", "edge": "r"}]},
      {"name": "set_)" +
             s + R"(", "a": [{"panel": "sleeve_)" + s +
             R"(", "edge": "top"}], "b": [{"panel": "body", "edge": "arm_)" + s + R"("}]})";
  }
  return text + R"(], "seams": [)" + seams + "]}";
}

const std::string SIDES =
    R"({"name": "side_l", "a": [{"panel": "body", "edge": "side_fl"}], "b": [{"panel": "body", "edge": "side_bl"}]},
       {"name": "side_r", "a": [{"panel": "body", "edge": "side_fr"}], "b": [{"panel": "body", "edge": "side_br"}]})";

TEST(ShoulderFolds, AFrontAndBackInOneAreCutAcrossTheirHoleAndSleeves) {
  for (const bool lying : {false, true}) {
    SCOPED_TRACE(lying);
    Pattern pattern = own(tunic_text(lying, SIDES));
    ASSERT_EQ(cut_shoulder_folds(pattern), 1);
    ASSERT_EQ(pattern.panels.size(), 4u);
    const int front = pattern.find_panel("front_body"), back = pattern.find_panel("back_body");
    ASSERT_GE(front, 0);
    ASSERT_GE(back, 0);
    for (int p : {front, back}) {
      const Panel& panel = pattern.panels[p];
      EXPECT_EQ(panel.loops.size(), 1u) << "half of the hole is part of the outline";
      double low = 1e300, high = -1e300;
      for (const PanelEdge& e : panel.loops[0]) {
        low = std::min(low, e.path[0].p[0].y());
        high = std::max(high, e.path[0].p[0].y());
      }
      EXPECT_NEAR(high - low, 0.7, 1e-6);
      EXPECT_GT(std::abs(panel.grain.y()), 0.999) << "it stands";
    }
    const auto depth = [&](int p, const std::string& edge) {
      const Panel& panel = pattern.panels[p];
      const int e = panel.find_edge(edge);
      return e < 0 ? 0.0 : length(panel.edge(e).path);
    };
    EXPECT_GT(depth(front, "neck_f"), depth(back, "neck_b")) << "the deeper neck is in front";
    EXPECT_EQ(pattern.seams.size(), 8u) << "two more, over the shoulders";
    for (const PatternFinding& f : check_pattern(pattern))
      EXPECT_NE(f.severity, "error") << f.place << ": " << f.fact;
    EXPECT_EQ(pattern.findings.size(), 1u);
  }
}

TEST(ShoulderFolds, ItIsPlacedAsAFrontAndABackAre) {
  Pattern pattern = own(tunic_text(false, SIDES));
  cut_shoulder_folds(pattern);
  PanelMesh mesh = mesh_pattern(pattern, 0.02, "t");
  EXPECT_EQ(sew(mesh).wrong_direction, 0);
  EXPECT_EQ(sew(mesh).non_manifold, 0);
  const body::Body body = stick_body(45);
  const PlacementReport report = place_panels(pattern, body, mesh);
  EXPECT_EQ(report.crossings, 0);
  EXPECT_EQ(report.vertices_inside, 0);
  EXPECT_EQ(report.faces_through, 0);
  EXPECT_GT(middle(mesh, pattern.find_panel("front_body")).z(), 0.05);
  EXPECT_LT(middle(mesh, pattern.find_panel("back_body")).z(), -0.05);
  EXPECT_NEAR(top_of(mesh), 1.44, 0.06) << "the fold is over the shoulders";
  EXPECT_EQ(mesh.panels[pattern.find_panel("sleeve_l")].part, "arm_l");
}

TEST(ShoulderFolds, AFoldThatTheFileNamesNeedsNoSeams) {
  std::string text = tunic_text(false, SIDES);
  text.replace(text.find(SIDES), SIDES.size() + 1, "");
  const std::string holes = R"("holes")";
  text.insert(
      text.find(holes),
      R"("lines": [{"name": "shoulder", "kind": "fold", "path": [["M", -28, 0], ["L", 28, 0]]}], )");
  Pattern pattern = own(text);
  EXPECT_EQ(cut_shoulder_folds(pattern), 1);
}

TEST(ShoulderFolds, TubesDartsAndGoresAreNotCut) {
  const std::string both =
      R"({"format": "pattern", "version": 1, "length_unit": "cm", "name": "t", "panels": [)";
  Pattern sleeve = own(
      both + R"({"name": "sleeve", "outline": [)" + points("hem", "14", "0", R"(["M", -14, 0], )") +
      "," + points("l", "20", "40") + "," + points("top", "-20", "40") + "," +
      points("r", "-14", "0") +
      R"(]}], "seams": [{"name": "under", "a": [{"panel": "sleeve", "edge": "l", "from": 0, "to": 0.5}], "b": [{"panel": "sleeve", "edge": "r", "from": 1, "to": 0.5}]},
      {"name": "upper", "a": [{"panel": "sleeve", "edge": "l", "from": 0.5, "to": 1}], "b": [{"panel": "sleeve", "edge": "r", "from": 0.5, "to": 0}]}]})");
  EXPECT_EQ(cut_shoulder_folds(sleeve), 0) << "a seam in two parts";
  Pattern tube = own(tube_text());
  EXPECT_EQ(cut_shoulder_folds(tube), 0);
  // Three quarters of a circle with one seam.
  Pattern skirt = own(
      both +
      R"({"name": "skirt", "outline": [{"edge": "waist", "path": [["M", 0, -10], ["A", 10, 1, 0, 10, 0]]}, {"edge": "l", "path": [["L", 60, 0]]},
      {"edge": "hem", "path": [["A", 60, 1, 1, 0, -60]]}, {"edge": "r", "path": [["L", 0, -10]]}]}],
      "seams": [{"name": "back", "a": [{"panel": "skirt", "edge": "l"}], "b": [{"panel": "skirt", "edge": "r"}]}]})");
  EXPECT_EQ(cut_shoulder_folds(skirt), 0);
}

} // namespace
} // namespace sloper::pattern::test
