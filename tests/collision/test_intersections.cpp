#include <sloper/collision/intersections.hpp>
#include <sloper/collision/predicates.hpp>

#include <support/shapes.hpp>

#include <gtest/gtest.h>
#include <sloper/base/parallel.hpp>

namespace sloper::collision {
namespace {

using Corners = std::array<Vec3, 3>;

Corners corners(const TriangleMesh& mesh, int f) {
  const Triangle& t = mesh.triangles[f];
  return {mesh.positions[t[0]], mesh.positions[t[1]], mesh.positions[t[2]]};
}

std::vector<std::array<int, 2>> brute_force(const TriangleMesh& mesh) {
  std::vector<std::array<int, 2>> pairs;
  const auto n = static_cast<int>(mesh.triangles.size());
  for (int a = 0; a < n; ++a)
    for (int b = a + 1; b < n; ++b) {
      bool shared = false;
      for (int u : mesh.triangles[a])
        for (int v : mesh.triangles[b])
          shared |= u == v;
      if (!shared && triangles_intersect(corners(mesh, a), corners(mesh, b)))
        pairs.push_back({a, b});
    }
  return pairs;
}

TEST(Predicates, OrientationIsExactWhereDoublesCannotTell) {
  // points of a plane through the origin, moved by one unit in the last place
  const Vec3 a(1, 0, 0), b(0, 1, 0), c(0, 0, 1);
  const double third = 1.0 / 3;
  const Vec3 on(
      third, third,
      1 - 2 * third); // x + y + z = 1 up to rounding of the sum: exactly 1 for these doubles
  EXPECT_EQ(orientation(a, b, c, Vec3(0.25, 0.25, 0.5)), 0);
  EXPECT_EQ(orientation(a, b, c, Vec3(0.25, 0.25, std::nextafter(0.5, 1))),
            -orientation(a, b, c, Vec3(0.25, 0.25, std::nextafter(0.5, 0))));
  EXPECT_NE(orientation(a, b, c, Vec3(0.25, 0.25, std::nextafter(0.5, 1))), 0);
  EXPECT_EQ(orientation(a, b, c, on), orientation(b, c, a, on));
}

TEST(Predicates, OrientationChangesSignWithEveryExchangeOfPoints) {
  Random random(21);
  for (int i = 0; i < 2000; ++i) {
    Vec3 p[4];
    for (Vec3& v : p)
      v = shapes::grid_point(random, 4) * (i % 2 ? 0.1 : 1.0); // many exact ties
    const int o = orientation(p[0], p[1], p[2], p[3]);
    ASSERT_EQ(orientation(p[1], p[0], p[2], p[3]), -o);
    ASSERT_EQ(orientation(p[1], p[2], p[0], p[3]), o);
    ASSERT_EQ(orientation(p[0], p[1], p[3], p[2]), -o);
    ASSERT_EQ(orientation(p[3], p[1], p[2], p[0]), -o);
  }
}

TEST(Predicates, TouchingTrianglesIntersect) {
  const Corners t = {Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 1, 0)};
  EXPECT_TRUE(triangles_intersect(t, {Vec3(0.25, 0.25, 0), Vec3(0.3, 0.3, 1), Vec3(0.4, 0.3, 1)}))
      << "a corner on the face";
  EXPECT_FALSE(
      triangles_intersect(t, {Vec3(0.25, 0.25, 1e-300), Vec3(0.3, 0.3, 1), Vec3(0.4, 0.3, 1)}))
      << "a corner just off it";
  EXPECT_TRUE(triangles_intersect(t, {Vec3(0, 0, 0), Vec3(-1, 0, 1), Vec3(-1, 0, -1)}))
      << "corner on corner";
  EXPECT_TRUE(triangles_intersect(t, {Vec3(0.5, 0, 0), Vec3(0.5, -1, 1), Vec3(0.5, -1, -1)}))
      << "corner on edge";
  EXPECT_TRUE(triangles_intersect(t, {Vec3(-1, 0, 0), Vec3(2, 0, 0), Vec3(0, -1, 5)}))
      << "edge along edge";
  EXPECT_TRUE(triangles_intersect(t, {Vec3(0.1, 0.1, 0), Vec3(0.2, 0.1, 0), Vec3(0.1, 0.2, 0)}))
      << "inside, coplanar";
  EXPECT_TRUE(triangles_intersect({Vec3(0.1, 0.1, 0), Vec3(0.2, 0.1, 0), Vec3(0.1, 0.2, 0)}, t))
      << "around, coplanar";
  EXPECT_FALSE(triangles_intersect(t, {Vec3(1, 1, 0), Vec3(2, 1, 0), Vec3(1, 2, 0)}))
      << "apart, coplanar";
  EXPECT_TRUE(triangles_intersect(t, t));
}

TEST(Predicates, ZeroAreaTrianglesMeetNothing) {
  const Corners t = {Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 1, 0)};
  EXPECT_FALSE(triangles_intersect(t, {Vec3(0.2, 0.2, -1), Vec3(0.2, 0.2, 0), Vec3(0.2, 0.2, 1)}));
  EXPECT_FALSE(triangles_intersect({Vec3(0.2, 0.2, 0), Vec3(0.2, 0.2, 0), Vec3(0.2, 0.2, 0)}, t));
  EXPECT_FALSE(triangles_intersect({Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0.5, 0, 0)}, t));
}

