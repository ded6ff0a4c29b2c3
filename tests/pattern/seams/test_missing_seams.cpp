/// Seams left out, and openings that look like them.
#include <support/straight_patterns.hpp>

#include <gtest/gtest.h>
#include <pattern/seams/missing_seams.hpp>
#include <sloper/pattern/seams/check_pattern.hpp>

#include <random>

namespace sloper::pattern::test {
namespace {

/// A skirt in quarters with a closed band; its sides and middles are drawn in two edges.
Pattern skirt(const std::vector<std::string>& left_out = {}) {
  DrawnPattern drawn;
  drawn.quarters({{"hem", 30, -55},
                  {"side", 25, -20},
                  {"side_hip", 20, 0},
                  {"waist", 0, 0},
                  {"middle_hip", 0, -20},
                  {"middle", 0, -55}},
                 {"side", "side_hip"}, {"middle", "middle_hip"});
  const std::vector<DrawnEdge> band = {
      {"low_a", 0, 0}, {"low_b", 20, 0}, {"end_b", 20, 4}, {"top", -20, 4}, {"end_a", -20, 0}};
  drawn.panel("band_front", band);
  drawn.panel("band_back", band);
  drawn.seam("band_front", "end_a", "band_back", "end_b");
  drawn.seam("band_front", "end_b", "band_back", "end_a");
  drawn.seam("band_front", "low_a", "front_r", "waist");
  drawn.seam("band_front", "low_b", "front_l", "waist");
  drawn.seam("band_back", "low_a", "back_l", "waist");
  drawn.seam("band_back", "low_b", "back_r", "waist");
  Pattern pattern = drawn.pattern();
  std::erase_if(pattern.seams, [&](const Seam& s) {
    return std::find(left_out.begin(), left_out.end(), s.name) != left_out.end();
  });
  return pattern;
}

std::string findings_of(const Pattern& pattern) {
  std::string all;
  for (const MissingSeam& s : missing_seams(pattern))
    all += place_of(pattern, s.a) + " + " + place_of(pattern, s.b) + "; ";
  return all;
}

TEST(MissingSeams, AWholeGarmentHasNone) {
  EXPECT_EQ(findings_of(skirt()), "");
  EXPECT_EQ(findings_of(own(tube_text())), "")
      << "waist and hem of two panels are as long as each other";
}

TEST(MissingSeams, OneSideOfTwoIsTold) {
  EXPECT_EQ(findings_of(skirt({"front_lside", "front_lside_hip"})),
            "front_l: side + back_l: side; front_l: side_hip + back_l: side_hip; ");
  EXPECT_EQ(findings_of(skirt({"band_frontend_a"})), "band_front: end_a + band_back: end_b; ");
  Pattern tube = own(tube_text());
  tube.seams.pop_back();
  EXPECT_EQ(findings_of(tube), "front: side_r + back: side_l; ")
      << "a panel may be its own other half";
}

TEST(MissingSeams, AStretchLeftOutOfASeamIsTold) {
  EXPECT_EQ(findings_of(skirt({"front_lmiddle_hip"})),
            "front_l: middle_hip + front_r: middle_hip; ")
      << "the band closes it above";
}

TEST(MissingSeams, OpeningsAreNotTold) {
  EXPECT_EQ(findings_of(skirt({"front_lside"})), "") << "a slit";
  EXPECT_EQ(findings_of(skirt({"front_lside_hip", "band_frontend_b"})), "")
      << "a placket, through the band";
  EXPECT_EQ(findings_of(skirt({"front_lmiddle", "front_lmiddle_hip"})), "")
      << "an open front below a band";
  EXPECT_EQ(
      findings_of(skirt({"front_lside", "front_lside_hip", "front_rside", "front_rside_hip"})), "")
      << "an apron before and behind";
  Pattern left_open = skirt();
  left_open.seams[0].open = true;
  EXPECT_EQ(findings_of(left_open), "") << "a closure left undone";
}

/// A tank top in quarters, all of straight edges. @param eye  cm, half the width of a hole with
/// straight sides in the side seam; none: 0
Pattern tank(std::mt19937& random, double eye) {
  const auto between = [&](double low, double high) {
    return low + (high - low) * static_cast<double>(random() >> 8) / 16777216.0;
  };
  const double half = between(22, 34), height = between(55, 80), arm = between(17, 27),
               shoulder = between(0.45, 0.75) * half, neck = between(0.4, 0.75) * shoulder,
               slope = between(0, 5), depth = between(3, 14), top = height - arm;
  DrawnPattern drawn;
  std::vector<DrawnEdge> edges = {{"hem", half, 0}};
  std::vector<const char*> sides = {"side"};
  if (eye > 0) {
    edges.push_back({"under", half, 0.2 * top});
    edges.push_back({"eye_a", half - eye, 0.5 * top});
    edges.push_back({"eye_b", half, 0.8 * top});
    sides.push_back("under");
  }
  for (const DrawnEdge& edge : std::vector<DrawnEdge>{{"side", half, top},
                                                      {"arm", shoulder, height - slope},
                                                      {"shoulder", neck, height},
                                                      {"neck", 0, height - depth},
                                                      {"middle", 0, 0}})
    edges.push_back(edge);
  sides.push_back("shoulder");
  drawn.quarters(edges, sides, {"middle"});
  return drawn.pattern();
}

TEST(MissingSeams, StraightArmholesAreNotToldAndFisheyesAre) {
  std::mt19937 random(11);
  for (int k = 0; k < 60; ++k) {
    EXPECT_EQ(findings_of(tank(random, 0)), "") << k;
    // A dart of 1 to 4 cm in the side seam, which both halves leave open.
    EXPECT_NE(findings_of(tank(random, 0.5 + 0.025 * k)), "") << k;
  }
}

TEST(MissingSeams, ADartWhoseMouthIsSewnShutIsTold) {
  DrawnPattern drawn; // the waist of the front has 4 cm more than the band, for a dart
  drawn.panel("front", {{"hem", 22, -50},
                        {"side_l", 22, 0},
                        {"waist_l", 2, 0},
                        {"leg_a", 0, -12},
                        {"leg_b", -2, 0},
                        {"waist_r", -22, 0},
                        {"side_r", -22, -50}});
  drawn.panel(
      "band",
      {{"low_r", 0, 0}, {"low_l", 20, 0}, {"end_l", 20, 4}, {"top", -20, 4}, {"end_r", -20, 0}});
  drawn.seam("front", "waist_l", "band", "low_l");
  drawn.seam("front", "waist_r", "band", "low_r");
  EXPECT_EQ(findings_of(drawn.pattern()), "front: leg_a + front: leg_b; ");
  DrawnPattern neckline; // the same shape between shoulders
  neckline.panel("front", {{"hem", 22, -50},
                           {"side_l", 22, 0},
                           {"shoulder_l", 2, 0},
                           {"neck_l", 0, -12},
                           {"neck_r", -2, 0},
                           {"shoulder_r", -22, 0},
                           {"side_r", -22, -50}});
  neckline.panel("back", {{"hem", 22, -50},
                          {"side_l", 22, 0},
                          {"shoulder_l", 2, 0},
                          {"neck", -2, 0},
                          {"shoulder_r", -22, 0},
                          {"side_r", -22, -50}});
  for (const auto& [a, b] : {std::pair("_l", "_r"), std::pair("_r", "_l")})
    for (const std::string edge : {"side", "shoulder"})
      neckline.seam("front", edge + a, "back", edge + b);
  EXPECT_EQ(findings_of(neckline.pattern()), "") << "a slashed neckline";
}

TEST(MissingSeams, ThreeLikePiecesWrappedAroundAreLeftOpen) {
  DrawnPattern wrap;
  for (const char* name : {"front_l", "back", "front_r"})
    wrap.panel(name, {{"hem", 20, -50}, {"a", 20, 0}, {"waist", -20, 0}, {"b", -20, -50}});
  wrap.seam("back", "a", "front_r", "b");
  wrap.seam("front_l", "a", "back", "b");
  EXPECT_EQ(findings_of(wrap.pattern()), "");
}

/// Findings of a rule, one a line.
std::string findings(const Pattern& pattern, const std::string& rule) {
  std::string all;
  for (const PatternFinding& f : check_pattern(pattern))
    if (f.rule == rule)
      all += f.severity + ": " + f.place + ": " + f.fact + "\n";
  return all;
}

TEST(Check, AMissingSeamIsAnErrorThatCanBeSewn) {
  const Pattern pattern = skirt({"front_lside", "front_lside_hip"});
  EXPECT_NE(
      findings(pattern, "open-seam").find("error: front_l: side: is not sewn to back_l: side"),
      std::string::npos);
  EXPECT_NO_THROW(require_sewable(pattern, "t"));
}

TEST(Check, SizesOfNoPersonNameTheUnitToCheck) {
  const auto scaled = [](double factor) {
    Pattern pattern = skirt();
    for (Panel& panel : pattern.panels)
      for (PanelEdge& e : panel.loops[0])
        for (Segment& s : e.path)
          for (Vec2& p : s.p)
            p *= factor;
    return pattern;
  };
  EXPECT_EQ(findings(scaled(1), "wrong-unit"), "");
  EXPECT_EQ(findings(scaled(0.5), "wrong-unit"), "") << "a child's";
  EXPECT_EQ(findings(scaled(2.54), "wrong-unit"), "") << "long flounces are larger";
  EXPECT_EQ(findings(scaled(0.1), "wrong-unit"),
            "error: front_l: the largest panel measures 3.00 cm by 5.50 cm: nobody is that small; "
            "in a unit ten times larger it would be 30.00 cm by 55.00 cm: "
            "check \"length_unit\"\n");
  EXPECT_NE(findings(scaled(10), "wrong-unit")
                .find("measures 300.00 cm by 550.00 cm: nobody is that large"),
            std::string::npos);
  EXPECT_NO_THROW(require_sewable(scaled(10), "t"));
}

} // namespace
} // namespace sloper::pattern::test
