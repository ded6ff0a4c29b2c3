/// Wrists by the girth of arms that are given as lists of sections.
#include <body/measure/arm_girths.hpp>

#include <gtest/gtest.h>

using namespace sloper;
using namespace sloper::body;

namespace {

constexpr double TALL = 1.6, LEAST_TO_PALM = 0.92;

/// Sections 5 mm apart, of the girths between the given (along, girth), both shares of stature.
ArmTrace arm_of(const std::vector<Vec2>& girths) {
  ArmTrace arm;
  for (std::size_t k = 0; k + 1 < girths.size(); ++k)
    for (double along = girths[k].x(); along < girths[k + 1].x(); along += 0.003) {
      LimbSection section;
      const double share = (along - girths[k].x()) / (girths[k + 1].x() - girths[k].x());
      section.along = along * TALL;
      section.girth = TALL * ((1 - share) * girths[k].y() + share * girths[k + 1].y());
      arm.sections.push_back(section);
    }
  return arm;
}

} // namespace

TEST(ArmGirths, wrist_of_an_open_hand_is_behind_its_palm) {
  const ArmTrace arm =
      arm_of({{0.01, 0.05}, {0.06, 0.13}, {0.11, 0.095}, {0.2, 0.15}, {0.3, 0.18}});
  const auto wrist = wrist_by_girth(arm, LEAST_TO_PALM, TALL);
  ASSERT_TRUE(wrist);
  EXPECT_NEAR(*wrist / TALL, 0.11, 0.004);
}

/// Of eight scans with fists one had a forearm wider than its fist within a hand's length of the
/// knuckles: its wrists were 69 mm off, and its hands were said to be missing.
TEST(ArmGirths, wrist_of_a_fist_is_found_before_a_forearm_that_is_wider) {
  const ArmTrace arm = arm_of({{0.006, 0.115},
                               {0.014, 0.137},
                               {0.05, 0.1055},
                               {0.08, 0.12},
                               {0.14, 0.157},
                               {0.18, 0.152},
                               {0.25, 0.18}});
  const auto wrist = wrist_by_girth(arm, LEAST_TO_PALM, TALL);
  ASSERT_TRUE(wrist);
  EXPECT_NEAR(*wrist / TALL, 0.05, 0.004);
}

TEST(ArmGirths, forearm_without_a_hand_shows_no_wrist) {
  // the first sections of a blunt end are cut askew
  const ArmTrace arm = arm_of(
      {{0.003, 0.104}, {0.006, 0.114}, {0.010, 0.098}, {0.03, 0.105}, {0.14, 0.16}, {0.3, 0.18}});
  EXPECT_FALSE(wrist_by_girth(arm, LEAST_TO_PALM, TALL));
}
