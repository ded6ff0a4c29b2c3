#include <garment/fit/fit_section.hpp>

#include <gtest/gtest.h>

namespace sloper::garment {

namespace {

/// An open half tube of radius 1 about y, from angle a to b.
SectionChain arc(double a, double b, double radius, bool backwards = false) {
  SectionChain chain;
  const int n = 100;
  for (int i = 0; i < n; ++i) {
    const double u = a + (b - a) * i / n, v = a + (b - a) * (i + 1) / n;
    const Vec3 p(radius * std::sin(u), 0, radius * std::cos(u)),
        q(radius * std::sin(v), 0, radius * std::cos(v));
    chain.segments.push_back({0, p, q, (q - p).norm(), 0});
    chain.length += (q - p).norm();
    chain.rest_length += (q - p).norm();
  }
  if (backwards)
    chain.reverse();
  return chain;
}

} // namespace

TEST(fit_section, front_and_back_are_bridged_under_the_arms) {
  const double h = M_PI / 2;
  const auto line =
      assemble_line({arc(-0.8 * h, 0.8 * h, 0.15), arc(M_PI - 0.8 * h, M_PI + 0.8 * h, 0.15, true)},
                    Vec3::Zero(), Vec3::UnitY(), 0.4);
  ASSERT_TRUE(line);
  EXPECT_EQ(line->chains.size(), 2u);
  EXPECT_NEAR(line->bridged, 2 * 2 * 0.15 * std::sin(0.2 * h), 1e-6);
  EXPECT_NEAR(line->rest, 0.15 * 2 * M_PI * 0.8 + line->bridged, 1e-3);
}

TEST(fit_section, a_facing_over_a_front_counts_once) {
  const auto line =
      assemble_line({arc(-1.5, 1.5, 0.15), arc(1.7, 4.5, 0.15), arc(-0.5, 0.5, 0.152)},
                    Vec3::Zero(), Vec3::UnitY(), 0.4);
  ASSERT_TRUE(line);
  EXPECT_EQ(line->chains.size(), 2u);
}

TEST(fit_section, a_scarf_does_not_go_round) {
  EXPECT_FALSE(assemble_line({arc(-1, 1, 0.15)}, Vec3::Zero(), Vec3::UnitY(), 0.4));
}

} // namespace sloper::garment
