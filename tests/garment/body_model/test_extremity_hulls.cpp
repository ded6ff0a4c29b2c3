/// Convex shells around hands.
#include <gtest/gtest.h>
#include <sloper/base/random.hpp>
#include <sloper/collision/predicates.hpp>
#include <sloper/garment/body_model/extremity_hulls.hpp>

#include <map>

using namespace sloper;

namespace {

TEST(ExtremityHulls, HullIsClosedOutwardAndHoldsAllPoints) {
  Random random(7);
  std::vector<Vec3> points;
  for (int i = 0; i < 400; ++i) {
    const double x = random.uniform(-1, 1), y = random.uniform(-0.3, 0.3),
                 z = random.uniform(-0.1, 0.1);
    points.emplace_back(x, y, z);
  }
  for (int i = 0; i < 27; ++i)
    points.emplace_back(i % 3 - 1, (i / 3) % 3 * 0.3 - 0.3,
                        i / 9 * 0.1 - 0.1); // a box with points in its faces
  const auto hull = garment::convex_hull_of(points);
  ASSERT_GE(hull.size(), 12u);
  std::map<std::pair<int, int>, int> edges;
  for (const Triangle& t : hull)
    for (int k = 0; k < 3; ++k)
      ++edges[{t[k], t[(k + 1) % 3]}];
  for (const auto& [edge, count] : edges) {
    EXPECT_EQ(count, 1);
    EXPECT_TRUE(edges.count({edge.second, edge.first}));
  }
  for (const Triangle& t : hull) {
    for (const Vec3& p : points)
      ASSERT_GE(collision::orientation(points[t[0]], points[t[1]], points[t[2]], p), 0);
    const Vec3 outward = (points[t[1]] - points[t[0]]).cross(points[t[2]] - points[t[0]]);
    EXPECT_GT(outward.dot(points[t[0]]), 0);
  }
}

TEST(ExtremityHulls, PointsInAPlaneHaveNoHull) {
  EXPECT_TRUE(
      garment::convex_hull_of({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}, {0.3, 0.2, 0}}).empty());
  EXPECT_TRUE(garment::convex_hull_of({{0, 0, 0}, {1, 0, 0}}).empty());
}

TEST(ExtremityHulls, BodyWithoutHandsStaysAsItIs) {
  body::Body body;
  body.skin.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  body.skin.triangles = {{0, 1, 2}};
  body.face_part = {body::Part::ARM_L};
  const garment::ExtremityHulls covered(body, garment::ExtremityHulls::HANDS |
                                                  garment::ExtremityHulls::FEET);
  EXPECT_FALSE(covered.has_shells());
  EXPECT_EQ(covered.positions(body.skin.positions), body.skin.positions);
  EXPECT_EQ(covered.concerned({{0, 0, 0}}), 0u);
}

/// Two boxes along z, 1 cm apart, on one that ends at 0.12 m: a foot with two toes. And far above a
/// knee, of the same part.
body::Body foot() {
  body::Body body;
  const auto box = [&](const Vec3& low, const Vec3& high) {
    const int first = std::ssize(body.skin.positions);
    for (int k = 0; k < 8; ++k)
      body.skin.positions.emplace_back((k & 1 ? high : low).x(), (k & 2 ? high : low).y(),
                                       (k & 4 ? high : low).z());
    for (const Triangle& t : {Triangle{0, 2, 3},
                              {0, 3, 1},
                              {4, 5, 7},
                              {4, 7, 6},
                              {0, 1, 5},
                              {0, 5, 4},
                              {2, 6, 7},
                              {2, 7, 3},
                              {0, 4, 6},
                              {0, 6, 2},
                              {1, 3, 7},
                              {1, 7, 5}})
      body.skin.triangles.push_back({first + t[0], first + t[1], first + t[2]});
  };
  box({-0.04, 0, 0}, {0.04, 0.06, 0.155});
  box({-0.04, 0, 0.15}, {-0.005, 0.02, 0.2});
  box({0.005, 0, 0.15}, {0.04, 0.02, 0.2});
  box({-0.05, 0.4, 0}, {0.05, 0.5, 0.19});
  body.face_part.assign(body.skin.triangles.size(), body::Part::LEG_R);
  body.landmarks["heel_r"].p = Vec3(0, 0.02, 0);
  body.landmarks["foot_tip_r"].p = Vec3(0, 0.02, 0.2);
  return body;
}

TEST(ExtremityHulls, ToesAreInAShellThatTheKneeIsNotIn) {
  using garment::ExtremityHulls;
  const body::Body body = foot();
  const ExtremityHulls covered(body, ExtremityHulls::HANDS | ExtremityHulls::FEET);
  ASSERT_TRUE(covered.has_shells());
  EXPECT_EQ(covered.positions(body.skin.positions), covered.mesh().positions);
  const auto& p = covered.mesh().positions;
  for (std::size_t f = body.skin.triangles.size(); f < covered.mesh().triangles.size(); ++f) {
    const Triangle& t = covered.mesh().triangles[f];
    EXPECT_GT(collision::orientation(p[t[0]], p[t[1]], p[t[2]], Vec3(0, 0.01, 0.19)), 0)
        << "what is between the toes is in it";
    for (int v : t)
      EXPECT_LT(p[v].y(), 0.1) << "the knee is not";
  }
  EXPECT_FALSE(ExtremityHulls(body, ExtremityHulls::HANDS).has_shells());
  EXPECT_EQ(covered.concerned({{0, 0.01, 0.19}}), unsigned{ExtremityHulls::FEET});
  EXPECT_EQ(covered.concerned({{0, 0.3, 0.19}, {0, 0.05, 0.01}}), 0u)
      << "over the knee and behind the ball";
}

} // namespace
