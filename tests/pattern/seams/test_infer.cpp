#include <support/pattern_texts.hpp>

#include <gtest/gtest.h>
#include <pattern/seams/gore_rows.hpp>
#include <sloper/io/json.hpp>
#include <sloper/pattern/seams/infer_seams.hpp>
#include <sloper/pattern/seams/piece_versions.hpp>

#include <set>

namespace sloper::pattern::test {
namespace {

Pattern unsewn(bool named) {
  std::string text = tube_text();
  Pattern p = own(text.substr(0, text.find("\"seams\"")) + "\"seams\": []}");
  for (Panel& panel : p.panels)
    for (int e = 0; e < panel.n_edges() && !named; ++e)
      panel.edge(e).name = "edge" + std::to_string(e);
  return p;
}

TEST(Inference, NamesAndLengthsTogetherAreCertain) {
  const Pattern p =
      own(R"({"format": "pattern", "version": 1, "length_unit": "cm", "name": "n", "panels": [
    {"name": "front_l", "outline": [{"edge": "hem", "path": [["M", 0, 0], ["L", 20, 0]]}, {"edge": "side", "path": [["L", 22, 50]]}, {"edge": "waist", "path": [["L", 0, 52]]}, {"edge": "cf", "path": [["L", 0, 0]]}]},
    {"name": "back_l", "outline": [{"edge": "hem", "path": [["M", 0, 0], ["L", 25, 0]]}, {"edge": "cb", "path": [["L", 25, 55]]}, {"edge": "waist", "path": [["L", 1, 50]]}, {"edge": "side", "path": [["L", 0, 0]]}]}]})");
  const auto guesses = infer_seams(p);
  ASSERT_FALSE(guesses.empty());
  EXPECT_TRUE(guesses[0].certain);
  EXPECT_EQ(guesses[0].seam.name, "front_l.side-back_l.side");
  const io::Json doc = sewing_questions(p, guesses, "test");
  EXPECT_EQ(doc["seams"].size(), 1u);
  Pattern answered = p;
  read_sewing_seams(answered, doc, "answer.json"); // the document is a sidecar as it stands
  EXPECT_EQ(answered.seams.size(), 1u);
}

TEST(Inference, WhatIsAskedHasTwoAnswersAtMostAndNoEdgeIsSewnTwice) {
  const Pattern p = unsewn(false);
  const std::vector<SeamGuess> all = infer_seams(p);
  const io::Json doc = sewing_questions(p, all, "test");
  for (const io::Json& question : doc["questions"]) {
    EXPECT_GE(question["candidates"].size(), 1u);
    EXPECT_LE(question["candidates"].size(), 2u);
  }
  EXPECT_GT(doc["questions"].size() + doc["seams"].size(), 0u);
  std::set<std::pair<int, int>> sewn;
  for (const SeamGuess& g : all)
    for (const auto* side : {&g.seam.a, &g.seam.b})
      for (const pattern::Run& run : *side)
        EXPECT_TRUE(sewn.insert({run.panel, run.edge}).second) << g.seam.name;
}

TEST(Inference, AnAnswerTellsTheMirrorImageToo) {
  Pattern p = unsewn(false);
  const io::Json doc = {{"format", "sewing-seams"},
                        {"version", 1},
                        {"seams",
                         {{{"name", "s"},
                           {"a", {{{"panel", "front"}, {"run", "edge1"}}}},
                           {"b", {{{"panel", "back"}, {"run", "edge3"}, {"dir", "-"}}}},
                           {"and",
                            {{{"name", "t"},
                              {"a", {{{"panel", "back"}, {"run", "edge1"}}}},
                              {"b", {{{"panel", "front"}, {"run", "edge3"}, {"dir", "-"}}}}}}}}}}};
  read_sewing_seams(p, doc, "answer.json");
  ASSERT_EQ(p.seams.size(), 2u);
  EXPECT_EQ(p.seams[1].name, "t");
}

struct Outline {
  std::string name;
  std::vector<Vec2> corners; ///< cm
};

