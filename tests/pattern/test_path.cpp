#include <gtest/gtest.h>
#include <sloper/base/units.hpp>
#include <sloper/pattern/path.hpp>

#include <cmath>

namespace sloper::pattern {
namespace {

TEST(Path, ArcHasTheCirclesLengthAndStaysOnTheCircle) {
  const Path arc = circle_arc(Vec2(0.2, 0), Vec2(0, 0.2), 0.2, false, true);
  EXPECT_NEAR(length(arc), 0.2 * units::PI / 2, 1e-8);
  const ArcLength by_length(arc);
  for (int k = 0; k <= 20; ++k)
    EXPECT_NEAR(by_length.at(by_length.length() * k / 20).norm(), 0.2, 1e-7);
}

TEST(Path, ArcFlagsChooseSenseAndSize) {
  const Vec2 a(0, 0), b(1, 0);
  EXPECT_LT(ArcLength(circle_arc(a, b, 1, false, true)).at(0.5).y(), 0)
      << "counter-clockwise to the right bulges downwards";
  EXPECT_GT(ArcLength(circle_arc(a, b, 1, false, false)).at(0.5).y(), 0);
  EXPECT_NEAR(length(circle_arc(a, b, 1, true, true)) + length(circle_arc(a, b, 1, false, true)),
              2 * units::PI, 1e-6);
}

TEST(Path, RadiusBelowHalfTheChordIsRaised) {
  EXPECT_NEAR(length(circle_arc(Vec2(0, 0), Vec2(1, 0), 0.1, false, true)), 0.5 * units::PI, 1e-6);
}

TEST(Path, PointsByArcLengthAreEquallySpacedOnACurve) {
  const Path path = {Segment::cubic(Vec2(0, 0), Vec2(0.5, 0), Vec2(0.1, 0.3), Vec2(0.4, 0.4)),
                     Segment::straight(Vec2(0.4, 0.4), Vec2(0.4, 0.6))};
  const ArcLength arc(path);
  double sum = 0;
  const int n = 2000;
  for (int k = 0; k < n; ++k)
    sum += (arc.at(arc.length() * (k + 1) / n) - arc.at(arc.length() * k / n)).norm();
  EXPECT_NEAR(sum, arc.length(), 3e-6); // chords
  const double step = (arc.at(arc.length() / n) - arc.at(0)).norm();
  for (int k = 1; k < n; ++k)
    EXPECT_NEAR((arc.at(arc.length() * (k + 1) / n) - arc.at(arc.length() * k / n)).norm(), step,
                2e-6);
}

TEST(Path, AreaOfADiscOfArcsIsPiRSquared) {
  const Path upper = circle_arc(Vec2(0.3, 0), Vec2(-0.3, 0), 0.3, false, true),
             lower = circle_arc(Vec2(-0.3, 0), Vec2(0.3, 0), 0.3, false, true);
  EXPECT_NEAR(signed_area({upper, lower}), units::PI * 0.09, 1e-7);
  EXPECT_NEAR(signed_area({reversed(lower), reversed(upper)}), -units::PI * 0.09, 1e-7);
}

} // namespace
} // namespace sloper::pattern
