#include "pattern_texts.hpp"

#include <base/error.hpp>
#include <gtest/gtest.h>
#include <pattern/check_pattern.hpp>
#include <pattern/finished_measures.hpp>

namespace sloper::pattern::test {
namespace {

/// A fault put into a sound pattern, and what the complaint has to name.
struct Fault {
  const char* name;
  const char* from; ///< first place of this in the text ...
  const char* to;   ///< ... becomes this
  std::vector<const char*> says;
};

const char* SOUND = R"({"format": "pattern", "version": 1, "length_unit": "cm", "name": "sound", "panels": [
  {"name": "front", "outline": [{"edge": "hem", "path": [["M", -20, 0], ["L", 20, 0]]}, {"edge": "side_l", "path": [["L", 20, 60]]},
    {"edge": "top", "path": [["L", -20, 60]]}, {"edge": "side_r", "path": [["L", -20, 0]]}],
    "holes": [[{"edge": "h1", "path": [["M", 0, 40], ["L", 0, 44]]}, {"edge": "h2", "path": [["L", 6, 42]]}, {"edge": "h3", "path": [["L", 0, 40]]}]],
    "notches": [{"edge": "side_l", "at": 0.5}]},
  {"name": "back", "outline": [{"edge": "hem", "path": [["M", -20, 0], ["L", 20, 0]]}, {"edge": "left", "path": [["L", 20, 60]]},
    {"edge": "top", "path": [["Q", 0, 55, -20, 60]]}, {"edge": "right", "path": [["L", -20, 0]]}], "notches": [{"edge": "right", "at": 0.5}]},
  {"name": "strap", "outline": [{"edge": "end", "path": [["M", 0, 0], ["L", 4, 0]]}, {"edge": "outer", "path": [["L", 4, 30]]},
    {"edge": "tip", "path": [["L", 0, 30]]}, {"edge": "inner", "path": [["L", 0, 0]]}]}],
 "seams": [{"name": "left", "a": [{"panel": "front", "edge": "side_l"}], "b": [{"panel": "back", "edge": "right"}]},
  {"name": "strap end", "a": [{"panel": "strap", "edge": "end"}], "b": [{"panel": "front", "edge": "top", "from": 0.15, "to": 0.05}]},
  {"name": "strap tip", "a": [{"panel": "strap", "edge": "tip"}], "b": [{"panel": "back", "edge": "top", "from": 0.95, "to": 0.85}]}]})";