Pattern outlines(const std::vector<Outline>& panels) {
  std::string text;
  for (const Outline& panel : panels) {
    std::string outline;
    for (std::size_t k = 0; k < panel.corners.size(); ++k) {
      const Vec2 &from = panel.corners[k], &to = panel.corners[(k + 1) % panel.corners.size()];
      const std::string start =
          k ? "" : R"(["M", )" + std::to_string(from.x()) + ", " + std::to_string(from.y()) + "], ";
      outline += std::string(k ? ", " : "") + R"({"edge": "edge)" + std::to_string(k) +
                 R"(", "path": [)" + start + R"(["L", )" + std::to_string(to.x()) + ", " +
                 std::to_string(to.y()) + "]]}";
    }
    text += std::string(text.empty() ? "" : ", ") + R"({"name": ")" + panel.name +
            R"(", "outline": [)" + outline + "]}";
  }
  return own(
      R"({"format": "pattern", "version": 1, "length_unit": "cm", "name": "n", "panels": [)" +
      text + "]}");
}

bool guesses(const Pattern& p, int panel, int a, int other, int b) {
  for (const SeamGuess& g : infer_seams(p)) {
    const pattern::Run &x = g.seam.a[0], &y = g.seam.b[0];
    if ((x.panel == panel && x.edge == a && y.panel == other && y.edge == b) ||
        (y.panel == panel && y.edge == a && x.panel == other && x.edge == b))
      return true;
  }
  return false;
}

TEST(Inference, ASkirtIsSewnAtItsSidesWithItsDartsAndNotAcrossItsHem) {
  // Half way round each, with a point in the middle of the hem and two darts at the back's waist.
  const Pattern skirt = outlines({{"a", {{-28, 0}, {0, 0}, {28, 0}, {23, 60}, {-23, 60}}},
                                  {"b",
                                   {{-28, 0},
                                    {28, 0},
                                    {23, 60},
                                    {11.5, 60.2},
                                    {10, 48},
                                    {8.5, 60.2},
                                    {-8.5, 60.2},
                                    {-10, 48},
                                    {-11.5, 60.2},
                                    {-23, 60}}}});
  EXPECT_TRUE(guesses(skirt, 0, 2, 1, 9)) << "its left side";
  EXPECT_TRUE(guesses(skirt, 0, 4, 1, 1)) << "its right side";
  EXPECT_TRUE(guesses(skirt, 1, 3, 1, 4)) << "a dart";
  EXPECT_TRUE(guesses(skirt, 1, 6, 1, 7)) << "the other dart";
  EXPECT_FALSE(guesses(skirt, 0, 0, 0, 1)) << "the halves of the hem";
}

TEST(Inference, FrontAndBackOfATunicMeetAtSidesAndShoulders) {
  const Pattern tunic = outlines({{"a",
                                   {{-24, 0},
                                    {24, 0},
                                    {24, 45},
                                    {19, 50},
                                    {18, 68},
                                    {9, 71},
                                    {0, 62},
                                    {-9, 71},
                                    {-18, 68},
                                    {-19, 50},
                                    {-24, 45}}},
                                  {"b",
                                   {{-24, 0},
                                    {24, 0},
                                    {24, 45},
                                    {19, 50},
                                    {18, 68},
                                    {9, 71},
                                    {0, 69},
                                    {-9, 71},
                                    {-18, 68},
                                    {-19, 50},
                                    {-24, 45}}}});
  EXPECT_TRUE(guesses(tunic, 0, 1, 1, 10)) << "a side";
  EXPECT_TRUE(guesses(tunic, 0, 4, 1, 7)) << "a shoulder";
  EXPECT_FALSE(guesses(tunic, 0, 5, 0, 6)) << "the neck";
  EXPECT_FALSE(guesses(tunic, 0, 0, 1, 0)) << "the hems";
}

TEST(Inference, PanelsThatNothingJoinsToTheOthersAreNamed) {
  Pattern p = own(tube_text());
  EXPECT_TRUE(panels_apart(p).empty());
  p.panels.push_back(p.panels[0]);
  p.panels.back().name = "band";
  EXPECT_EQ(panels_apart(p), std::vector<std::string>{"band"});
}

