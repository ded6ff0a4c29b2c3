/// Planes and lengths that limit the motion of a step.
#include <gtest/gtest.h>
#include <sloper/cloth/contact/motion_limits.hpp>

using namespace sloper;
using namespace sloper::cloth;

TEST(MotionLimits, LimitsKeepPlanesAndLengths) {
  MotionLimits limits;
  limits.reset(2);
  limits.planes.push_back({1, 1, {0, 0, 0, 0}, Vec3::UnitY(), 0.5, 0});
  limits.planes.push_back({1, 0, {1, 0, 0, 0}, Vec3::UnitX(), 0, 0.2});
  limits.max_displacement[1] = 0.15;
  const std::vector<Vec3> x = {{0, 1, 0}, {0, 0, 0}};
  std::vector<Vec3> dx = {{0.3, -2, 0}, {1, 0, 1}};
  std::vector<char> held(2, 0);
  limits.apply(x, dx, held);
  EXPECT_NEAR(dx[0].y(), -0.5, 1e-12);
  EXPECT_NEAR(dx[0].x(), 0.3, 1e-12) << "sliding along a plane is free";
  EXPECT_LE(dx[1].norm(), 0.15 + 1e-12);
  EXPECT_LE(dx[1].x(), 0.2);
  EXPECT_TRUE(held[0] && held[1]);
}

TEST(MotionLimits, PlanesThatFollowStopOnlyWhatWouldMeet) {
  MotionLimits limits;
  limits.reset(2);
  limits.planes.push_back({2, 1, {0, 1, 0, 0}, Vec3::UnitY(), 0.55, 0.45});
  const std::vector<Vec3> x = {{0, 1, 0}, {0, 0, 0}};
  const auto limited = [&](double above, double below, bool follow) {
    limits.planes_translate = follow;
    std::vector<Vec3> dx = {{0.1, above, 0}, {-0.1, below, 0}};
    std::vector<char> held(2, 0);
    limits.apply(x, dx, held);
    EXPECT_EQ(held[0], dx[0].y() != above);
    EXPECT_EQ(held[1], dx[1].y() != below);
    return Vec2(dx[0].y(), dx[1].y());
  };
  EXPECT_EQ(limited(3, 3, true), Vec2(3, 3));
  EXPECT_EQ(limited(3, 3, false), Vec2(3, 0.45));
  EXPECT_EQ(limited(-3, -3, true), Vec2(-3, -3));
  EXPECT_NEAR((limited(3, 5, true) - Vec2(3, 3.9)).norm(), 0, 1e-12)
      << "the faster one comes up to the other";
  EXPECT_NEAR((limited(-5, -3, true) - Vec2(-3.9, -3)).norm(), 0, 1e-12);
  EXPECT_NEAR((limited(-5, 0.2, true) - limited(-5, 0.2, false) - Vec2(-0.25, 0)).norm(), 0, 1e-12)
      << "one takes the room that the other leaves";
  EXPECT_EQ(limited(-5, 5, true), limited(-5, 5, false)) << "half the way each";
}

TEST(MotionLimits, PlanesThatFollowLeaveTheElementsOnTheirSides) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> in(-1, 1);
  const auto point = [&] { return Vec3(in(random), in(random), in(random)); };
  for (int round = 0; round < 300; ++round) {
    constexpr int N = 30;
    std::vector<Vec3> x(N), dx(N);
    const Vec3 wind = point();
    for (Vec3& p : x)
      p = point();
    for (Vec3& d : dx)
      d = wind + 0.5 * point();
    MotionLimits limits;
    limits.planes_translate = true;
    limits.reset(N);
    for (int i = 0; i < N; i += 7)
      limits.max_displacement[i] = 0.2;
    for (int g = 0; g < 60; ++g) { // planes that present positions keep, between one and three or
                                   // two and two, and some that stay
      SeparatingPlane guard;
      guard.n = 4;
      guard.n_above = g % 10 == 0 ? 4 : 1 + g % 2;
      for (int k = 0; k < 4; ++k)
        guard.particle[k] = static_cast<int>(random() % N);
      guard.normal = point().normalized();
      guard.above = 1e300;
      guard.below = -1e300;
      for (int k = 0; k < 4; ++k) {
        const double height = guard.normal.dot(x[guard.particle[k]]);
        if (k < guard.n_above)
          guard.above = std::min(guard.above, height - 0.02);
        else
          guard.below = std::max(guard.below, height + 0.02);
      }
      if (guard.n_above == 4 || guard.above >= guard.below)
        limits.planes.push_back(guard);
    }
    const std::vector<Vec3> wanted = dx;
    std::vector<char> held(N, 0);
    limits.apply(x, dx, held);
    for (int i = 0; i < N; ++i)
      EXPECT_LE(dx[i].norm(), std::min(wanted[i].norm(), limits.max_displacement[i]) + 1e-9);
    for (const SeparatingPlane& g : limits.planes) {
      double most = 1e300, least = -1e300;
      for (int k = 0; k < 4; ++k) {
        const double height = g.normal.dot(x[g.particle[k]] + dx[g.particle[k]]);
        if (k < g.n_above)
          most = std::min(most, height - g.above);
        else
          least = std::max(least, height - g.below);
      }
      EXPECT_LE(g.n_above == 4 ? 0 : least, most + 1e-9);
    }
  }
}