const std::vector<Fault> FAULTS = {
    {"open outline", R"({"edge": "side_r", "path": [["L", -20, 0]]})", R"({"edge": "side_r", "path": [["L", -20, 3]]})", {"front", "side_r", "3.00 cm", "hem"}},
    {"outline open by a millimetre",
     R"({"edge": "side_r", "path": [["L", -20, 0]]})",
     R"({"edge": "side_r", "path": [["L", -20, 0.1]]})",
     {"front", "side_r", "0.10 cm"}},
    {"bow tie",
     R"({"edge": "left", "path": [["L", 20, 60]]},
    {"edge": "top", "path": [["Q", 0, 55, -20, 60]]})",
     R"({"edge": "left", "path": [["L", -20, 60]]},
    {"edge": "top", "path": [["L", 30, 90]]})",
     {"back", "left", "cross", "right", "cm"}},
    {"curve crosses itself", R"([["Q", 0, 55, -20, 60]])", R"([["C", -90, 90, 90, 90, -20, 60]])", {"back", "top", "crosses", "cm"}},
    {"curve crosses another edge", R"([["Q", 0, 55, -20, 60]])", R"([["Q", 0, -70, -20, 60]])", {"back", "hem", "top", "cm"}},
    {"spike", R"({"edge": "tip", "path": [["L", 0, 30]]})", R"({"edge": "tip", "path": [["L", 4, 90], ["L", 0, 30]]})", {"strap", "tip", "degrees", "cm"}},
    {"hole outside",
     R"([["M", 0, 40], ["L", 0, 44]]}, {"edge": "h2", "path": [["L", 6, 42]]}, {"edge": "h3", "path": [["L", 0, 40]])",
     R"([["M", 40, 40], ["L", 40, 44]]}, {"edge": "h2", "path": [["L", 46, 42]]}, {"edge": "h3", "path": [["L", 40, 40]])",
     {"front", "h1", "outside", "cm"}},
    {"hole crosses the outline", R"(["L", 6, 42]])", R"(["L", 26, 42]])", {"front", "side_l", "h", "cm"}},
    {"hole drawn the wrong way",
     R"([["M", 0, 40], ["L", 0, 44]]}, {"edge": "h2", "path": [["L", 6, 42]]}, {"edge": "h3", "path": [["L", 0, 40]])",
     R"([["M", 0, 40], ["L", 6, 42]]}, {"edge": "h2", "path": [["L", 0, 44]]}, {"edge": "h3", "path": [["L", 0, 40]])",
     {"front", "hole 1", "counter-clockwise"}},
    {"no area",
     R"([["L", 4, 30]]},
    {"edge": "tip", "path": [["L", 0, 30]]})",
     R"([["L", 2, 0]]},
    {"edge": "tip", "path": [["L", 1, 0]]})",
     {"strap", "cm2"}},
    {"duplicate points", R"([["L", 4, 30]]})", R"([["L", 4, 30]]}, {"edge": "nothing", "path": [["L", 4, 30]]})", {"strap", "nothing", "0.00 cm"}},
    {"tiny edge", R"([["L", 4, 30]]})", R"([["L", 4, 30]]}, {"edge": "speck", "path": [["L", 3.9, 30]]})", {"strap", "speck", "0.10 cm"}},
    {"unit too large", R"("length_unit": "cm")", R"("length_unit": "m")", {"6000.00 cm", "unit"}},
    {"unit too small", R"("length_unit": "cm")", R"("length_unit": "mm", "name": "x")", {"twice"}},
    {"inches for millimetres", R"("length_unit": "cm")", R"("length_unit": "furlong")", {"furlong", "known are m, cm, mm and in"}},
    {"side too short",
     R"({"panel": "back", "edge": "right"})",
     R"({"panel": "back", "edge": "right", "from": 1, "to": 0.1})",
     {"left", "60.00 cm", "54.00 cm", "6.00 cm", "11.1 %"}},
    {"sewn twice",
     R"("from": 0.95, "to": 0.85)",
     R"("from": 0.95, "to": 0.85}, {"panel": "front", "edge": "side_l", "from": 0.2, "to": 0.1)",
     {"front", "side_l", "6.00 cm", "twice", "left", "strap tip"}},
    {"overlapping runs",
     R"("from": 0.15, "to": 0.05}]},)",
     R"("from": 0.15, "to": 0.05}]}, {"name": "again", "a": [{"panel": "back", "edge": "hem", "from": 0, "to": 0.1}], "b": [{"panel": "front", "edge": "top", "from": 0.2, "to": 0.1}]},)",
     {"front", "top", "2.00 cm", "strap end", "again"}},
    {"many gathers",
     R"("name": "strap end", )",
     R"("name": "strap end", "kind": "gather", "b": [{"panel": "front", "edge": "top", "from": 0.9, "to": 0.05}], "a": [{"panel": "strap", "edge": "end"}]}, {"name": "other", )",
     {"strap end", "strap: end", "4.00 cm", "34.00 cm", "4 to 1"}},
    {"face to back", R"({"panel": "back", "edge": "right"})", R"({"panel": "back", "edge": "right", "from": 0, "to": 1})", {"left", "outside", "inside"}},
    {"notches miss",
     R"("notches": [{"edge": "right", "at": 0.5}])",
     R"("notches": [{"edge": "right", "at": 0.4}])",
     {"left", "front: side_l", "30.00 cm", "6.00 cm"}},
    {"nothing sewn to it",
     R"({"name": "strap end", "a": [{"panel": "strap", "edge": "end"}], "b": [{"panel": "front", "edge": "top", "from": 0.15, "to": 0.05}]},
  {"name": "strap tip", "a": [{"panel": "strap", "edge": "tip"}])",
     R"({"name": "strap tip", "a": [{"panel": "back", "edge": "hem", "from": 0.1, "to": 0.2}])",
     {"strap", "nothing is sewn"}},
    {"unknown edge", R"({"panel": "back", "edge": "right"})", R"({"panel": "back", "edge": "rihgt"})", {"back", "rihgt", "did you mean 'right'"}},
    {"unknown panel", R"({"panel": "back", "edge": "right"})", R"({"panel": "bakc", "edge": "right"})", {"bakc", "did you mean 'back'"}},
    {"two panels of one name", R"("name": "strap", "outline")", R"("name": "back", "outline")", {"two panels named 'back'"}},
    {"two edges of one name", R"({"edge": "tip",)", R"({"edge": "end",)", {"strap", "two edges named 'end'"}},
    {"run of no length", R"("from": 0.15, "to": 0.05)", R"("from": 0.15, "to": 0.15)", {"no length"}},
    {"run past its edge", R"("from": 0.15, "to": 0.05)", R"("from": 1.15, "to": 0.05)", {"1.15", "0 to 1"}},
    {"notch past its edge", R"("at": 0.5)", R"("at": 1.5)", {"1.5", "notch"}},
    {"unknown letter", R"(["Q", 0, 55, -20, 60])", R"(["S", 0, 55, -20, 60])", {"'S'", "known are M, L, Q, C and A"}},
    {"too few numbers", R"(["Q", 0, 55, -20, 60])", R"(["Q", 0, 55, -20])", {"'Q' takes 4 numbers, not 3"}},
    {"arc without radius", R"(["Q", 0, 55, -20, 60])", R"(["A", -3, 0, 1, -20, 60])", {"radius is not positive"}},
    {"misspelt key", R"("notches": [{"edge": "side_l")", R"("nothces": [{"edge": "side_l")", {"nothces", "notches"}},
    {"not a number", R"(["Q", 0, 55, -20, 60])", R"(["Q", 0, 1e999, -20, 60])", {"too large"}},
};

