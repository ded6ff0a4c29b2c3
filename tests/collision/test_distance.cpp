#include <sloper/collision/distance.hpp>

#include <support/shapes.hpp>

#include <gtest/gtest.h>

namespace sloper::collision {
namespace {

using shapes::random_point;

double sampled_edge_edge(const Vec3& a0, const Vec3& a1, const Vec3& b0, const Vec3& b1) {
  double best = 1e300;
  for (int i = 0; i <= 400; ++i)
    best = std::min(best, point_edge(a0 + i / 400.0 * (a1 - a0), b0, b1).squared_distance);
  return std::sqrt(best);
}

double sampled_point_triangle(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c) {
  double best = 1e300;
  for (int i = 0; i <= 400; ++i) {
    const double u = i / 400.0;
    best = std::min(best, point_edge(p, a + u * (b - a), a + u * (c - a)).squared_distance);
  }
  return std::sqrt(best);
}

/// Random shapes of one kind: 0 ordinary, 1 sliver, 2 zero area, 3 all points one, 4 tiny, 5 far
/// from the origin.
void triangle_of_kind(Random& random, int kind, Vec3& a, Vec3& b, Vec3& c) {
  a = random_point(random);
  b = random_point(random);
  c = random_point(random);
  if (kind == 1)
    c = a + 0.3 * (b - a) + random_point(random, 1e-9);
  if (kind == 2)
    c = a + 0.7 * (b - a);
  if (kind == 3)
    b = c = a;
  if (kind == 4) {
    b = a + 1e-7 * b;
    c = a + 1e-7 * c;
  }
  if (kind == 5) {
    a.x() += 1000;
    b.x() += 1000;
    c.x() += 1000;
  }
}

TEST(Distance, PointToTriangleIsTheLeastOverSamplesForEveryShapeOfTriangle) {
  Random random(1);
  for (int i = 0; i < 3000; ++i) {
    Vec3 a, b, c;
    const int kind = i % 6;
    triangle_of_kind(random, kind, a, b, c);
    const Vec3 p = random_point(random, 1.5) + (kind == 5 ? Vec3(1000, 0, 0) : Vec3(0, 0, 0));
    const PointTriangle r = point_triangle(p, a, b, c);
    const double found = std::sqrt(r.squared_distance),
                 sampled = sampled_point_triangle(p, a, b, c);
    ASSERT_LE(found, sampled + 1e-9) << "case " << i;
    ASSERT_GE(found, sampled - 0.02) << "case " << i;
    ASSERT_NEAR(r.barycentric.sum(), 1, 1e-12);
    ASSERT_GE(r.barycentric.minCoeff(), 0);
    ASSERT_LT(
        (r.point - (r.barycentric[0] * a + r.barycentric[1] * b + r.barycentric[2] * c)).norm(),
        1e-9)
        << "case " << i;
    ASSERT_NEAR((p - r.point).norm(), found, 1e-8) << "case " << i;
  }
}

TEST(Distance, PointToTriangleNamesTheFeatureItIsOn) {
  const Vec3 a(0, 0, 0), b(1, 0, 0), c(0, 1, 0);
  EXPECT_EQ(point_triangle({0.2, 0.2, 1}, a, b, c).feature, FEATURE_FACE);
  EXPECT_EQ(point_triangle({-1, -1, 0}, a, b, c).feature, 0);
  EXPECT_EQ(point_triangle({2, 0, 1}, a, b, c).feature, 1);
  EXPECT_EQ(point_triangle({0, 3, 0}, a, b, c).feature, 2);
  EXPECT_EQ(point_triangle({0.5, -1, 0}, a, b, c).feature, FEATURE_EDGE + 0);
  EXPECT_EQ(point_triangle({1, 1, 0}, a, b, c).feature, FEATURE_EDGE + 1);
  EXPECT_EQ(point_triangle({-1, 0.5, 0}, a, b, c).feature, FEATURE_EDGE + 2);
}

TEST(Distance, GradientOfPointToTriangleIsTheDirectionToIt) {
  Random random(2);
  for (int i = 0; i < 300; ++i) {
    const Vec3 a = random_point(random), b = random_point(random), c = random_point(random),
               p = random_point(random, 2);
    const PointTriangle r = point_triangle(p, a, b, c);
    for (int k = 0; k < 3; ++k) {
      const Vec3 step = 1e-6 * Vec3::Unit(k);
      const double slope = (point_triangle(p + step, a, b, c).squared_distance -
                            point_triangle(p - step, a, b, c).squared_distance) /
                           2e-6;
      ASSERT_NEAR(slope, 2 * (p - r.point)[k], 1e-5);
    }
  }
}

TEST(Distance, EdgeToEdgeIsTheLeastOverSamplesForParallelAndZeroLengthEdgesToo) {
  Random random(3);
  for (int i = 0; i < 4000; ++i) {
    const Vec3 a0 = random_point(random), a1 = random_point(random), b0 = random_point(random);
    Vec3 b1 = random_point(random);
    const double almost[] = {0, 1e-15, 1e-12, 1e-9, 1e-7, 1e-5, 1e-3};
    if (i % 4 == 1)
      b1 = b0 + random.uniform(-1, 1) * (a1 - a0) +
           random_point(random, almost[i % 7]); // near parallel
    if (i % 4 == 2)
      b1 = b0;
    const Vec3 end = i % 8 == 6 ? a0 : a1;
    const EdgeEdge r = edge_edge(a0, end, b0, b1);
    const double found = std::sqrt(r.squared_distance),
                 sampled = sampled_edge_edge(a0, end, b0, b1);
    ASSERT_LE(found, sampled + 1e-9) << "case " << i;
    ASSERT_GE(found, sampled - 0.01) << "case " << i;
    ASSERT_TRUE(r.s >= 0 && r.s <= 1 && r.t >= 0 && r.t <= 1);
    ASSERT_NEAR((a0 + r.s * (end - a0) - b0 - r.t * (b1 - b0)).norm(), found, 1e-8) << "case " << i;
  }
}

TEST(Distance, EdgeToEdgeIsSymmetric) {
  Random random(4);
  for (int i = 0; i < 1000; ++i) {
    const Vec3 a0 = random_point(random), a1 = random_point(random), b0 = random_point(random),
               b1 = random_point(random);
    ASSERT_NEAR(edge_edge(a0, a1, b0, b1).squared_distance,
                edge_edge(b1, b0, a0, a1).squared_distance, 1e-12);
  }
}

TEST(Distance, ZeroLengthEdgeIsItsPoint) {
  const Vec3 a(1, 2, 3);
  EXPECT_DOUBLE_EQ(point_edge({1, 2, 5}, a, a).squared_distance, 4);
  EXPECT_DOUBLE_EQ(edge_edge(a, a, Vec3(1, 2, 4), Vec3(1, 2, 4)).squared_distance, 1);
}

} // namespace
} // namespace sloper::collision
