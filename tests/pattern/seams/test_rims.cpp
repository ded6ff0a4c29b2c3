/// Sleeves into armholes, ribs on necks, and the order of seams around panels.
#include <support/pattern_texts.hpp>

#include <gtest/gtest.h>
#include <pattern/seams/rim_seams.hpp>
#include <pattern/seams/rims.hpp>
#include <pattern/seams/seam_order.hpp>

#include <cmath>
#include <set>

namespace sloper::pattern::test {
namespace {

std::string panel_text(const std::string& name, const std::vector<Vec2>& corners) {
  std::string outline;
  for (std::size_t k = 0; k < corners.size(); ++k) {
    const Vec2 &from = corners[k], &to = corners[(k + 1) % corners.size()];
    const std::string start =
        k ? "" : R"(["M", )" + std::to_string(from.x()) + ", " + std::to_string(from.y()) + "], ";
    outline += std::string(k ? ", " : "") + R"({"edge": "edge)" + std::to_string(k) +
               R"(", "path": [)" + start + R"(["L", )" + std::to_string(to.x()) + ", " +
               std::to_string(to.y()) + "]]}";
  }
  return R"({"name": ")" + name + R"(", "outline": [)" + outline + "]}";
}

/// Edges of front and back: hem 0, side 1, armhole 2, shoulder 3, neck 4 and 5, shoulder 6,
/// armhole 7, side 8. Of a sleeve: hem 0, seam 1, cap 2 and 3, seam 4; the cap's first half is
/// `more` cm longer. Of the collar: 40 by 3 cm.
Pattern shirt(double more, const std::string& sleeve) {
  const std::vector<Vec2> front = {{-25, 0}, {25, 0},  {25, 42},  {20, 64}, {9, 68},
                                   {0, 58},  {-9, 68}, {-20, 64}, {-25, 42}};
  std::vector<Vec2> back = front, left = {{-15, 0}, {15, 0}, {18, 12}, {0, 26}, {-18, 12}};
  back[5].y() = 66;
  back[3].y() = 64.5;
  back[7].y() = 64.5; // a longer armhole than the front's
  left[3].x() = -more;
  std::vector<Vec2> right = left;
  right[3].x() = more;
  return own(
      R"({"format": "pattern", "version": 1, "length_unit": "cm", "name": "n", "panels": [)" +
      panel_text("front", front) + ", " + panel_text("back", back) + ", " +
      panel_text(sleeve + "1", left) + ", " + panel_text(sleeve + "2", right) + ", " +
      panel_text("collar", {{0, 0}, {40, 0}, {40, 3}, {0, 3}}) + "]}");
}

SeamGuess guess(int panel, int edge, int other, int at, bool certain = true) {
  SeamGuess g;
  g.seam.name = std::to_string(edge) + "-" + std::to_string(at);
  g.seam.a = {{panel, edge, 0, 1}};
  g.seam.b = {{other, at, 1, 0}};
  g.score = certain ? 0.999 : 0.9;
  g.certain = certain;
  return g;
}

/// Front to back, as they face each other: the front's left side is the back's right one.
std::vector<SeamGuess> sides_and_shoulders() {
  return {guess(0, 1, 1, 8), guess(0, 8, 1, 1), guess(0, 3, 1, 6), guess(0, 6, 1, 3)};
}

double length_of(const Pattern& p, const std::vector<Run>& side) {
  return side_length(p, side);
}

TEST(Rims, OfATopAreItsHemNeckAndArmholes) {
  const Pattern p = shirt(0, "sleeve ");
  std::vector<Seam> seams;
  for (const SeamGuess& g : sides_and_shoulders())
    seams.push_back(g.seam);
  std::vector<double> trunk;
  for (const Rim& r : rims_of(p, seams))
    if (r.has(0)) {
      EXPECT_TRUE(r.has(1));
      trunk.push_back(std::round(100 * r.length));
    }
  EXPECT_EQ(trunk, (std::vector<double>{100, 46, 45, 46})) << "hem, armhole, neck, armhole";
}

/// The same trunk with sleeves of two pieces, of which the back reaches over the shoulder by 6 cm:
/// panels 2 to 5 are front and back of the right one and of the left one.
Pattern shirt_with_halves() {
  const Pattern whole = shirt(0, "sleeve ");
  const std::vector<Vec2> front = {{0, 0}, {15, 0}, {18, 12}, {0, 26}},
                          back = {{-15, 0}, {0, 0}, {0, 26}, {0, 32}, {-18, 12}};
  Pattern p =
      own(R"({"format": "pattern", "version": 1, "length_unit": "cm", "name": "n", "panels": [)" +
          panel_text("SLEEVE FR", front) + ", " + panel_text("SLEEVE BK", back) + "]}");
  for (const int k : {0, 1}) {
    p.panels.push_back(mirror_image(p.panels[k]));
    p.panels.back().name += "_mirror";
  }
  p.panels.insert(p.panels.begin(), whole.panels.begin(), whole.panels.begin() + 2);
  return p;
}

TEST(RimSeams, HalvesOfSleevesAreSewnToEachOtherAndGoIntoArmholesAsTheyAreCalled) {
  Pattern p = shirt_with_halves();
  std::vector<SeamGuess> guesses = sides_and_shoulders();
  guesses.push_back(guess(3, 0, 0, 7, false)); // a hem into an armhole
  const std::vector<SeamGuess> all = with_rim_seams(p, guesses);
  ASSERT_EQ(all.size(), 12u);
  for (std::size_t k = 4; k < all.size(); ++k)
    EXPECT_FALSE(all[k].certain) << "caps that are gathered are asked about";
  EXPECT_EQ(all[4].with.size(), 7u) << "one answer tells all";
  std::set<std::pair<int, int>> caps;
  for (const SeamGuess& g : all)
    if (g.seam.name.find(" cap-") != std::string::npos) {
      const int half = g.seam.a[0].panel, trunk = g.seam.b[0].panel;
      caps.insert({half, trunk});
      EXPECT_EQ(half % 2, trunk) << "a front half on the front";
      EXPECT_EQ(g.seam.kind, half % 2 ? "gather" : "seam");
      const int edge = g.seam.b[0].edge; // armholes: 2 is the front's left one and the back's right
      const bool is_right = half < 4;
      EXPECT_EQ(edge, is_right == (half % 2 == 1) ? 2 : 7) << g.seam.name;
    }
  EXPECT_EQ(caps.size(), 4u);
  std::vector<Seam> seams;
  for (const SeamGuess& g : all)
    seams.push_back(g.seam);
  std::vector<double> rims;
  for (const Rim& r : rims_of(p, seams))
    rims.push_back(std::round(100 * r.length));
  EXPECT_EQ(rims, (std::vector<double>{100, 45, 30, 30})) << "hem, neck, wrists";

  p.panels.push_back(shirt(0, "sleeve ").panels[4]); // a collar that would be long enough for both
  int on_neck = 0;
  for (const SeamGuess& g : with_rim_seams(p, guesses))
    if (g.seam.name == "collar-neck") {
      on_neck += g.seam.b[0].panel < 2;
      EXPECT_FALSE(touches(g.seam, {2, 3, 4, 5})) << "a wrist is shorter, and no neck";
    }
  EXPECT_EQ(on_neck, 1);
}

TEST(RimSeams, SleevesGoIntoArmholesWithTheLongerHalfAtTheLongerOne) {
  for (const double more : {-1.0, 1.0}) {
    SCOPED_TRACE(more);
    const Pattern p = shirt(more, "sleeve ");
    std::vector<SeamGuess> guesses = sides_and_shoulders();
    guesses.push_back(guess(2, 0, 0, 7, false)); // a hem into an armhole
    std::vector<const SeamGuess*> caps;
    const std::vector<SeamGuess> all = with_rim_seams(p, guesses);
    for (const SeamGuess& g : all) {
      EXPECT_TRUE(g.certain) << g.seam.name;
      if (g.seam.name.find(" cap ") != std::string::npos)
        caps.push_back(&g);
    }
    ASSERT_EQ(caps.size(), 4u);
    for (const SeamGuess* g : caps) {
      const int panel = g->seam.b[0].panel;
      EXPECT_EQ(length_of(p, g->seam.a) > 0.228, panel == 1)
          << g->seam.name << ": the longer half at the back";
      EXPECT_NEAR(length_of(p, g->seam.b), panel == 1 ? 0.2305 : 0.2256, 1e-3);
    }
    std::set<std::pair<int, int>> edges;
    for (const SeamGuess* g : caps)
      edges.insert({g->seam.b[0].panel, g->seam.b[0].edge});
    EXPECT_EQ(edges.size(), 4u) << "each at its own armhole";
  }
}

TEST(RimSeams, PiecesWithoutANameAreAskedAbout) {
  const Pattern p = shirt(1, "P");
  const std::vector<SeamGuess> all = with_rim_seams(p, sides_and_shoulders());
  const auto own = std::find_if(all.begin(), all.end(), [](const SeamGuess& g) {
    return g.seam.a[0].panel == 2 && g.seam.b[0].panel == 2;
  });
  ASSERT_NE(own, all.end());
  EXPECT_FALSE(own->certain);
  EXPECT_EQ(own->with.size(), 5u) << "one answer tells both sleeves' seams and caps";
}

TEST(RimSeams, ACollarGoesAroundTheNeckFromTheMiddleOfTheBack) {
  const Pattern p = shirt(1, "sleeve ");
  const std::vector<SeamGuess> all = with_rim_seams(p, sides_and_shoulders());
  const auto neck = std::find_if(all.begin(), all.end(),
                                 [](const SeamGuess& g) { return g.seam.name == "collar-neck"; });
  ASSERT_NE(neck, all.end());
  EXPECT_NEAR(length_of(p, neck->seam.a), 0.4, 1e-9);
  EXPECT_EQ(neck->seam.b.front().panel, 1);
  EXPECT_EQ(neck->seam.b.back().panel, 1);
  EXPECT_EQ(neck->seam.b.size(), 4u);
  EXPECT_NE(std::find_if(all.begin(), all.end(),
                         [](const SeamGuess& g) { return g.seam.name == "collar ends"; }),
            all.end());
}

TEST(SeamOrder, ShouldersAreCertainWhereSidesAreAndTheOtherAnswerWouldTwist) {
  const Pattern p = shirt(0, "sleeve ");
  std::vector<SeamGuess> guesses = {guess(0, 1, 1, 8), guess(0, 8, 1, 1), guess(0, 3, 1, 6, false),
                                    guess(0, 6, 1, 3, false)};
  guesses[2].twin = 3;
  guesses[3].twin = 2;
  guesses[2].instead = {guess(0, 3, 1, 3, false)};
  guesses[3].instead = {guess(0, 6, 1, 6, false)};
  auto twisted = guesses;
  twisted[2] = guess(0, 3, 1, 3, false);
  twisted[3] = guess(0, 6, 1, 6, false);
  twisted[2].twin = 3;
  twisted[3].twin = 2;
  twisted[2].instead = {guess(0, 3, 1, 6, false)};
  twisted[3].instead = {guess(0, 6, 1, 3, false)};
  for (auto* list : {&guesses, &twisted}) {
    settle_by_order(p, *list);
    EXPECT_TRUE((*list)[2].certain && (*list)[3].certain);
    EXPECT_EQ((*list)[2].seam.b[0].edge, 6);
    EXPECT_EQ((*list)[3].seam.b[0].edge, 3);
  }
}

TEST(SeamOrder, HemsAreNotCertainForIt) {
  const Pattern p = shirt(0, "sleeve ");
  std::vector<SeamGuess> guesses = {guess(0, 1, 1, 8), guess(0, 8, 1, 1), guess(0, 2, 1, 7, false),
                                    guess(0, 7, 1, 2, false)};
  guesses[2].twin = 3;
  guesses[3].twin = 2;
  settle_by_order(p, guesses);
  EXPECT_FALSE(guesses[2].certain) << "it begins where a side ends";
}

TEST(SeamOrder, HemsOfFrontAndBackMakeABagAndGodetsDoNot) {
  const Pattern p = shirt(0, "sleeve ");
  std::vector<SeamGuess> guesses = {guess(0, 1, 1, 8), guess(0, 8, 1, 1), guess(0, 0, 1, 0, false),
                                    guess(0, 3, 1, 6, false)};
  drop_bags(p, guesses);
  ASSERT_EQ(guesses.size(), 3u);
  EXPECT_EQ(guesses[2].seam.a[0].edge, 3);
  const Pattern skirt =
      own(R"({"format": "pattern", "version": 1, "length_unit": "cm", "name": "n", "panels": [)" +
          panel_text("skirt", {{0, 0}, {20, 0}, {30, 40}, {40, 0}, {60, 0}, {60, 70}, {0, 70}}) +
          ", " + panel_text("godet", {{0, 0}, {24, 0}, {12, 39.4}}) + "]}");
  guesses = {guess(0, 1, 1, 2), guess(0, 2, 1, 1, false)};
  drop_bags(skirt, guesses);
  EXPECT_EQ(guesses.size(), 2u);
}

TEST(RimSeams, LeggingsCloseOnThemselvesAndMeetAtBothCrotchCurves) {
  const std::vector<Vec2> leg = {{-12, 0}, {12, 0},   {30, 70},  {22, 76},
                                 {20, 95}, {-20, 98}, {-21, 78}, {-33, 70}};
  std::vector<Vec2> mirrored;
  for (auto q = leg.rbegin(); q != leg.rend(); ++q)
    mirrored.push_back({-q->x(), q->y()});
  const Pattern p =
      own(R"({"format": "pattern", "version": 1, "length_unit": "cm", "name": "n", "panels": [)" +
          panel_text("legging 1", leg) + ", " + panel_text("legging 2", mirrored) + "]}");
  const std::vector<SeamGuess> all = with_rim_seams(p, {});
  ASSERT_EQ(all.size(), 4u);
  for (const SeamGuess& g : all) {
    EXPECT_TRUE(g.certain);
    EXPECT_NEAR(length_of(p, g.seam.a), length_of(p, g.seam.b), 0.02);
  }
  EXPECT_EQ(all[0].seam.a[0].panel, all[0].seam.b[0].panel);
  EXPECT_NE(all[2].seam.a[0].panel, all[2].seam.b[0].panel);
}

} // namespace
} // namespace sloper::pattern::test