TEST(Inference, HalvesOfSleevesAreNotSewnToThoseOfTheOtherArm) {
  const std::vector<Vec2> front = {{0, 0}, {14, 0}, {18, 14}, {8, 20}, {0, 26}},
                          back = {{0, 0}, {14, 0}, {14, 26}, {7, 22}, {-4, 14}};
  Pattern p = outlines({{"SLEEVE FR", front}, {"SLEEVE BK", back}});
  for (int k : {0, 1}) {
    p.panels.push_back(mirror_image(p.panels[k]));
    p.panels.back().name += "_mirror";
  }
  for (const SeamGuess& g : infer_seams(p)) {
    const int a = g.seam.a[0].panel, b = g.seam.b[0].panel;
    EXPECT_FALSE(a != b && a % 2 == b % 2) << g.seam.name;
  }
}

TEST(Inference, TheSeamOverTheArmIsOfferedThoughTheBackOfTheSleeveReachesOverTheShoulder) {
  // From the hem up: sides of 23 and of 8.6 cm in both. The back is 9 cm longer, in line.
  const std::vector<Vec2> front = {{0, 0}, {16, 0}, {16, 23}, {9, 14.5}, {-2.5, 8.2}},
                          back = {{0, 0},  {20, 0},  {22.5, 8.2}, {14, 16},
                                  {4, 27}, {-2, 32}, {0, 23}};
  Pattern p = outlines({{"SLEEVE FR", front}, {"SLEEVE BK", back}});
  for (int k : {0, 1}) {
    p.panels.push_back(mirror_image(p.panels[k]));
    p.panels.back().name += "_mirror";
  }
  const auto is = [](const std::vector<pattern::Run>& side, int panel, int edge) {
    return side.size() == 1 && side[0].panel == panel && side[0].edge == edge;
  };
  const auto is_overarm = [&](const SeamGuess& g) {
    return (is(g.seam.a, 0, 1) && is(g.seam.b, 1, 6)) || (is(g.seam.a, 1, 6) && is(g.seam.b, 0, 1));
  };
  int offered = 0;
  for (const SeamGuess& g : infer_seams(p))
    offered += is_overarm(g) || (!g.instead.empty() && is_overarm(g.instead[0]));
  EXPECT_GE(offered, 1);
}

/// Halves of a front and of a back with darts, unsewn: middles and sides look like crotch curves
/// and inseams of two pairs of trousers.
const char* const BODICE =
    R"json({"format": "pattern", "version": 1, "length_unit": "cm", "name": "bodice", "panels": [{"name":
