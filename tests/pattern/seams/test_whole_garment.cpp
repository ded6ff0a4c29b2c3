#include <support/pattern_texts.hpp>

#include <gtest/gtest.h>
#include <pattern/seams/whole_garment.hpp>

#include <cmath>

namespace sloper::pattern::test {
namespace {

constexpr double SURE = 4.6, DOUBTFUL = -1; // log-odds
constexpr int EDGES = 4;                    // of each panel: bottom, right, top, left

/// Rectangles of the same height; side 4 p + e is edge e of panel p.
struct Rectangles {
  Pattern pattern;
  std::vector<SeamSide> sides;
  SeamAssembly::Result found;

  explicit Rectangles(const std::vector<double>& widths_cm) {
    std::string text;
    for (const double width : widths_cm) {
      const std::string w = std::to_string(width);
      text +=
          std::string(text.empty() ? "" : ", ") + R"({"name": "P)" + std::to_string(text.size()) +
          R"(", "outline": [{"edge": "0", "path": [["M", 0, 0], ["L", )" + w +
          R"(, 0]]}, {"edge": "1", "path": [["L", )" + w +
          R"(, 30]]}, {"edge": "2", "path": [["L", 0, 30]]}, {"edge": "3", "path": [["L", 0, 0]]}]})";
    }
    pattern =
        own(R"({"format": "pattern", "version": 1, "length_unit": "cm", "name": "n", "panels": [)" +
            text + "]}");
    sides = seam_sides(pattern, all_corners(pattern), 0);
    found.base.assign(sides.size() * sides.size(), -3);
  }
  static int side(int panel, int edge) { return EDGES * panel + edge; }
  void settle(int p, int e, int q, int f, double odds) {
    const int i = side(p, e), j = side(q, f);
    found.pairs[{std::min(i, j), std::max(i, j)}] = odds;
    likes(p, e, q, f, odds);
  }
  void likes(int p, int e, int q, int f, double odds) {
    const std::size_t n = sides.size(), i = static_cast<std::size_t>(side(p, e)),
                      j = static_cast<std::size_t>(side(q, f));
    found.base[i * n + j] = found.base[j * n + i] = odds;
  }
  /// A ring of two panels.
  void tube(int p, int q, double odds) {
    settle(p, 1, q, 3, odds);
    settle(p, 3, q, 1, odds);
  }
  PairOdds whole() const { return as_one_garment(pattern, sides, found, SURE, DOUBTFUL, {}).pairs; }
  static bool has(const PairOdds& pairs, int p, int e, int q, int f) {
    const int i = side(p, e), j = side(q, f);
    return pairs.count({std::min(i, j), std::max(i, j)}) > 0;
  }
};

TEST(OpenRims, TwoPanelsMakeATubeAndItsEndsAHandle) {
  const Rectangles r({40, 40});
  OpenRims rims(r.pattern, r.sides);
  EXPECT_EQ(rims.rims().size(), 2u);
  EXPECT_FALSE(rims.same_part(0, 4));
  EXPECT_FALSE(rims.makes_handle(1, 7)) << "of two parts";
  rims.sew(1, 7);
  EXPECT_TRUE(rims.same_part(0, 4));
  EXPECT_EQ(rims.rims().size(), 1u);
  EXPECT_FALSE(rims.makes_handle(3, 5)) << "the same rim is split";
  rims.sew(3, 5);
  ASSERT_EQ(rims.rims().size(), 2u);
  EXPECT_EQ(rims.rims()[0], (std::vector<int>{0, 4}));
  EXPECT_EQ(rims.rims()[1], (std::vector<int>{2, 6}));
  EXPECT_TRUE(rims.makes_handle(0, 2)) << "its upper end to its lower one";
}

TEST(WholeGarment, WristsAreNotSewnToEachOther) {
  Rectangles r({40, 40, 20, 20});
  r.tube(0, 1, 6);
  r.tube(2, 3, 6);
  r.settle(0, 2, 2, 0, 3); // one end of a sleeve on the trunk
  r.settle(1, 2, 3, 0, 3);
  r.settle(2, 2, 0, 0, 0.5); // its other end on the other end of the trunk
  r.settle(3, 2, 1, 0, 0.5);
  const PairOdds pairs = r.whole();
  EXPECT_FALSE(Rectangles::has(pairs, 2, 2, 0, 0));
  EXPECT_FALSE(Rectangles::has(pairs, 3, 2, 1, 0));
  EXPECT_EQ(pairs.size(), 6u);
}

TEST(WholeGarment, ATwistedCuffIsTurnedRound) {
  Rectangles r({20, 20, 20, 20});
  r.tube(0, 1, 6);
  r.settle(0, 2, 2, 0, 3);
  r.settle(1, 2, 3, 0, 3);
  r.settle(2, 1, 3, 1, 2); // right to right, left to left: what is up on one is down on the other
  r.settle(2, 3, 3, 3, 2);
  r.likes(2, 1, 3, 3, 1.5);
  r.likes(2, 3, 3, 1, 1.5);
  const PairOdds pairs = r.whole();
  EXPECT_TRUE(Rectangles::has(pairs, 2, 1, 3, 3));
  EXPECT_TRUE(Rectangles::has(pairs, 2, 3, 3, 1));
  EXPECT_TRUE(Rectangles::has(pairs, 0, 2, 2, 0)) << "and stays where it was sewn on";
}

TEST(WholeGarment, ACollarIsOneTubeAndNotOneInFrontAndOneBehind) {
  // The trunk: front right, front left, back left, back right, in a ring; the collar alike.
  Rectangles r({20, 20, 20, 20, 20, 20, 20, 20});
  for (int k = 0; k < 4; ++k) {
    r.settle(k, 1, (k + 1) % 4, 3, 6);
    r.settle(k, 2, 4 + k, 0, 3);
  }
  r.settle(4, 1, 5, 3, 2); // in front
  r.settle(6, 1, 7, 3, 2); // behind
  r.settle(4, 3, 5, 1, 1); // what should be on the shoulders
  r.settle(6, 3, 7, 1, 1);
  r.likes(5, 1, 6, 3, 0.5);
  r.likes(7, 1, 4, 3, 0.5);
  const PairOdds pairs = r.whole();
  EXPECT_TRUE(Rectangles::has(pairs, 5, 1, 6, 3));
  EXPECT_TRUE(Rectangles::has(pairs, 7, 1, 4, 3));
}

TEST(WholeGarment, ABandIsSewnOnTheRimThatSpeaksForItMost) {
  Rectangles r({40, 40, 80, 80});
  r.tube(0, 1, 6);
  r.tube(2, 3, 6);
  r.likes(0, 0, 2, 2, -2); // the waist of a gathered skirt
  r.likes(1, 0, 3, 2, -2);
  const PairOdds pairs = r.whole();
  EXPECT_EQ(pairs.size(), 6u);
  EXPECT_TRUE(Rectangles::has(pairs, 0, 0, 2, 2));
  EXPECT_TRUE(Rectangles::has(pairs, 1, 0, 3, 2));
}

TEST(WholeGarment, AFlatPieceIsNotSewnOverARim) {
  Rectangles r({40, 40, 40});
  r.tube(0, 1, 6);
  EXPECT_EQ(r.whole().size(), 2u);
}

TEST(WholeGarment, WhatChamfersLeaveOpenIsSewn) {
  // A tube whose side seams are cut off by 2 mm: too short for sides.
  Pattern p = own(
      R"({"format": "pattern", "version": 1, "length_unit": "cm", "name": "n", "panels": [
  {"name": "front", "outline": [{"edge": "0", "path": [["M", 0, 0], ["L", 40, 0]]}, {"edge": "1", "path": [["L", 40, 29.8]]}, {"edge": "2", "path": [["L", 39.9, 30]]}, {"edge": "3", "path": [["L", 39.9, 60]]}, {"edge": "4", "path": [["L", 0, 60]]}, {"edge": "5", "path": [["L", 0, 0]]}]},
  {"name": "back", "outline": [{"edge": "0", "path": [["M", 0, 0], ["L", 40, 0]]}, {"edge": "1", "path": [["L", 40, 60]]}, {"edge": "2", "path": [["L", 0.1, 60]]}, {"edge": "3", "path": [["L", 0.1, 30]]}, {"edge": "4", "path": [["L", 0, 29.8]]}, {"edge": "5", "path": [["L", 0, 0]]}]}]})");
  const auto seam = [](const char* name, pattern::Run a, pattern::Run b) {
    SeamGuess guess;
    guess.seam.name = name;
    guess.seam.a = {a};
    guess.seam.b = {b};
    guess.certain = true;
    guess.score = 1;
    return guess;
  };
  std::vector<SeamGuess> guesses{seam("upper", {0, 3, 0, 1}, {1, 3, 1, 0}),
                                 seam("lower", {0, 1, 0, 1}, {1, 5, 1, 0})};
  close_slivers(p, guesses);
  ASSERT_EQ(guesses.size(), 3u);
  EXPECT_TRUE(guesses[2].certain);
  EXPECT_EQ(guesses[2].seam.a[0].edge + guesses[2].seam.b[0].edge, 6);
}

} // namespace
} // namespace sloper::pattern::test
