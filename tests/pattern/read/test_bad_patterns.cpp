#include <support/pattern_texts.hpp>

#include <gtest/gtest.h>
#include <sloper/base/error.hpp>
#include <sloper/io/json.hpp>
#include <sloper/pattern/measure/finished_measures.hpp>
#include <sloper/pattern/seams/check_pattern.hpp>

#include <filesystem>
#include <sstream>

namespace sloper::pattern::test {
namespace {

std::string text_of(const std::string& file) {
  std::ostringstream text;
  text << std::ifstream(std::filesystem::path(SLOPER_SOURCE_DIR) / "tests" / "pattern" / "bad" /
                            file,
                        std::ios::binary)
              .rdbuf();
  return text.str();
}

std::string complaints(const std::string& text) {
  try {
    const Pattern p = own(text);
    std::string all;
    for (const PatternFinding& f : check_pattern(p))
      all += f.severity + ": " + f.rule + ": " + f.place + ": " + f.fact + "\n";
    return all;
  } catch (const Error& e) {
    return e.what();
  }
}

TEST(BadPatterns, TheSoundOneHasNothingWrong) {
  EXPECT_EQ(complaints(text_of("sound.pattern.json")), "");
}

/// Each file of the folder has one fault; says.json holds what the complaint has to name.
TEST(BadPatterns, EachNamesPanelEdgeAndCentimetres) {
  const io::Json says = io::parse_json(text_of("says.json"), "says.json");
  EXPECT_GE(says.size(), 30u);
  std::size_t n_files = 0;
  for (const auto& entry : std::filesystem::directory_iterator(
           std::filesystem::path(SLOPER_SOURCE_DIR) / "tests" / "pattern" / "bad"))
    n_files += entry.path().filename().string().find("-") == 2;
  EXPECT_EQ(n_files, says.size()) << "a file of the folder is not looked at";
  for (const auto& [file, words] : says.items()) {
    const std::string said = complaints(text_of(file));
    for (const auto& word : words)
      EXPECT_NE(said.find(word.get<std::string>()), std::string::npos)
          << file << " should say '" << word << "': " << said;
  }
}

TEST(Check, FindingsGoIntoSarif) {
  const std::vector<PatternFinding> findings = {
      {"error", "sewn-twice", "front: top", "2.00 cm are sewn twice"},
      {"info", "unsewn-panel", "back", "nothing"}};
  const io::Json log = findings_sarif(findings, "/some/where/p.json", "pattern-mesh");
  EXPECT_EQ(log["version"], "2.1.0");
  const io::Json& run = log["runs"][0];
  EXPECT_EQ(run["tool"]["driver"]["rules"].size(), 2u);
  EXPECT_EQ(run["results"][0]["level"], "error");
  EXPECT_EQ(run["results"][1]["level"], "note");
  EXPECT_EQ(run["results"][0]["locations"][0]["physicalLocation"]["artifactLocation"]["uri"],
            "p.json")
      << "no absolute paths in documents";
}

TEST(FinishedMeasures, ATubeHasTwoOpeningsAndOneGirth) {
  const FinishedMeasures m = finished_measures(own(tube_text()), "t");
  ASSERT_EQ(m.openings.size(), 2u);
  for (const Opening& o : m.openings)
    EXPECT_NEAR(o.length, 0.8, 1e-9);
  EXPECT_EQ(m.openings[0].edges.size(), 2u);
  EXPECT_NEAR(m.cloth_m2, 0.48, 1e-9);
  ASSERT_GE(m.around.size(), 5u);
  for (const auto& [depth, length] : m.around)
    EXPECT_NEAR(length, 0.8, 1e-6) << depth;
  EXPECT_NEAR(m.seams[0].second, 0.6, 1e-9);
}

TEST(BadPatterns, panels_without_any_seam_are_an_error_that_can_be_meshed) {
  Pattern pattern = own(tube_text());
  pattern.seams.clear();
  const std::vector<PatternFinding> findings = check_pattern(pattern);
  ASSERT_EQ(findings.size(), 1u);
  EXPECT_EQ(findings[0].severity, "error");
  EXPECT_NE(findings[0].fact.find("2 panels"), std::string::npos) << findings[0].fact;
  EXPECT_FALSE(forbids_sewing(findings[0]));
  pattern.panels.pop_back();
  EXPECT_EQ(check_pattern(pattern).at(0).severity, "info") << "a cloth";
  pattern = own(tube_text());
  pattern.seams.clear();
  pattern.source_format = "dxf";
  EXPECT_EQ(check_pattern(pattern).at(0).severity, "warning")
      << "its seams are guessed when it is meshed";
}

} // namespace
} // namespace sloper::pattern::test