"P0", "outline": [{"edge": "0", "path": [["M", 0, 0], ["L", 0, 11.79]]}, {"edge": "1", "path":
[["M", 0, 11.79], ["L", -10.45, 15.26], ["L", -16.76, 24.27], ["L", -16.44, 35.27], ["L", -9.62,
43.9], ["L", -9.29, 44.11]]}, {"edge": "2", "path": [["M", -9.29, 44.11], ["L", -17.07,
41.02]]}, {"edge": "3", "path": [["M", -17.07, 41.02], ["L", -19.31, 23.79]]}, {"edge": "4",
"path": [["M", -19.31, 23.79], ["L", -26.03, 18.04]]}, {"edge": "5", "path": [["M", -26.03,
18.04], ["L", -26.08, 17.9]]}, {"edge": "6", "path": [["M", -26.08, 17.9], ["L", -13.0,
16.07]]}, {"edge": "7", "path": [["M", -13.0, 16.07], ["L", -26.08, 14.23]]}, {"edge": "8",
"path": [["M", -26.08, 14.23], ["L", -24.92, 0]]}, {"edge": "9", "path": [["M", -24.92, 0],
["L", -10.8, 0]]}, {"edge": "10", "path": [["M", -10.8, 0], ["L", -9.63, 12.76]]}, {"edge":
"11", "path": [["M", -9.63, 12.76], ["L", -8.47, 0]]}, {"edge": "12", "path": [["M", -8.47, 0],
["L", 0, 0]]}]}, {"name": "P1", "outline": [{"edge": "0", "path": [["M", 0, 0.37], ["L", 0,
32.66]]}, {"edge": "1", "path": [["M", 0, 32.66], ["L", -2.85, 33.06], ["L", -5.47, 34.23],
["L", -7.68, 36.07], ["L", -9.29, 38.44]]}, {"edge": "2", "path": [["M", -9.29, 38.44], ["L",
-17.23, 35.29]]}, {"edge": "3", "path": [["M", -17.23, 35.29], ["L", -18.88, 18.05]]}, {"edge":
"4", "path": [["M", -18.88, 18.05], ["L", -23.84, 12.31]]}, {"edge": "5", "path": [["M", -23.84,
12.31], ["L", -23.84, 12.23]]}, {"edge": "6", "path": [["M", -23.84, 12.23], ["L", -23.13,
-2]]}, {"edge": "7", "path": [["M", -23.13, -2], ["L", -21.18, -1.6], ["L", -19.22, -1.24],
["L", -17.27, -0.91], ["L", -15.31, -0.61], ["L", -14.92, -0.56]]}, {"edge": "8", "path": [["M",
-14.92, -0.56], ["L", -15.28, 10.24]]}, {"edge": "9", "path": [["M", -15.28, 10.24], ["L",
-13.15, -0.35]]}, {"edge": "10", "path": [["M", -13.15, -0.35], ["L", -12.16, -0.24], ["L",
-11.18, -0.15], ["L", -10.19, -0.06], ["L", -9.2, 0.02], ["L", -8.61, 0.06]]}, {"edge": "11",
"path": [["M", -8.61, 0.06], ["L", -8.49, 12.07]]}, {"edge": "12", "path": [["M", -8.49, 12.07],
["L", -6.83, 0.18]]}, {"edge": "13", "path": [["M", -6.83, 0.18], ["L", -5.27, 0.25], ["L",
-3.71, 0.31], ["L", -2.15, 0.35], ["L", -0.59, 0.37], ["L", 0, 0.37]]}]}, {"name": "P3",
"outline": [{"edge": "0", "path": [["M", 0, 0.37], ["L", 1.56, 0.36], ["L", 3.13, 0.33], ["L",
4.69, 0.28], ["L", 6.25, 0.21], ["L", 6.83, 0.18]]}, {"edge": "1", "path": [["M", 6.83, 0.18],
["L", 8.49, 12.07]]}, {"edge": "2", "path": [["M", 8.49, 12.07], ["L", 8.61, 0.06]]}, {"edge":
"3", "path": [["M", 8.61, 0.06], ["L", 9.6, -0.01], ["L", 10.58, -0.1], ["L", 11.57, -0.19],
["L", 12.56, -0.29], ["L", 13.15, -0.35]]}, {"edge": "4", "path": [["M", 13.15, -0.35], ["L",
15.28, 10.24]]}, {"edge": "5", "path": [["M", 15.28, 10.24], ["L", 14.92, -0.56]]}, {"edge":
"6", "path": [["M", 14.92, -0.56], ["L", 16.88, -0.84], ["L", 18.83, -1.17], ["L", 20.78,
-1.52], ["L", 22.74, -1.92], ["L", 23.13, -2]]}, {"edge": "7", "path": [["M", 23.13, -2], ["L",
23.84, 12.23]]}, {"edge": "8", "path": [["M", 23.84, 12.23], ["L", 23.84, 12.31]]}, {"edge":
"9", "path": [["M", 23.84, 12.31], ["L", 18.88, 18.05]]}, {"edge": "10", "path": [["M", 18.88,
18.05], ["L", 17.23, 35.29]]}, {"edge": "11", "path": [["M", 17.23, 35.29], ["L", 9.29,
38.44]]}, {"edge": "12", "path": [["M", 9.29, 38.44], ["L", 7.68, 36.07], ["L", 5.47, 34.23],
["L", 2.85, 33.06], ["L", 0, 32.66]]}, {"edge": "13", "path": [["M", 0, 32.66], ["L", 0,
0.37]]}]}, {"name": "P4", "outline": [{"edge": "0", "path": [["M", 0, 0], ["L", 8.47, 0]]},
{"edge": "1", "path": [["M", 8.47, 0], ["L", 9.63, 12.76]]}, {"edge": "2", "path": [["M", 9.63,
12.76], ["L", 10.8, 0]]}, {"edge": "3", "path": [["M", 10.8, 0], ["L", 24.92, 0]]}, {"edge":
"4", "path": [["M", 24.92, 0], ["L", 26.08, 14.23]]}, {"edge": "5", "path": [["M", 26.08,
14.23], ["L", 13.0, 16.07]]}, {"edge": "6", "path": [["M", 13.0, 16.07], ["L", 26.08, 17.9]]},
{"edge": "7", "path": [["M", 26.08, 17.9], ["L", 26.03, 18.04]]}, {"edge": "8", "path": [["M",
26.03, 18.04], ["L", 19.31, 23.79]]}, {"edge": "9", "path": [["M", 19.31, 23.79], ["L", 17.07,
41.02]]}, {"edge": "10", "path": [["M", 17.07, 41.02], ["L", 9.29, 44.11]]}, {"edge": "11",
"path": [["M", 9.29, 44.11], ["L", 16.3, 35.63], ["L", 16.87, 24.64], ["L", 10.76, 15.49], ["L",
0.39, 11.8], ["L", 0, 11.79]]}, {"edge": "12", "path": [["M", 0, 11.79], ["L", 0, 0]]}]}],
"seams": []})json";

