/// Cuffs, bands of several pieces, raglan sleeves, seams that go on, and versions of a part.
#include <support/pattern_texts.hpp>

#include <gtest/gtest.h>
#include <pattern/panel_words.hpp>
#include <pattern/seams/band_seams.hpp>
#include <pattern/seams/rim_seams.hpp>
#include <pattern/seams/ring_bands.hpp>
#include <pattern/seams/seam_order.hpp>
#include <sloper/io/json.hpp>
#include <sloper/pattern/seams/infer_seams.hpp>
#include <sloper/pattern/seams/piece_versions.hpp>

#include <algorithm>
#include <cstdlib>
#include <filesystem>

namespace sloper::pattern::test::bands {
namespace {

using Corners = std::vector<Vec2>;

std::string panel_text(const std::string& name, const Corners& corners) {
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

Pattern pattern_of(const std::vector<std::string>& panels) {
  std::string text;
  for (const std::string& panel : panels)
    text += (text.empty() ? "" : ", ") + panel;
  return own(
      R"({"format": "pattern", "version": 1, "length_unit": "cm", "name": "n", "panels": [)" +
      text + "]}");
}

Corners box(double w, double h) {
  return {{0, 0}, {w, 0}, {w, h}, {0, h}};
}
Corners mirrored(const Corners& corners) {
  Corners out;
  for (auto q = corners.rbegin(); q != corners.rend(); ++q)
    out.push_back({-q->x(), q->y()});
  return out;
}

/// Hem 0, side 1, armhole 2, shoulder 3, neck 4 and 5, shoulder 6, armhole 7, side 8.
const Corners FRONT = {{-25, 0}, {25, 0},  {25, 42},  {20, 64}, {9, 68},
                       {0, 58},  {-9, 68}, {-20, 64}, {-25, 42}};
/// Hem 0, seam 1, cap 2 and 3, seam 4.
const Corners SLEEVE = {{-15, 0}, {15, 0}, {18, 12}, {1, 26}, {-18, 12}};

Corners back() {
  Corners out = FRONT;
  out[5].y() = 66;
  return out;
}

SeamGuess guess(int panel, int edge, int other, int at, bool certain = true) {
  SeamGuess g;
  g.seam.name = std::to_string(panel) + "." + std::to_string(edge) + "-" + std::to_string(other) +
                "." + std::to_string(at);
  g.seam.a = {{panel, edge, 0, 1}};
  g.seam.b = {{other, at, 1, 0}};
  g.score = certain ? 0.999 : 0.9;
  g.certain = certain;
  return g;
}

std::vector<SeamGuess> sides_and_shoulders() {
  return {guess(0, 1, 1, 8), guess(0, 8, 1, 1), guess(0, 3, 1, 6), guess(0, 6, 1, 3)};
}

const SeamGuess* named(const std::vector<SeamGuess>& all, const std::string& name) {
  const auto found =
      std::find_if(all.begin(), all.end(), [&](const SeamGuess& g) { return g.seam.name == name; });
  return found == all.end() ? nullptr : &*found;
}

TEST(Cuffs, CutAsAPairGoOnTheEndsOfBothSleeves) {
  const Pattern p =
      pattern_of({panel_text("front", FRONT), panel_text("back", back()),
                  panel_text("sleeve 1", SLEEVE), panel_text("sleeve 2", mirrored(SLEEVE)),
                  panel_text("cuff 1", box(20, 12)), panel_text("cuff 2", box(20, 12))});
  std::vector<SeamGuess> guesses = sides_and_shoulders();
  guesses.push_back(guess(2, 1, 2, 4));
  guesses.push_back(guess(3, 4, 3, 2)); // mirrored: cap 0 and 1, seam 2, hem 3, seam 4
  guesses.push_back(guess(4, 0, 4, 2)); // a cuff closed the wrong way
  const std::vector<SeamGuess> all = with_bands(p, guesses);
  const SeamGuess *first = named(all, "cuff 1-sleeve"), *second = named(all, "cuff 2-sleeve");
  ASSERT_TRUE(first && second);
  EXPECT_EQ(first->seam.b[0].panel, 2);
  EXPECT_EQ(second->seam.b[0].panel, 3);
  EXPECT_TRUE(named(all, "cuff 1 ends") && named(all, "cuff 2 ends"));
  EXPECT_FALSE(named(all, "4.0-4.2"));
}

TEST(RingBands, AStandOfThreePiecesGoesOnTheNeckFromTheMiddleOfTheBack) {
  // The middle piece has its long sides in two edges each: 0 and 1 below, 3 and 4 above.
  const Corners middle = {{0, 0}, {7, 0}, {14, 0}, {14, 3}, {7, 3}, {0, 3}};
  Corners front = FRONT, behind = back();
  for (Corners* corners : {&front, &behind}) // armholes longer than the neck
    (*corners)[2].y() = (*corners)[8].y() = 30;
  const Pattern p =
      pattern_of({panel_text("P1", front), panel_text("P2", behind), panel_text("P3", middle),
                  panel_text("P4", box(14.5, 3)), panel_text("P5", box(14.5, 3))});
  std::vector<SeamGuess> guesses = sides_and_shoulders();
  guesses.push_back(guess(2, 2, 3, 3));
  guesses.push_back(guess(4, 1, 2, 5));
  guesses.push_back(guess(3, 1, 4, 3, false)); // closes the ring in front
  SeamGuess fold = guess(2, 0, 3, 2, false);
  fold.seam.kind = "gather";
  guesses.push_back(fold);
  const std::vector<SeamGuess> all = with_ring_bands(p, guesses);
  EXPECT_FALSE(named(all, fold.seam.name)) << "it would fold the band";
  const SeamGuess* band = named(all, "P3 band-P2");
  ASSERT_TRUE(band);
  EXPECT_FALSE(band->certain);
  EXPECT_EQ(band->seam.a.size(), 4u);
  EXPECT_EQ(band->seam.b.size(), 4u);
  EXPECT_EQ(band->seam.b.front().panel, 1);
  EXPECT_EQ(band->seam.b.back().panel, 1);
  ASSERT_TRUE(named(all, "3.1-4.3"));
  EXPECT_EQ(named(all, "3.1-4.3")->with.size(), 1u) << "one answer closes the ring and sets it on";
}

TEST(RingBands, WithoutARimThatTheyFitNothingIsTakenOut) {
  const Pattern p = pattern_of({panel_text("P1", box(20, 3)), panel_text("P2", box(20, 3))});
  SeamGuess fold = guess(0, 0, 1, 2, false);
  fold.seam.kind = "gather";
  EXPECT_EQ(with_ring_bands(p, {guess(0, 1, 1, 3), fold}).size(), 2u);
}

TEST(RimSeams, OneAnswerSewsARaglanSleeve) {
  const Pattern p =
      pattern_of({panel_text("front", FRONT), panel_text("back", back()),
                  panel_text("sleeve 1", SLEEVE), panel_text("sleeve 2", mirrored(SLEEVE))});
  const std::vector<SeamGuess> all = with_rim_seams(
      p, {guess(0, 1, 1, 8), guess(0, 8, 1, 1), guess(2, 1, 2, 4, false), guess(2, 2, 0, 7, false),
          guess(2, 3, 1, 2, false), guess(3, 0, 1, 7, false)});
  ASSERT_EQ(all.size(), 6u);
  EXPECT_EQ(all[2].with.size(), 3u);
}

TEST(SeamOrder, ASideThatWasCutUpGoesOnWhereHemsWouldBeSewn) {
  const Corners half = {{0, 0}, {25, 0}, {25.5, 26}, {25, 45}, {0, 45}};
  const Pattern p = pattern_of({panel_text("P1", half), panel_text("P2", mirrored(half))});
  const Panel& other = p.panels[1];
  const auto edge_at = [&](const Vec2& a, const Vec2& b) {
    for (int e = 0; e < other.n_edges(); ++e)
      if ((other.edge(e).path.front().p[0] - a / 100).norm() < 1e-9 &&
          (other.edge(e).path.back().p[3] - b / 100).norm() < 1e-9)
        return e;
    return -1;
  };
  const int upper = edge_at({-25, 45}, {-25.5, 26}), lower = edge_at({-25.5, 26}, {-25, 0}),
            hem = edge_at({-25, 0}, {0, 0});
  ASSERT_TRUE(upper >= 0 && lower >= 0 && hem >= 0);
  // Of P1: hem 0, lower side 1, upper side 2.
  std::vector<SeamGuess> guesses = {guess(0, 2, 1, upper)};
  EXPECT_TRUE(continue_seams(p, guesses).empty()) << "it may be a slit";
  guesses.push_back(guess(0, 0, 1, hem, false));
  const std::vector<Seam> continued = continue_seams(p, guesses);
  ASSERT_EQ(continued.size(), 1u);
  EXPECT_EQ(continued[0].a[0].edge, 1);
  EXPECT_EQ(continued[0].b[0].edge, lower);
}

const Corners LEG = {{-12, 0}, {12, 0},   {30, 70},  {22, 76},
                     {20, 95}, {-20, 98}, {-21, 78}, {-33, 70}};

TEST(Versions, OfTwoPairsOfLegsOneIsMade) {
  Corners shorter = LEG;
  for (Vec2& corner : shorter)
    if (corner.y() == 0)
      corner = {1.4 * corner.x(), 30};
  Pattern p =
      pattern_of({panel_text("long 1", LEG), panel_text("long 2", mirrored(LEG)),
                  panel_text("short 1", shorter), panel_text("short 2", mirrored(shorter))});
  std::optional<std::vector<SeamGuess>> inferred;
  const std::vector<PieceVersions> versions = take_versions(p, inferred);
  ASSERT_EQ(versions.size(), 1u);
  EXPECT_EQ(versions[0], (PieceVersions{{"long 1", "long 2"}, {"short 1", "short 2"}}));
  EXPECT_EQ(p.panels.size(), 2u);
  const io::Json doc = sewing_questions(p, infer_seams(p), "test", versions);
  EXPECT_EQ(doc["without"], io::Json({"short 1", "short 2"}));
  ASSERT_GE(doc["questions"].size(), 1u);
  EXPECT_EQ(doc["questions"][0]["candidates"][1]["without"], io::Json({"long 1", "long 2"}));
}

TEST(Versions, OfTwoCollarsOneIsMade) {
  const std::vector<std::string> shirt = {panel_text("front", FRONT), panel_text("back", back()),
                                          panel_text("sleeve 1", SLEEVE),
                                          panel_text("sleeve 2", mirrored(SLEEVE))};
  auto two = shirt;
  two.push_back(panel_text("collar a", box(38, 4)));
  two.push_back(panel_text("collar b", box(39, 4.2)));
  Pattern p = pattern_of(two);
  std::optional<std::vector<SeamGuess>> inferred;
  const std::vector<PieceVersions> versions = take_versions(p, inferred);
  ASSERT_EQ(versions.size(), 1u);
  EXPECT_EQ(versions[0], (PieceVersions{{"collar a"}, {"collar b"}}));
  auto one = shirt;
  one.push_back(panel_text("collar a", box(38, 4)));
  Pattern q = pattern_of(one);
  ASSERT_TRUE(inferred) << "nothing is inferred twice";
  const auto text = [](const Pattern& pattern, const std::vector<SeamGuess>& guesses) {
    return sewing_questions(pattern, guesses, "test").dump();
  };
  EXPECT_EQ(text(p, *inferred), text(p, infer_seams(p)));
  EXPECT_TRUE(take_versions(q, inferred).empty());
}

/// Files of AccuMark and CLO, which are no part of the project.
TEST(SharedPatterns, FilesOfPatternProgramsAskFewQuestions) {
  const char* shared = std::getenv("SLOPER_SHARED");
  const std::string folder = std::string(shared ? shared : "") + "/data/foreign/dxf-real/";
  if (!shared || !std::filesystem::exists(folder))
    GTEST_SKIP() << "SLOPER_SHARED names no folder with data/foreign/dxf-real";
  struct Asked {
    const char* file;
    std::size_t versions, most; ///< parts with versions; questions in all
  };
  // Sides cut up at notches; a raglan sleeve with cuffs; three collars; legs of three lengths; a
  // stand of three pieces.
  for (const Asked& asked :
       {Asked{"GMH1006F18_AAMA.DXF", 0, 0}, Asked{"GMH2446F17_INCLALLOWANCE_AAMA.DXF", 1, 4},
        Asked{"GMX1006S18-1.DXF", 1, 1}, Asked{"GLX4802S19_AAMA.DXF", 1, 1},
        Asked{"clo-pattern.dxf", 0, 5}, Asked{"clo2-pattern.dxf", 0, 5}}) {
    SCOPED_TRACE(asked.file);
    Pattern p = read_pattern(folder + asked.file, "");
    std::optional<std::vector<SeamGuess>> inferred;
    const std::vector<PieceVersions> versions = take_versions(p, inferred);
    EXPECT_EQ(versions.size(), asked.versions);
    const std::vector<SeamGuess> guesses = infer_seams(p);
    EXPECT_LE(sewing_questions(p, guesses, "test", versions)["questions"].size(), asked.most);
    for (const SeamGuess& g : guesses)
      p.seams.push_back(g.seam);
    EXPECT_TRUE(panels_apart(p).empty()) << "the first answers sew all pieces";
  }
}

TEST(Words, ALetterBetweenDigitsIsOfANumber) {
  EXPECT_FALSE(name_suggests_front(words_of("GMH2446F17BA")));
  EXPECT_TRUE(name_suggests_front(words_of("GMH2446F")));
  EXPECT_TRUE(name_suggests_front(words_of("12 F 3")));
}

} // namespace
} // namespace sloper::pattern::test::bands
