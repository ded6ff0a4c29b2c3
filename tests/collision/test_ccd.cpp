#include <collision/ccd.hpp>
#include <collision/distance.hpp>

#include "shapes.hpp"

#include <gtest/gtest.h>

namespace sloper::collision {
namespace {

using shapes::random_point;
using Corners = std::array<Vec3, 3>;
using Ends = std::array<Vec3, 2>;

Vec3 mix(const Vec3& a, const Vec3& b, double t) { return a + t * (b - a); }

TEST(ContinuousCollision, VertexThroughFaceIsCaughtBeforeItPasses) {
  const Corners t = {Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 1, 0)};
  const auto hit = vertex_face_impact({0.2, 0.2, 1}, {0.2, 0.2, -1}, t, t);
  ASSERT_TRUE(hit);
  EXPECT_LT(*hit, 0.5);
  EXPECT_GT(*hit, 0.4);
  EXPECT_FALSE(vertex_face_impact({0.2, 0.2, 1}, {0.2, 0.2, 0.2}, t, t));
  EXPECT_FALSE(vertex_face_impact({2, 2, 1}, {2, 2, -1}, t, t));
}

TEST(ContinuousCollision, EverythingMovingTogetherNeverMeets) {
  const Vec3 d(100, -50, 3);
  const Corners t = {Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 1, 0)}, u = {t[0] + d, t[1] + d, t[2] + d};
  EXPECT_FALSE(vertex_face_impact({0.2, 0.2, 1e-6}, Vec3(0.2, 0.2, 1e-6) + d, t, u));
}

TEST(ContinuousCollision, TouchingAtTheStartIsTimeZero) {
  const Corners t = {Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 1, 0)};
  EXPECT_EQ(vertex_face_impact({0.25, 0.25, 0}, {0, 0, 1}, t, t), 0.0);
}

TEST(ContinuousCollision, IsNeverLateOnRandomMotions) {
  Random random(71);
  int hits = 0;
  for (int i = 0; i < 1500; ++i) {
    const bool faces = i % 2;
    Vec3 p0[4], p1[4];
    for (int k = 0; k < 4; ++k) p0[k] = random_point(random), p1[k] = random_point(random);
    if (i % 7 == 0) p0[3] = p0[2], p1[3] = p1[2] + random_point(random, 1e-10); // degenerate face or edge
    const auto distance = [&](double t) {
      Vec3 q[4];
      for (int k = 0; k < 4; ++k) q[k] = mix(p0[k], p1[k], t);
      return std::sqrt(faces ? point_triangle(q[0], q[1], q[2], q[3]).squared_distance : edge_edge(q[0], q[1], q[2], q[3]).squared_distance);
    };
    const auto hit = faces ? vertex_face_impact(p0[0], p1[0], Corners{p0[1], p0[2], p0[3]}, Corners{p1[1], p1[2], p1[3]})
                           : edge_edge_impact(Ends{p0[0], p0[1]}, Ends{p1[0], p1[1]}, Ends{p0[2], p0[3]}, Ends{p1[2], p1[3]});
    const double end = hit ? *hit : 1;
    hits += hit.has_value();
    for (int s = 0; s <= 300; ++s) ASSERT_GT(distance(end * s / 300), 0.02 * distance(0)) << i; // nothing was passed on the way
    if (hit) {
      ASSERT_LT(distance(*hit), 0.11 * distance(0) + 1e-12) << "stopped without need";
    }
  }
  EXPECT_GT(hits, 50);
}

TEST(ContinuousCollision, KeepsTheAskedDistance) {
  const Corners t = {Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 1, 0)};
  const auto hit = vertex_face_impact({0.2, 0.2, 1}, {0.2, 0.2, -1}, t, t, 0.3);
  ASSERT_TRUE(hit);
  EXPECT_GE(1 - 2 * *hit, 0.3);
}

} // namespace
} // namespace sloper::collision