std::string complaints(const std::string& text) {
  try {
    const Pattern p = own(text);
    std::string all;
    for (const PatternFinding& f : check_pattern(p)) all += f.severity + ": " + f.rule + ": " + f.place + ": " + f.fact + "\n";
    return all;
  } catch (const Error& e) {
    return e.what();
  }
}

TEST(BadPatterns, TheSoundOneHasNothingWrong) { EXPECT_EQ(complaints(SOUND), ""); }

TEST(BadPatterns, EachNamesPanelEdgeAndCentimetres) {
  EXPECT_GE(FAULTS.size(), 30u);
  for (const Fault& fault : FAULTS) {
    std::string text = SOUND;
    const std::size_t at = text.find(fault.from);
    ASSERT_NE(at, std::string::npos) << fault.name;
    text.replace(at, std::string(fault.from).size(), fault.to);
    const std::string said = complaints(text);
    for (const char* word : fault.says) EXPECT_NE(said.find(word), std::string::npos) << fault.name << " should say '" << word << "': " << said;
  }
}

TEST(Check, FindingsGoIntoSarif) {
  const std::vector<PatternFinding> findings = {{"error", "sewn-twice", "front: top", "2.00 cm are sewn twice"}, {"info", "unsewn-panel", "back", "nothing"}};
  const io::Json log = findings_sarif(findings, "/some/where/p.json", "pattern-mesh");
  EXPECT_EQ(log["version"], "2.1.0");
  const io::Json& run = log["runs"][0];
  EXPECT_EQ(run["tool"]["driver"]["rules"].size(), 2u);
  EXPECT_EQ(run["results"][0]["level"], "error");
  EXPECT_EQ(run["results"][1]["level"], "note");
  EXPECT_EQ(run["results"][0]["locations"][0]["physicalLocation"]["artifactLocation"]["uri"], "p.json") << "no absolute paths in documents";
}

TEST(FinishedMeasures, ATubeHasTwoOpeningsAndOneGirth) {
  const FinishedMeasures m = finished_measures(own(tube_text()), "t");
  ASSERT_EQ(m.openings.size(), 2u);
  for (const Opening& o : m.openings) EXPECT_NEAR(o.length, 0.8, 1e-9);
  EXPECT_EQ(m.openings[0].edges.size(), 2u);
  EXPECT_NEAR(m.cloth_m2, 0.48, 1e-9);
  ASSERT_GE(m.around.size(), 5u);
  for (const auto& [depth, length] : m.around) EXPECT_NEAR(length, 0.8, 1e-6) << depth;
  EXPECT_NEAR(m.seams[0].second, 0.6, 1e-9);
}

} // namespace
} // namespace sloper::pattern::test