TEST(SelfIntersections, EqualBruteForceOnASoup) {
  const TriangleMesh mesh = shapes::soup(600, 0.25, 22);
  const auto expected = brute_force(mesh);
  ASSERT_GT(expected.size(), 50u);
  for (int k : {6, 14, 18, 26})
    EXPECT_EQ(self_intersections(mesh.positions, mesh.triangles,
                                 TriangleTree(mesh.positions, mesh.triangles, k)),
              expected);
}

TEST(SelfIntersections, EqualBruteForceOnACrumpledSheet) {
  TriangleMesh mesh = shapes::sheet(20, 20, 1, 1);
  TriangleTree tree(mesh.positions, mesh.triangles);
  EXPECT_TRUE(self_intersections(mesh.positions, mesh.triangles, tree).empty())
      << "a flat sheet touches itself only at shared vertices";
  shapes::jitter(mesh, 0.08, 23);
  tree.refit(mesh.positions);
  const auto expected = brute_force(mesh);
  ASSERT_GT(expected.size(), 50u);
  EXPECT_EQ(self_intersections(mesh.positions, mesh.triangles, tree), expected);
}

TEST(SelfIntersections, GridPointsGiveAllKindsOfTouching) {
  Random random(24);
  TriangleMesh mesh;
  for (int i = 0; i < 200; ++i) {
    for (int k = 0; k < 3; ++k)
      mesh.positions.push_back(shapes::grid_point(random, 5) * 0.1);
    mesh.triangles.push_back({3 * i, 3 * i + 1, 3 * i + 2});
  }
  EXPECT_EQ(self_intersections(mesh.positions, mesh.triangles,
                               TriangleTree(mesh.positions, mesh.triangles)),
            brute_force(mesh));
}

