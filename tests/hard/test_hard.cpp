/// The hard cases in short: some points and seeds of each; `make hard` runs all of them over 20
/// seeds.
#include "hard_case.hpp"

#include <algorithm>
#include <cctype>
#include <gtest/gtest.h>

using namespace sloper;
using namespace sloper::hard;

namespace {

const std::vector<Case>& all_cases() {
  static const std::vector<Case> cases = read_cases(SLOPER_SOURCE_DIR "/tests/hard/cases");
  return cases;
}

} // namespace

class Hard : public testing::TestWithParam<std::size_t> {};

namespace {

Case fault(const std::string& kind) {
  Case c;
  c.scene = "fault";
  c.parameters = {{"kind", kind}};
  c.pass = io::Json::object();
  c.cpu_s = 0.05;
  return c;
}

} // namespace

TEST_P(Hard, holds) {
  const Case& c = all_cases()[GetParam()];
  std::string listed;
  for (std::size_t k : c.ci_points)
    for (int seed = 0; seed < c.ci_seeds; ++seed) {
      const Point& p = c.points[k];
      const std::string broken = run_point(c, p, static_cast<std::uint64_t>(seed)).broken;
      const std::string where = c.name + " [" + p.name + "] seed " + std::to_string(seed);
      if (p.failing.empty()) {
        EXPECT_EQ(broken, "") << where;
        continue;
      }
      listed += where + (broken.empty() ? " holds here though it is listed as failing; "
                                        : " is listed as failing: " + broken + "; ");
    }
  if (!listed.empty() && !HasFailure())
    GTEST_SKIP() << listed;
}

INSTANTIATE_TEST_SUITE_P(cases, Hard, testing::Range<std::size_t>(0, all_cases().size()),
                         [](const auto& at) {
                           std::string name = all_cases()[at.param].file;
                           std::replace_if(
                               name.begin(), name.end(),
                               [](unsigned char ch) { return !std::isalnum(ch); }, '_');
                           return name;
                         });

TEST(HardCases, are_forty_or_more_and_each_says_what_goes_wrong_elsewhere_and_what_must_hold) {
  EXPECT_GE(all_cases().size(), 40u);
  for (const Case& c : all_cases()) {
    EXPECT_FALSE(c.elsewhere.empty()) << c.file;
    EXPECT_FALSE(c.invariant.empty()) << c.file;
    EXPECT_GE(c.pass.size(), 1u) << c.file;
  }
}

TEST(HardRunner, tells_crashes_endless_loops_exceptions_and_broken_bounds) {
  const Point here{io::Json::object(), "", ""};
  EXPECT_EQ(run_point(fault("none"), here, 0).broken, "");
  EXPECT_NE(run_point(fault("endless"), here, 0).broken.find("did not end"), std::string::npos);
  EXPECT_NE(run_point(fault("exception"), here, 0).broken.find("unforeseen"), std::string::npos);
  EXPECT_NE(run_point(fault("not_finite"), here, 0).broken.find("not finite"), std::string::npos);
  EXPECT_NE(run_point(fault("refused"), here, 0).broken.find("exit 3"), std::string::npos);
  Case bounded = fault("none");
  bounded.pass = {{"strain_p99", {{"max", 0.1}}}};
  EXPECT_NE(run_point(bounded, here, 0).broken.find("strain_p99 0.5"), std::string::npos);
  Case mistaken = fault("none");
  mistaken.parameters["speling"] = 1;
  EXPECT_NE(run_point(mistaken, here, 0).broken.find("speling"), std::string::npos);
#if !defined(__SANITIZE_ADDRESS__) && \
    !defined(__SANITIZE_THREAD__) // which tell of a crash in their own way
  EXPECT_NE(run_point(fault("crash"), here, 0).broken.find("crashed"), std::string::npos);
#endif
}
