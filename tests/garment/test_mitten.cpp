/// Convex shells around hands.
#include <base/random.hpp>
#include <collision/predicates.hpp>
#include <garment/mitten.hpp>
#include <gtest/gtest.h>

#include <map>

using namespace sloper;

namespace {

TEST(Mitten, HullIsClosedOutwardAndHoldsAllPoints) {
  Random random(7);
  std::vector<Vec3> points;
  for (int i = 0; i < 400; ++i) {
    const double x = random.uniform(-1, 1), y = random.uniform(-0.3, 0.3), z = random.uniform(-0.1, 0.1);
    points.emplace_back(x, y, z);
  }
  for (int i = 0; i < 27; ++i) points.emplace_back(i % 3 - 1, (i / 3) % 3 * 0.3 - 0.3, i / 9 * 0.1 - 0.1); // a box with points in its faces
  const auto hull = garment::convex_hull_of(points);
  ASSERT_GE(hull.size(), 12u);
  std::map<std::pair<int, int>, int> edges;
  for (const Triangle& t : hull)
    for (int k = 0; k < 3; ++k) ++edges[{t[k], t[(k + 1) % 3]}];
  for (const auto& [edge, count] : edges) {
    EXPECT_EQ(count, 1);
    EXPECT_TRUE(edges.count({edge.second, edge.first}));
  }
  for (const Triangle& t : hull) {
    for (const Vec3& p : points) ASSERT_GE(collision::orientation(points[t[0]], points[t[1]], points[t[2]], p), 0);
    const Vec3 outward = (points[t[1]] - points[t[0]]).cross(points[t[2]] - points[t[0]]);
    EXPECT_GT(outward.dot(points[t[0]]), 0);
  }
}

TEST(Mitten, PointsInAPlaneHaveNoHull) {
  EXPECT_TRUE(garment::convex_hull_of({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}, {0.3, 0.2, 0}}).empty());
  EXPECT_TRUE(garment::convex_hull_of({{0, 0, 0}, {1, 0, 0}}).empty());
}

TEST(Mitten, BodyWithoutHandsStaysAsItIs) {
  body::Body body;
  body.skin.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  body.skin.triangles = {{0, 1, 2}};
  body.face_part = {body::Part::ARM_L};
  const garment::MittenSkin mitten(body);
  EXPECT_FALSE(mitten.has_shells());
  EXPECT_EQ(mitten.positions(body.skin.positions), body.skin.positions);
  EXPECT_FALSE(mitten.concerns({{0, 0, 0}}));
}

} // namespace
