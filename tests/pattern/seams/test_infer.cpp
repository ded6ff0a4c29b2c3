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

TEST(Inference, HemsAreNeverSewn) {
  const Pattern p = unsewn(true);
  for (const SeamGuess& g : infer_seams(p)) EXPECT_EQ(g.seam.name.find("hem"), std::string::npos);
}

} // namespace
} // namespace sloper::pattern::test