TEST(Inference, HalvesOfFrontAndBackAreNoVersionsOfTrousers) {
  Pattern p = own(BODICE);
  std::optional<std::vector<SeamGuess>> inferred;
  EXPECT_TRUE(take_versions(p, inferred).empty());
  EXPECT_EQ(p.panels.size(), 4u);
}

TEST(Inference, FirstAnswersSewNoEdgeTwice) {
  const Pattern p = own(BODICE);
  std::vector<SeamGuess> guesses = infer_seams(p);
  const std::size_t all = guesses.size();
  ASSERT_GT(all, 0u);
  SeamGuess rival = guesses.front(); // the same edges, less surely
  rival.certain = false;
  rival.score = 0.1;
  guesses.insert(guesses.begin(), rival);
  SeamGuess folded = guesses.front(); // a band's end that is sewn to itself
  folded.seam.b = folded.seam.a;
  EXPECT_TRUE(first_answers({folded}).empty());
  const std::vector<SeamGuess> answers = first_answers(guesses);
  EXPECT_LE(answers.size(), all);
  std::set<std::pair<int, int>> sewn;
  for (const SeamGuess& g : answers)
    for (const auto* side : {&g.seam.a, &g.seam.b})
      for (const pattern::Run& run : *side)
        EXPECT_TRUE(sewn.insert({run.panel, run.edge}).second) << g.seam.name;
}

TEST(Inference, HemsAreNeverSewn) {
  const Pattern p = unsewn(true);
  for (const SeamGuess& g : infer_seams(p))
    EXPECT_EQ(g.seam.name.find("hem"), std::string::npos);
}

TEST(Inference, SleevesOfATShirtCloseOnThemselves) {
  const std::vector<Vec2> sleeve = {{-15, 0}, {15, 0}, {18, 12}, {0, 26}, {-18, 12}};
  const std::vector<Vec2> front = {{-25, 0}, {25, 0},  {25, 42},  {20, 64}, {9, 68},
                                   {0, 58},  {-9, 68}, {-20, 64}, {-25, 42}};
  std::vector<Vec2> back = front;
  back[5].y() = 66;
  const Pattern shirt =
      outlines({{"front", front}, {"back", back}, {"sleeve 1", sleeve}, {"sleeve 2", sleeve}});
  EXPECT_TRUE(guesses(shirt, 2, 1, 2, 4));
  EXPECT_TRUE(guesses(shirt, 3, 1, 3, 4));
  EXPECT_FALSE(guesses(shirt, 0, 1, 0, 8)) << "a front's two sides are sewn to a back";
  EXPECT_TRUE(guesses(outlines({{"SHORT SLEEVE", sleeve}}), 0, 1, 0, 4));
  EXPECT_FALSE(guesses(outlines({{"front", sleeve}}), 0, 1, 0, 4));
}

