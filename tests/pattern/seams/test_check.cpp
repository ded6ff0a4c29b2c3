#include <support/pattern_texts.hpp>

#include <gtest/gtest.h>
#include <sloper/base/error.hpp>
#include <sloper/pattern/seams/check_pattern.hpp>

namespace sloper::pattern::test {
namespace {

std::string one_panel(const std::string& outline, const std::string& unit = "cm") {
  return R"({"format": "pattern", "version": 1, "length_unit": ")" + unit +
         R"(", "name": "p", "panels": [{"name": "bib", "outline": [)" + outline + "]}]}";
}

bool has(const std::vector<PatternFinding>& findings, const std::string& rule,
         const std::string& place, const std::string& fact) {
  return std::any_of(findings.begin(), findings.end(), [&](const PatternFinding& f) {
    return f.rule == rule && f.place.find(place) != std::string::npos &&
           f.fact.find(fact) != std::string::npos;
  });
}

std::string refusal(const std::string& text) {
  try {
    const Pattern p = own(text);
    require_sewable(p, "test.json");
    mesh_pattern(p, 0.015, "test.json");
  } catch (const Error& e) {
    EXPECT_EQ(e.exit_code(), 3) << e.what();
    return e.what();
  }
  return "";
}

TEST(Check, AGoodPatternHasNoFindings) {
  EXPECT_TRUE(check_pattern(own(tube_text())).empty());
}

TEST(Check, CrossingOutlineNamesBothEdgesAndThePlace) {
  const std::string bow = one_panel(
      R"({"edge": "a", "path": [["M", 0, 0], ["L", 40, 30]]}, {"edge": "b", "path": [["L", 40, 0]]}, {"edge": "c", "path": [["L", 0, 32]]}, {"edge": "d", "path": [["L", 0, 0]]})");
  EXPECT_TRUE(has(check_pattern(own(bow)), "crossing-outline", "bib: a", "crosses or touches c"));
  EXPECT_NE(refusal(bow).find("bib: a"), std::string::npos);
}

TEST(Check, LengthMismatchIsGivenInCentimetresAndPercent) {
  const std::string text = tube_text(
      R"(, {"name": "odd", "a": [{"panel": "front", "edge": "top"}], "b": [{"panel": "back", "edge": "hem", "from": 0.9, "to": 0}]})");
  EXPECT_TRUE(has(check_pattern(own(text)), "length-mismatch", "seam odd", "4.00 cm (11.1 %)"));
}

TEST(Check, AStatedEaseIsNoMismatch) {
  const std::string text = tube_text(
      R"(, {"name": "odd", "ease": "pleats", "a": [{"panel": "front", "edge": "top"}], "b": [{"panel": "back", "edge": "hem", "from": 0.9, "to": 0}]})");
  EXPECT_TRUE(check_pattern(own(text)).empty());
}

TEST(Check, SeamsSewnFaceToBackAreTold) {
  const std::string text = tube_text(
      R"(, {"name": "turned", "a": [{"panel": "front", "edge": "top"}], "b": [{"panel": "back", "edge": "top", "from": 0, "to": 1}]})");
  EXPECT_TRUE(has(check_pattern(own(text)), "face-to-back", "seam turned", "inside"));
}

TEST(Check, SharpSpikesAreTold) {
  const std::string spike = one_panel(
      R"({"edge": "a", "path": [["M", 0, 0], ["L", 40, 0], ["L", 40, 30], ["L", 21, 30], ["L", 20, 60], ["L", 19, 30], ["L", 0, 30]]}, {"edge": "d", "path": [["L", 0, 0]]})");
  EXPECT_TRUE(has(check_pattern(own(spike)), "sharp-spike", "bib: a", "at (20.00, 60.00) cm"));
}

TEST(Check, SidesThatDifferByTwentyTimesAreNoGather) {
  const auto seam = [](double to) {
    return R"(, {"name": "x", "kind": "gather", "a": [{"panel": "front", "edge": "top", "from": 0, "to": )" +
           std::to_string(to) +
           R"(}], "b": [{"panel": "back", "edge": "top", "from": 1, "to": 0}]})";
  };
  EXPECT_TRUE(
      has(check_pattern(own(tube_text(seam(0.01)))), "impossible-gather", "seam x", "0.40 cm"));
  EXPECT_THROW(require_sewable(own(tube_text(seam(0.01))), "t"), Error);
  EXPECT_NO_THROW(require_sewable(own(tube_text(seam(0.25))), "t"));
}

TEST(Check, BadPatternsAreRefusedNamingPanelEdgeAndCentimetres) {
  EXPECT_NE(
      refusal(
          one_panel(
              R"({"edge": "a", "path": [["M", 0, 0], ["L", 40, 0]]}, {"edge": "b", "path": [["L", 40, 30]]}, {"edge": "c", "path": [["L", 0, 30]]}, {"edge": "d", "path": [["L", 0, 1.5]]})"))
          .find("edge 'd' ends 1.50 cm from where 'a' starts"),
      std::string::npos);
  EXPECT_NE(
      refusal(
          one_panel(
              R"({"edge": "a", "path": [["M", 0, 0], ["L", 0, 0]]}, {"edge": "b", "path": [["L", 40, 30]]}, {"edge": "c", "path": [["L", 0, 0]]})"))
          .find("bib: a"),
      std::string::npos);
  EXPECT_NE(
      refusal(
          one_panel(
              R"({"edge": "a", "path": [["M", 0, 0], ["L", 40, 0]]}, {"edge": "b", "path": [["L", 0, 0]]})"))
          .find("encloses"),
      std::string::npos);
  EXPECT_NE(
      refusal(
          one_panel(
              R"({"edge": "a", "path": [["M", 0, 0], ["L", 40, 0]]}, {"edge": "b", "path": [["L", 40, 30]]}, {"edge": "c", "path": [["L", 0, 0]]})",
              "m"))
          .find("the unit is wrong"),
      std::string::npos);
  EXPECT_NE(
      refusal(
          tube_text(
              R"(, {"name": "x", "a": [{"panel": "frnt", "edge": "top"}], "b": [{"panel": "back", "edge": "top"}]})"))
          .find("did you mean 'front'"),
      std::string::npos);
  EXPECT_NE(
      refusal(
          tube_text(
              R"(, {"name": "x", "a": [{"panel": "front", "edge": "topp"}], "b": [{"panel": "back", "edge": "top"}]})"))
          .find("did you mean 'top'"),
      std::string::npos);
  EXPECT_NE(
      refusal(
          tube_text(
              R"(, {"name": "x", "a": [{"panel": "front", "edge": "top", "from": 1.4}], "b": [{"panel": "back", "edge": "top"}]})"))
          .find("fractions from 0 to 1"),
      std::string::npos);
  EXPECT_NE(refusal(R"({"format": "pattern", "version": 1, "length_unit": "ell", "panels": []})")
                .find("unknown unit 'ell'"),
            std::string::npos);
  EXPECT_NE(refusal(R"({"format": "pattern", "version": 2, "length_unit": "cm", "panels": []})")
                .find("newer"),
            std::string::npos);
  EXPECT_NE(refusal(R"({"format": "pattern", "version": 1, "length_unit": "cm", "panls": []})")
                .find("did you mean \"panels\""),
            std::string::npos);
}

} // namespace
} // namespace sloper::pattern::test
