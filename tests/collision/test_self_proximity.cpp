#include <sloper/collision/self_proximity.hpp>

#include <support/shapes.hpp>

#include <gtest/gtest.h>
#include <set>
#include <sloper/base/parallel.hpp>
#include <sloper/collision/intersections.hpp>

namespace sloper::collision {
namespace {

struct Pairs {
  std::set<std::array<int, 2>> vertex_face, edge_edge;
};

Pairs brute_force(const std::vector<Vec3>& x, const std::vector<Triangle>& triangles, double radius,
                  const std::vector<std::vector<int>>& never = {}) {
  const auto apart = [&](int a, int b) {
    if (never.empty())
      return false;
    return std::count(never[a].begin(), never[a].end(), b) > 0 ||
           std::count(never[b].begin(), never[b].end(), a) > 0;
  };
  Pairs pairs;
  std::set<int> used;
  for (const Triangle& t : triangles)
    used.insert(t.begin(), t.end());
  for (int v : used)
    for (int f = 0; f < std::ssize(triangles); ++f) {
      const Triangle& t = triangles[f];
      if (t[0] == v || t[1] == v || t[2] == v || apart(v, t[0]) || apart(v, t[1]) || apart(v, t[2]))
        continue;
      if (std::sqrt(point_triangle(x[v], x[t[0]], x[t[1]], x[t[2]]).squared_distance) <= radius)
        pairs.vertex_face.insert({v, f});
    }
  const auto edges = edges_of(triangles);
  for (int a = 0; a < std::ssize(edges); ++a)
    for (int b = a + 1; b < std::ssize(edges); ++b) {
      const auto [a0, a1] = edges[a];
      const auto [b0, b1] = edges[b];
      if (a0 == b0 || a0 == b1 || a1 == b0 || a1 == b1 || apart(a0, b0) || apart(a0, b1) ||
          apart(a1, b0) || apart(a1, b1))
        continue;
      if (std::sqrt(edge_edge(x[a0], x[a1], x[b0], x[b1]).squared_distance) <= radius)
        pairs.edge_edge.insert({a, b});
    }
  return pairs;
}

Pairs found(const SelfProximity& proximity) {
  Pairs pairs;
  for (const auto& p : proximity.vertex_face())
    EXPECT_TRUE(pairs.vertex_face.insert({p.vertex, p.triangle}).second) << "twice";
  for (const auto& p : proximity.edge_edge())
    EXPECT_TRUE(pairs.edge_edge.insert({p.edge_a, p.edge_b}).second) << "twice";
  EXPECT_TRUE(std::is_sorted(proximity.vertex_face().begin(), proximity.vertex_face().end(),
                             [](const auto& a, const auto& b) {
                               return std::tie(a.vertex, a.triangle) <
                                      std::tie(b.vertex, b.triangle);
                             }));
  EXPECT_TRUE(std::is_sorted(proximity.edge_edge().begin(), proximity.edge_edge().end(),
                             [](const auto& a, const auto& b) {
                               return std::tie(a.edge_a, a.edge_b) < std::tie(b.edge_a, b.edge_b);
                             }));
  return pairs;
}

void expect_like_brute_force(SelfProximity& proximity, const std::vector<Vec3>& x, double radius,
                             const std::vector<std::vector<int>>& never = {}) {
  proximity.update(x, radius);
  const Pairs expected = brute_force(x, proximity.triangles(), radius, never),
              got = found(proximity);
  ASSERT_EQ(got.vertex_face, expected.vertex_face);
  ASSERT_EQ(got.edge_edge, expected.edge_edge);
  for (const auto& p : proximity.edge_edge()) {
    const auto [a0, a1] = proximity.topology().edges[p.edge_a];
    const auto [b0, b1] = proximity.topology().edges[p.edge_b];
    ASSERT_NEAR((x[a0] + p.s * (x[a1] - x[a0]) - x[b0] - p.t * (x[b1] - x[b0])).norm(), p.distance,
                1e-9);
  }
}

TEST(SelfProximity, FindsThePairsOfBruteForceOnAMovingCrumpledSheet) {
  TriangleMesh mesh = shapes::sheet(14, 14, 1, 1);
  SelfProximity proximity(mesh.positions.size(), mesh.triangles);
  const double edge = 1.0 / 14;
  for (int step = 0; step < 12; ++step) {
    const double small = step % 2 ? 0.0008 : 0.002; // is answered from remembered pairs
    const double large = 0.1;                       // is not
    shapes::jitter(mesh, step == 6 ? large : small, 60 + step);
    expect_like_brute_force(proximity, mesh.positions, (step % 3 == 2 ? 0.45 : 0.6) * edge);
  }
  EXPECT_LT(proximity.n_rebuilds(), 12);
  EXPECT_GE(proximity.n_rebuilds(), 2);
}

TEST(SelfProximity, FindsThePairsOfBruteForceOnASoup) {
  const TriangleMesh mesh = shapes::soup(250, 0.15, 61);
  SelfProximity proximity(mesh.positions.size(), mesh.triangles);
  expect_like_brute_force(proximity, mesh.positions, 0.05);
}

TEST(SelfProximity, FindsThePairsOfBruteForceForEveryK) {
  TriangleMesh mesh = shapes::sheet(12, 12, 1, 1);
  shapes::jitter(mesh, 0.05, 62);
  for (int k : {6, 14, 18, 26}) {
    SelfProximity proximity(mesh.positions.size(), mesh.triangles, {}, k);
    expect_like_brute_force(proximity, mesh.positions, 0.04);
  }
}

TEST(SelfProximity, HandlesRepeatedIndicesCoincidentPointsAndNaN) {
  TriangleMesh mesh = shapes::sheet(8, 8, 1, 1);
  mesh.triangles.push_back({3, 3, 20});
  mesh.triangles.push_back({7, 7, 7});
  mesh.triangles.push_back(mesh.triangles[5]);
  mesh.positions[40] = mesh.positions[12];
  SelfProximity proximity(mesh.positions.size(), mesh.triangles);
  expect_like_brute_force(proximity, mesh.positions, 0.07);
  mesh.positions[30] = Vec3::Constant(std::nan(""));
  proximity.update(mesh.positions, 0.07);
  for (const auto& p : proximity.vertex_face())
    ASSERT_TRUE(std::isfinite(p.distance));
  for (const auto& p : proximity.edge_edge())
    ASSERT_TRUE(std::isfinite(p.distance));
}

TEST(SelfProximity, LeavesOutListedNeighbours) {
  TriangleMesh mesh = shapes::sheet(8, 8, 1, 1);
  const auto n = static_cast<int>(mesh.positions.size());
  shapes::append(mesh, shapes::sheet(8, 8, 1, 1, 0.02));
  std::vector<std::vector<int>> never(mesh.positions.size());
  for (int v = 0; v < n; v += 2)
    never[v].push_back(v + n); // one way only: it counts both ways
  SelfProximity all(mesh.positions.size(), mesh.triangles),
      some(mesh.positions.size(), mesh.triangles, never);
  expect_like_brute_force(all, mesh.positions, 0.05);
  expect_like_brute_force(some, mesh.positions, 0.05, never);
  EXPECT_LT(some.vertex_face().size(), all.vertex_face().size());
}

TEST(SelfProximity, IsTheSameForOneAndTwoThreadsAndWhateverCameBefore) {
  TriangleMesh mesh = shapes::sheet(40, 40, 1, 1);
  shapes::jitter(mesh, 0.02, 63);
  SelfProximity one(mesh.positions.size(), mesh.triangles),
      two(mesh.positions.size(), mesh.triangles);
  one.update(mesh.positions, 0.01);
  for (int step = 0; step < 3; ++step) {
    shapes::jitter(mesh, 0.001, 64 + step);
    set_thread_count(1);
    one.update(mesh.positions, 0.015);
    set_thread_count(2);
    two.update(mesh.positions, 0.015);
    set_thread_count(1);
    ASSERT_EQ(one.vertex_face().size(), two.vertex_face().size());
    ASSERT_EQ(one.edge_edge().size(), two.edge_edge().size());
    for (std::size_t i = 0; i < one.vertex_face().size(); ++i) {
      ASSERT_EQ(one.vertex_face()[i].vertex, two.vertex_face()[i].vertex);
      ASSERT_EQ(one.vertex_face()[i].triangle, two.vertex_face()[i].triangle);
      ASSERT_EQ(one.vertex_face()[i].distance, two.vertex_face()[i].distance);
    }
    for (std::size_t i = 0; i < one.edge_edge().size(); ++i)
      ASSERT_EQ(one.edge_edge()[i].distance, two.edge_edge()[i].distance);
  }
}

/// A part of each particle's least distance over the pairs it takes part in, at most of the radius:
/// below a half of it, no pair can cross.
std::vector<double> safe_moves(const SelfProximity& proximity, std::size_t n_particles,
                               double radius, double part) {
  std::vector<double> bound(n_particles, radius);
  for (const VertexFacePair& pair : proximity.vertex_face()) {
    bound[pair.vertex] = std::min(bound[pair.vertex], pair.distance);
    for (int v : proximity.triangles()[pair.triangle])
      bound[v] = std::min(bound[v], pair.distance);
  }
  for (const EdgeEdgePair& pair : proximity.edge_edge())
    for (int e : {pair.edge_a, pair.edge_b})
      for (int v : proximity.topology().edges[e])
        bound[v] = std::min(bound[v], pair.distance);
  for (double& b : bound)
    b *= part;
  return bound;
}

TEST(SelfProximity, NothingCrossesWhileEveryParticleStaysWithinHalfItsLeastDistance) {
  TriangleMesh mesh = shapes::sheet(12, 12, 1, 1);
  shapes::append(mesh, shapes::sheet(11, 11, 1, 1, 0.01));
  SelfProximity proximity(mesh.positions.size(), mesh.triangles);
  Random random(65);
  for (int step = 0; step < 60; ++step) {
    proximity.update(mesh.positions, 0.05);
    const auto bound = safe_moves(proximity, mesh.positions.size(), 0.05, 0.45);
    for (std::size_t v = 0; v < bound.size(); ++v) {
      ASSERT_LE(bound[v], 0.45 * 0.05 + 1e-15);
      mesh.positions[v] +=
          shapes::random_point(random).normalized() * bound[v] * random.uniform(0.5, 0.999);
    }
    const TriangleTree tree(mesh.positions, mesh.triangles);
    ASSERT_TRUE(self_intersections(mesh.positions, mesh.triangles, tree).empty())
        << "step " << step;
    ASSERT_TRUE(
        edge_face_intersections(mesh.positions, mesh.triangles, proximity.topology(), tree).empty())
        << "step " << step;
  }
}

TEST(SelfProximity, PairsOfIntersectingTrianglesAreExempt) {
  TriangleMesh mesh;
  mesh.positions = {{0, 0, 0},         {1, 0, 0},     {0, 1, 0},
                    {0.3, 0.3, -0.01}, {0.3, 0.3, 1}, {0.4, 0.3, 1}};
  mesh.triangles = {{0, 1, 2}, {3, 4, 5}};
  SelfProximity proximity(6, mesh.triangles);
  proximity.update(mesh.positions, 0.1);
  ASSERT_EQ(proximity.vertex_face().size(), 1u);
  EXPECT_FALSE(proximity.vertex_face()[0].exempt);
  EXPECT_NEAR(proximity.vertex_face()[0].distance, 0.01, 1e-12);
  const auto crossing = self_intersections(mesh.positions, mesh.triangles, proximity.tree());
  ASSERT_EQ(crossing.size(), 1u);
  proximity.update(mesh.positions, 0.1, crossing);
  EXPECT_TRUE(proximity.vertex_face()[0].exempt);
}

TEST(SelfProximity, EmptyAndOneTriangleClothHaveNoPairs) {
  SelfProximity none(0, {});
  none.update({}, 0.1);
  EXPECT_TRUE(none.vertex_face().empty());
  SelfProximity one(3, {{0, 1, 2}});
  one.update({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, 10);
  EXPECT_TRUE(one.vertex_face().empty() && one.edge_edge().empty());
}

} // namespace
} // namespace sloper::collision