const std::vector<Vec2> GORE = {{-9, 0}, {9, 0}, {5, 60}, {-5, 60}};

/// The gore whose left side (edge 3) is sewn to the right side (edge 1) of gore `k`, -1 for none.
int right_of(const std::vector<SeamGuess>& all, int k) {
  for (const SeamGuess& g : all)
    if (g.seam.a[0].panel == k && g.seam.a[0].edge == 1 && g.seam.b[0].edge == 3)
      return g.seam.b[0].panel;
  return -1;
}

TEST(Inference, GoresThatAreAllAlikeAreSewnToARingByOneAnswer) {
  std::vector<Outline> panels;
  for (int k = 0; k < 7; ++k)
    panels.push_back({std::to_string(k), GORE});
  const Pattern skirt = outlines(panels);
  const std::vector<SeamGuess> all = infer_seams(skirt);
  std::set<int> ring;
  for (int k = 0, n = 0; n < 7; ++n)
    ring.insert(k = std::max(right_of(all, k), 0));
  EXPECT_EQ(ring.size(), 7u);
  const io::Json doc = sewing_questions(skirt, all, "test");
  EXPECT_TRUE(std::any_of(doc["questions"].begin(), doc["questions"].end(), [](const io::Json& q) {
    return q["candidates"][0].contains("and") && q["candidates"][0]["and"].size() == 6;
  }));
}

TEST(Inference, GodetsAreNoGores) {
  std::vector<Outline> panels;
  for (int k = 0; k < 7; ++k)
    panels.push_back({std::to_string(k), {{-9, 0}, {9, 0}, {0, 60}}});
  EXPECT_TRUE(with_gore_rows(outlines(panels), {}).empty());
}

TEST(Inference, GoresStandInTheOrderOfTheirTopsAndOneThatIsLeftFillsTheGap) {
  std::vector<Vec2> band; // six stretches below
  for (int k = 0; k <= 6; ++k)
    band.push_back({10.0 * k, 0});
  band.push_back({60, 4});
  band.push_back({0, 4});
  std::vector<Outline> panels;
  for (int k = 0; k < 6; ++k)
    panels.push_back({std::to_string(k), GORE});
  panels.push_back({"band", band});
  const Pattern skirt = outlines(panels);
  std::vector<SeamGuess> given;
  const auto add = [&](int p, int e, int q, int f, bool certain) {
    SeamGuess g;
    g.seam.a = {{p, e, 0, 1}};
    g.seam.b = {{q, f, 1, 0}};
    g.score = 0.9;
    g.certain = certain;
    given.push_back(g);
  };
  add(6, 6, 6, 8, true); // the band closes
  const int order[] = {4, 0, 5, 2, 1};
  for (int k = 0; k < 5; ++k)
    add(order[k], 2, 6, k, false);
  add(4, 1, 5, 3, false); // no neighbours
  const std::vector<SeamGuess> all = with_gore_rows(skirt, given);
  EXPECT_EQ(right_of(all, 4), 0);
  EXPECT_EQ(right_of(all, 0), 5);
  EXPECT_EQ(right_of(all, 5), 2);
  EXPECT_EQ(right_of(all, 2), 1);
  EXPECT_EQ(right_of(all, 1), 3) << "the one that is left";
  EXPECT_EQ(right_of(all, 3), 4);
  EXPECT_TRUE(std::any_of(all.begin(), all.end(), [](const SeamGuess& g) {
    return g.seam.a[0].panel == 3 && g.seam.a[0].edge == 2 && g.seam.b[0].edge == 5;
  }));
  add(3, 1, 6, 7, true); // a certain seam of a side: no gores
  EXPECT_EQ(with_gore_rows(skirt, given).size(), given.size());
}

} // namespace
} // namespace sloper::pattern::test
