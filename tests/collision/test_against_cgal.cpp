/// Our exact triangle tests against CGAL's, on the same inputs.
#include <sloper/collision/body_collider.hpp>
#include <sloper/collision/intersections.hpp>
#include <sloper/collision/predicates.hpp>

#include <support/shapes.hpp>

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <gtest/gtest.h>

namespace sloper::collision {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Corners = std::array<Vec3, 3>;

Kernel::Triangle_3 cgal(const Corners& c) {
  const auto point = [](const Vec3& p) { return Kernel::Point_3(p.x(), p.y(), p.z()); };
  return {point(c[0]), point(c[1]), point(c[2])};
}

bool cgal_intersect(const Corners& a, const Corners& b) {
  const auto s = cgal(a), t = cgal(b);
  return !s.is_degenerate() && !t.is_degenerate() && CGAL::do_intersect(s, t);
}

TEST(AgainstCgal, OrientationHasOneConventionAndTheSameSigns) {
  Random random(31);
  for (int i = 0; i < 20000; ++i) {
    Vec3 p[4];
    for (Vec3& v : p)
      v = i % 3 ? Vec3(shapes::grid_point(random, 5) * 0.1) : shapes::random_point(random);
    if (i % 3 == 0 && i % 2)
      p[3] = p[0] + 0.3 * (p[1] - p[0]) + 0.4 * (p[2] - p[0]);
    const auto q = [&](int k) { return Kernel::Point_3(p[k].x(), p[k].y(), p[k].z()); };
    ASSERT_EQ(orientation(p[0], p[1], p[2], p[3]),
              -static_cast<int>(CGAL::orientation(q(0), q(1), q(2), q(3))))
        << i;
  }
}

TEST(AgainstCgal, TrianglesOnAGridOfPointsAgree) {
  Random random(32);
  int meeting = 0;
  for (int i = 0; i < 200000; ++i) {
    Corners t[2];
    const double scale = i % 2 ? 0.1 : 1;
    const unsigned range = 2 + i % 4;
    for (Corners& c : t)
      for (Vec3& v : c)
        v = shapes::grid_point(random, range) * scale;
    if (i % 5 == 0)
      for (Corners& c : t)
        for (Vec3& v : c)
          v.z() = 0; // coplanar
    const bool expected = cgal_intersect(t[0], t[1]);
    meeting += expected;
    ASSERT_EQ(triangles_intersect(t[0], t[1]), expected) << i;
    ASSERT_EQ(triangles_intersect(t[1], t[0]), expected) << i;
  }
  EXPECT_GT(meeting, 10000);
}

TEST(AgainstCgal, RandomAndNearlyTouchingTrianglesAgree) {
  Random random(33);
  int meeting = 0;
  for (int i = 0; i < 100000; ++i) {
    Corners t[2];
    for (Corners& c : t)
      for (Vec3& v : c)
        v = shapes::random_point(random);
    if (i % 4 == 1)
      t[1][0] = 0.2 * t[0][0] + 0.3 * t[0][1] + 0.5 * t[0][2]; // corner on the face, up to rounding
    if (i % 4 == 2)
      t[1][0] = t[0][0] + random.uniform() * (t[0][1] - t[0][0]); // corner on an edge
    if (i % 4 == 3) {
      t[1][0] = t[0][0] + random.uniform() * (t[0][1] - t[0][0]);
      t[1][1] = t[0][2]; // and on a corner
    }
    if (i % 8 >= 4)
      for (int k = 1; k < 3; ++k)
        t[1][k] = t[0][0] + random.uniform(-1, 1) * (t[0][1] - t[0][0]) +
                  random.uniform(-1, 1) * (t[0][2] - t[0][0]);
    const bool expected = cgal_intersect(t[0], t[1]);
    meeting += expected;
    ASSERT_EQ(triangles_intersect(t[0], t[1]), expected) << i;
  }
  EXPECT_GT(meeting, 10000);
}

TEST(AgainstCgal, SelfIntersectionsOfACrumpledSheetAgree) {
  TriangleMesh mesh = shapes::sheet(25, 25, 1, 1);
  shapes::jitter(mesh, 0.05, 34);
  const auto pairs = self_intersections(mesh.positions, mesh.triangles,
                                        TriangleTree(mesh.positions, mesh.triangles));
  std::vector<std::array<int, 2>> expected;
  const auto n = static_cast<int>(mesh.triangles.size());
  const auto corners = [&](int f) -> Corners {
    const Triangle& t = mesh.triangles[f];
    return {mesh.positions[t[0]], mesh.positions[t[1]], mesh.positions[t[2]]};
  };
  for (int a = 0; a < n; ++a)
    for (int b = a + 1; b < n; ++b) {
      bool shared = false;
      for (int u : mesh.triangles[a])
        for (int v : mesh.triangles[b])
          shared |= u == v;
      if (!shared && cgal_intersect(corners(a), corners(b)))
        expected.push_back({a, b});
    }
  EXPECT_EQ(pairs, expected);
}

TEST(AgainstCgal, FacesThroughABodyAgree) {
  const TriangleMesh body = shapes::sphere(3);
  TriangleMesh cloth = shapes::sphere(3, 1.0);
  shapes::jitter(cloth, 0.02, 35);
  cloth.positions[7] = body.positions[7]; // touches
  std::vector<int> expected;
  for (std::size_t f = 0; f < cloth.triangles.size(); ++f) {
    bool hit = false;
    for (const Triangle& t : body.triangles) {
      const Triangle& c = cloth.triangles[f];
      hit = hit ||
            cgal_intersect({cloth.positions[c[0]], cloth.positions[c[1]], cloth.positions[c[2]]},
                           {body.positions[t[0]], body.positions[t[1]], body.positions[t[2]]});
    }
    if (hit)
      expected.push_back(static_cast<int>(f));
  }
  ASSERT_GT(expected.size(), 100u);
  EXPECT_EQ(BodyCollider(body).faces_through(cloth.positions, cloth.triangles), expected);
}

} // namespace
} // namespace sloper::collision
