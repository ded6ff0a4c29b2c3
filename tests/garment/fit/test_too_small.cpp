#include <support/skin_garment.hpp>

#include <sloper/garment/fit/too_small.hpp>
#include <sloper/garment/materials.hpp>

#include <gtest/gtest.h>

namespace sloper::garment {

namespace {

/// What is said of trousers in a fabric that lie on the skin, stretched, when their drape ended.
std::string finding_on(double stretch, const std::string& fabric, bool at_rest = false,
                       const std::string& body_file = "ben.json") {
  static const body::Body body = measured("f-165-a");
  Garment trousers = skin_trousers(body, 0.002, 1 - 1 / (1 + stretch));
  trousers.materials[""] = material_preset(fabric);
  trousers.converged = at_rest;
  DrapeReport report;
  report.converged = at_rest;
  std::vector<Message> findings;
  judge_too_small(trousers, body, report, {"in/legs.json", body_file, "", false}, findings,
                  silent_reporter());
  if (findings.empty())
    return "";
  EXPECT_EQ(findings.size(), 1u);
  EXPECT_EQ(findings[0].id, "drape.cloth-too-small");
  return findings[0].text;
}

bool has(const std::string& text, const std::string& words) {
  return text.find(words) != std::string::npos;
}

} // namespace

TEST(too_small, leggings_of_woven_cloth_are_told_to_want_a_knit) {
  const std::string text = finding_on(0.17, "cotton-poplin");
  EXPECT_TRUE(has(text, "legs.json on ben.json: ")) << text;
  EXPECT_TRUE(has(text, "a hundredth of it is stretched by 17 %")) << text;
  EXPECT_TRUE(has(text, " wider than the cloth, which closes only stretched by ")) << text;
  EXPECT_TRUE(has(text, "where cotton-poplin reaches ")) << text;
  EXPECT_TRUE(has(text, "--material jersey (")) << text;
  EXPECT_TRUE(has(text, " reaches so far; ")) << text;
  EXPECT_FALSE(has(text, "orthotropic")) << text;
}

TEST(too_small, where_no_preset_reaches_so_far_the_softest_is_named_and_a_larger_size) {
  const std::string text = finding_on(0.7, "cotton-poplin");
  EXPECT_TRUE(has(text, "no preset reaches so far, --material jersey (")) << text;
  EXPECT_TRUE(has(text, "larger size")) << text;
}

TEST(too_small, cloth_that_reaches_or_rests_or_hangs_on_none_is_not_told) {
  EXPECT_EQ(finding_on(0.05, "cotton-poplin"), "") << "it is not stretched so far";
  EXPECT_EQ(finding_on(0.15, "jersey"), "") << "jersey gives that";
  EXPECT_EQ(finding_on(0.3, "cotton-poplin", true), "") << "it rests: told as stretched";
  EXPECT_EQ(finding_on(0.3, "cotton-poplin", false, ""), "");
}

} // namespace sloper::garment
