#include <support/pattern_texts.hpp>

#include <gtest/gtest.h>
#include <io/json.hpp>
#include <pattern/seams/infer_seams.hpp>

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

TEST(Inference, AmbiguousEdgesBecomeQuestions) {
  const Pattern p = unsewn(false);
  const io::Json doc = sewing_questions(p, infer_seams(p), "test");
  EXPECT_GT(doc["questions"].size(), 0u);
  EXPECT_GE(doc["questions"][0]["candidates"].size(), 1u);
}

/// The only panel's outline from corners, cm.
Pattern one_outline(const std::string& name, const std::vector<Vec2>& corners) {
  std::string outline;
  for (std::size_t k = 0; k < corners.size(); ++k) {
    const Vec2 &from = corners[k], &to = corners[(k + 1) % corners.size()];
    const std::string end =
        R"(["L", )" + std::to_string(to.x()) + ", " + std::to_string(to.y()) + "]";
    outline +=
        std::string(k ? ", " : "") + R"({"edge": "edge)" + std::to_string(k) + R"(", "path": [)" +
        (k ? ""
           : R"(["M", )" + std::to_string(from.x()) + ", " + std::to_string(from.y()) + "], ") +
        end + "]}";
  }
  return own(
      R"({"format": "pattern", "version": 1, "length_unit": "cm", "name": "n", "panels": [{"name": ")" +
      name + R"(", "outline": [)" + outline + "]}]}");
}

bool guesses(const Pattern& p, int a, int b) {
  const auto all = infer_seams(p);
  return std::any_of(all.begin(), all.end(), [&](const SeamGuess& g) {
    return g.seam.a[0].edge == a && g.seam.b[0].edge == b;
  });
}

TEST(Inference, ADartIsADeepReflexCorner) {
  EXPECT_FALSE(guesses(
      one_outline("front", {{-20, 0}, {0, 0}, {20, 0}, {20, 60}, {0, 60}, {-20, 60}}), 0, 1))
      << "a hem with a point at its middle";
  EXPECT_TRUE(guesses(
      one_outline("front", {{-20, 0}, {-1, 0}, {0, 12}, {1, 0}, {20, 0}, {20, 60}, {-20, 60}}), 1,
      2));
}

TEST(Inference, ASleeveClosesOnItself) {
  const std::vector<Vec2> sleeve = {{-15, 0}, {15, 0}, {18, 12}, {0, 26}, {-18, 12}};
  EXPECT_TRUE(guesses(one_outline("SHORT SLEEVE", sleeve), 1, 4));
  EXPECT_FALSE(guesses(one_outline("front", sleeve), 1, 4))
      << "a front's two sides are sewn to a back";
}

TEST(Inference, HemsAreNeverSewn) {
  const Pattern p = unsewn(true);
  for (const SeamGuess& g : infer_seams(p)) EXPECT_EQ(g.seam.name.find("hem"), std::string::npos);
}

} // namespace
} // namespace sloper::pattern::test
