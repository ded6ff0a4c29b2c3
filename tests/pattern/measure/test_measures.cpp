/// Measures of the finished garment, on patterns whose measures can be worked out by hand.
#include <support/straight_patterns.hpp>

#include <gtest/gtest.h>
#include <sloper/pattern/measure/finished_measures.hpp>

#include <cmath>

namespace sloper::pattern::test {
namespace {

double measure_of(const FinishedMeasures& m, const std::string& name) {
  for (const NamedMeasure& n : m.named)
    if (n.name == name)
      return n.value;
  return 0;
}

FinishedMeasures measures(const DrawnPattern& drawn) {
  return finished_measures(drawn.pattern(), "t");
}

TEST(Measures, OfTrousersCountEachSeamAsAWholeThoughItIsDrawnAsSeveralEdges) {
  DrawnPattern trousers;
  trousers.quarters({{"hem", 20, -100},
                     {"side_low", 22, -50},
                     {"side_high", 24, 0},
                     {"waist", 0, 0},
                     {"middle", 0, -18},
                     {"crotch", -5, -26},
                     {"inside_high", 2, -50},
                     {"inside_low", 4, -100}},
                    {"side_low", "side_high", "inside_high", "inside_low"}, {"middle", "crotch"});
  const FinishedMeasures m = measures(trousers);
  EXPECT_NEAR(measure_of(m, "waist"), 0.96, 0.001);
  EXPECT_NEAR(measure_of(m, "hip"), 0.95, 0.01)
      << "between 0.936 and 0.955, 15 and 19 cm below the top";
  EXPECT_NEAR(measure_of(m, "rise"), 0.18 + std::hypot(0.05, 0.08), 0.001);
  EXPECT_NEAR(measure_of(m, "inseam"), std::hypot(0.07, 0.24) + std::hypot(0.02, 0.50), 0.001);
  EXPECT_NEAR(measure_of(m, "side_seam"), 2 * std::hypot(0.02, 0.50), 0.001);
  EXPECT_NEAR(measure_of(m, "thigh"), 2 * (0.2286 + 0.0427), 0.005);
  EXPECT_NEAR(measure_of(m, "leg_hem"), 0.32, 0.001) << "front and back";
  EXPECT_NEAR(measure_of(m, "length"), 1.0, 0.005);
}

TEST(Measures, OfASkirtInQuartersAreNoTrousers) {
  DrawnPattern skirt; // the upper part of its side is more than a third of it
  skirt.quarters({{"hem", 30, -55},
                  {"side", 25, -20},
                  {"side_hip", 20, 0},
                  {"waist", 0, 0},
                  {"middle_hip", 0, -20},
                  {"middle", 0, -55}},
                 {"side", "side_hip"}, {"middle", "middle_hip"});
  const FinishedMeasures m = measures(skirt);
  for (const char* name : {"rise", "inseam", "thigh", "leg_hem"})
    EXPECT_EQ(measure_of(m, name), 0) << name;
  EXPECT_NEAR(measure_of(m, "waist"), 0.8, 0.001);
  EXPECT_NEAR(measure_of(m, "hip"), 4 * 0.257, 0.01) << "25 cm below the top";
  EXPECT_NEAR(measure_of(m, "side_seam"), std::hypot(0.05, 0.35) + std::hypot(0.05, 0.20), 0.001);
  ASSERT_GE(m.around.size(), 10u);
  EXPECT_NEAR(m.around[1][1], 0.9, 0.01) << "10 cm below the top";
}

/// A box of 100 cm around with a neckline of 44 cm and armholes of 20 cm, `down` cm long from the
/// armholes; the back ends `tail` cm below the front.
DrawnPattern box(double down, double tail = 0) {
  std::vector<DrawnEdge> body = {{"l_side", 25, 40},      {"l_arm", 25, 60},
                                 {"l_shoulder", 11, 60},  {"neck", -11, 60},
                                 {"r_shoulder", -25, 60}, {"r_arm", -25, 40}};
  body.insert(body.end(), {{"r_side", -25, 40 - down}, {"hem", 25, 40 - down}});
  DrawnPattern out;
  out.panel("front", body);
  if (tail > 0)
    body.insert(body.end() - 1,
                {{"tail_r", -25, 40 - down - tail}, {"tail", 25, 40 - down - tail}});
  out.panel("back", body);
  for (const auto& [a, b] : {std::pair("l", "r"), std::pair("r", "l")})
    for (const std::string edge : {"_side", "_shoulder"})
      out.seam("front", a + edge, "back", b + edge);
  return out;
}

TEST(Measures, TheNeckIsWhereTheCollarIsSewnOnAndNotItsRim) {
  DrawnPattern shirt = box(40);
  shirt.panel(
      "collar",
      {{"low_f", 22, 0}, {"low_b", 44, 0}, {"end_l", 52, 7}, {"rim", -8, 7}, {"end_r", 0, 0}});
  shirt.seam("front", "neck", "collar", "low_f");
  shirt.seam("back", "neck", "collar", "low_b");
  shirt.seam("collar", "end_l", "collar", "end_r");
  EXPECT_NEAR(measure_of(measures(shirt), "neck"), 0.44, 0.001);
  EXPECT_NEAR(measure_of(measures(box(40)), "neck"), 0.44, 0.001)
      << "without a collar, the neckline";
}

TEST(Measures, ALevelThatDoesNotGoAroundIsNoGirth) {
  const FinishedMeasures m = measures(box(18, 12)); // lower down there is a back alone
  EXPECT_NEAR(measure_of(m, "chest"), 1.0, 0.001);
  EXPECT_NEAR(measure_of(m, "waist"), 1.0, 0.005);
}

TEST(Measures, OfACircleSkirtFollowTheClothDownFromTheWaist) {
  // Half circles of 13 and 50 cm radius, their sides drawn level.
  std::string half =
      R"({"name": "skirt_front", "outline": [{"edge": "hem", "path": [["M", -50, 0], ["C", -50, -66.667, 50, -66.667, 50, 0]]},
    {"edge": "l", "path": [["L", 13, 0]]}, {"edge": "waist", "path": [["C", 13, -17.333, -13, -17.333, -13, 0]]}, {"edge": "r", "path": [["L", -50, 0]]}]})";
  std::string text =
      R"({"format": "pattern", "version": 1, "length_unit": "cm", "name": "skirt", "panels": [)" +
      half + ",";
  half.replace(half.find("front"), 5, "back");
  text +=
      half +
      R"(], "seams": [{"name": "a", "a": [{"panel": "skirt_front", "edge": "l"}], "b": [{"panel": "skirt_back", "edge": "r"}]},
    {"name": "b", "a": [{"panel": "skirt_back", "edge": "l"}], "b": [{"panel": "skirt_front", "edge": "r"}]}]})";
  const FinishedMeasures m = finished_measures(own(text), "t");
  EXPECT_NEAR(measure_of(m, "hip"), 2 * M_PI * 0.38, 0.03);
  EXPECT_NEAR(measure_of(m, "length"), 0.37, 0.005);
  EXPECT_NEAR(measure_of(m, "side_seam"), 0.37, 0.001);
}

} // namespace
} // namespace sloper::pattern::test