TEST(SelfIntersections, AreTheSameForOneAndTwoThreads) {
  TriangleMesh mesh = shapes::sheet(60, 60, 1, 1);
  shapes::jitter(mesh, 0.03, 25);
  std::vector<std::array<int, 2>> pairs[2];
  std::vector<EdgeFaceIntersection> edges[2];
  for (int threads = 1; threads <= 2; ++threads) {
    set_thread_count(threads);
    const TriangleTree tree(mesh.positions, mesh.triangles);
    pairs[threads - 1] = self_intersections(mesh.positions, mesh.triangles, tree);
    edges[threads - 1] = edge_face_intersections(
        mesh.positions, mesh.triangles, make_topology(mesh.positions.size(), mesh.triangles), tree);
  }
  set_thread_count(1);
  ASSERT_FALSE(pairs[0].empty());
  EXPECT_EQ(pairs[0], pairs[1]);
  ASSERT_EQ(edges[0].size(), edges[1].size());
  for (std::size_t i = 0; i < edges[0].size(); ++i) {
    ASSERT_EQ(edges[0][i].edge, edges[1][i].edge);
    ASSERT_EQ(edges[0][i].triangle, edges[1][i].triangle);
    ASSERT_EQ(edges[0][i].point, edges[1][i].point);
  }
}

TEST(EdgeFaceIntersections, NameThePointOnEdgeAndFace) {
  TriangleMesh mesh = shapes::sheet(1, 1, 1, 1);
  shapes::append(mesh, {{{0.3, 0.3, -1}, {0.3, 0.3, 1}, {5, 5, 1}}, {{0, 1, 2}}});
  const auto found = edge_face_intersections(mesh.positions, mesh.triangles,
                                             make_topology(mesh.positions.size(), mesh.triangles),
                                             TriangleTree(mesh.positions, mesh.triangles));
  bool upright = false;
  for (const auto& hit : found)
    if ((hit.point - Vec3(0.3, 0.3, 0)).norm() < 1e-12) {
      upright = true;
      EXPECT_NEAR(hit.t, 0.5, 1e-12);
      const Corners c = corners(mesh, hit.triangle);
      EXPECT_LT((hit.barycentric[0] * c[0] + hit.barycentric[1] * c[1] + hit.barycentric[2] * c[2] -
                 hit.point)
                    .norm(),
                1e-12);
    }
  EXPECT_TRUE(upright);
}

TEST(EdgeFaceIntersections, AreFoundForEveryIntersectingTrianglePairInGeneralPosition) {
  TriangleMesh mesh = shapes::sheet(20, 20, 1, 1);
  shapes::jitter(mesh, 0.08, 26);
  const TriangleTree tree(mesh.positions, mesh.triangles);
  const Topology topology = make_topology(mesh.positions.size(), mesh.triangles);
  std::vector<std::array<int, 2>> from_edges;
  for (const auto& hit : edge_face_intersections(mesh.positions, mesh.triangles, topology, tree))
    for (int f : topology.triangles_of_edge(hit.edge))
      from_edges.push_back({std::min(f, hit.triangle), std::max(f, hit.triangle)});
  std::sort(from_edges.begin(), from_edges.end());
  for (const auto& pair : self_intersections(mesh.positions, mesh.triangles, tree))
    ASSERT_TRUE(std::binary_search(from_edges.begin(), from_edges.end(), pair));
}

TEST(Topology, EdgesAreThoseOfTheGeometryModule) {
  const TriangleMesh mesh = shapes::soup(100, 0.1, 3), ball = shapes::sphere(2);
  EXPECT_EQ(make_topology(mesh.positions.size(), mesh.triangles).edges, edges_of(mesh.triangles));
  const Topology topology = make_topology(ball.positions.size(), ball.triangles);
  EXPECT_EQ(topology.edges, edges_of(ball.triangles));
  for (std::size_t e = 0; e < topology.edges.size(); ++e)
    ASSERT_EQ(topology.triangles_of_edge(static_cast<int>(e)).size(), 2u);
  for (std::size_t f = 0; f < ball.triangles.size(); ++f)
    for (int k = 0; k < 3; ++k) {
      auto [a, b] = topology.edges[topology.triangle_edges[f][k]];
      const int u = ball.triangles[f][k], v = ball.triangles[f][(k + 1) % 3];
      ASSERT_EQ(a, std::min(u, v));
      ASSERT_EQ(b, std::max(u, v));
    }
}

} // namespace
} // namespace sloper::collision
