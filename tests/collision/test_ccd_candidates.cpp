#include <sloper/collision/ccd_candidates.hpp>

#include <support/shapes.hpp>

#include <gtest/gtest.h>
#include <sloper/base/parallel.hpp>
#include <sloper/base/random.hpp>
#include <sloper/collision/self_proximity.hpp>

namespace sloper::collision {
namespace {

/// Two sheets of n by n squares of 1 cm, 12 mm apart, uneven.
struct Sheets {
  std::vector<Vec3> x;
  std::vector<Triangle> triangles;
};

Sheets two_sheets(int n) {
  Sheets s;
  Random random(7);
  for (int layer = 0; layer < 2; ++layer) {
    const auto first = static_cast<int>(s.x.size());
    for (int r = 0; r <= n; ++r)
      for (int c = 0; c <= n; ++c)
        s.x.emplace_back(0.01 * c, 0.012 * layer + 0.003 * random.uniform(-1, 1), 0.01 * r);
    for (int r = 0; r < n; ++r)
      for (int c = 0; c < n; ++c) {
        const int a = first + r * (n + 1) + c, b = a + 1, d = a + n + 1, e = d + 1;
        s.triangles.push_back({a, b, e});
        s.triangles.push_back({a, e, d});
      }
  }
  return s;
}

/// Up to 1 cm along each axis, every particle its own way.
std::vector<Vec3> random_motion(const Sheets& s, std::uint64_t seed) {
  Random random(seed);
  std::vector<Vec3> dx(s.x.size());
  for (Vec3& d : dx)
    d = 0.01 * Vec3{random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)};
  return dx;
}

std::vector<char> all(const Sheets& s) {
  return std::vector<char>(s.x.size(), 1);
}

/// The least distance of the pair on the way, by trying.
template<class Distance>
double least_on_the_way(const Sheets& s, const std::vector<Vec3>& dx, const Distance& distance) {
  double least = 1e300;
  for (int k = 0; k <= 20; ++k) {
    std::vector<Vec3> x(s.x.size());
    for (std::size_t i = 0; i < x.size(); ++i)
      x[i] = s.x[i] + k / 20.0 * dx[i];
    least = std::min(least, distance(x));
  }
  return least;
}

TEST(CcdCandidates, WhatIsNotFoundStaysApart) {
  const Sheets s = two_sheets(5);
  const Topology topology = make_topology(s.x.size(), s.triangles);
  Random random(8);
  std::vector<Vec3> dx(s.x.size());
  for (std::size_t i = 0; i < dx.size();
       ++i) // the upper sheet falls through the lower, and both drift
    dx[i] = Vec3(0.05, i < dx.size() / 2 ? 0 : -0.03, 0) +
            0.002 * Vec3{random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)};
  CcdCandidates closing(s.triangles, topology);
  closing.find(s.x, dx, all(s), false);
  EXPECT_FALSE(closing.vertex_face().empty());
  EXPECT_FALSE(closing.edge_edge().empty());
  const auto listed = [](const auto& pairs, int a, int b) {
    return std::binary_search(pairs.begin(), pairs.end(), std::array<int, 2>{a, b});
  };
  const auto enough = [](double before) {
    return 0.99 * std::min((1 - CcdCandidates::SHARE) * before, 1e-4);
  };
  for (int v = 0; v < std::ssize(s.x); ++v)
    for (int f = 0; f < std::ssize(s.triangles); ++f) {
      const Triangle& t = s.triangles[f];
      if (v == t[0] || v == t[1] || v == t[2] || listed(closing.vertex_face(), v, f))
        continue;
      const auto distance = [&](const std::vector<Vec3>& x) {
        return std::sqrt(point_triangle(x[v], x[t[0]], x[t[1]], x[t[2]]).squared_distance);
      };
      ASSERT_GE(least_on_the_way(s, dx, distance), enough(distance(s.x))) << v << " " << f;
    }
  for (int e = 0; e < std::ssize(topology.edges); ++e)
    for (int f = e + 1; f < std::ssize(topology.edges); ++f) {
      const auto &a = topology.edges[e], &b = topology.edges[f];
      if (a[0] == b[0] || a[0] == b[1] || a[1] == b[0] || a[1] == b[1] ||
          listed(closing.edge_edge(), e, f))
        continue;
      const auto distance = [&](const std::vector<Vec3>& x) {
        return std::sqrt(edge_edge(x[a[0]], x[a[1]], x[b[0]], x[b[1]]).squared_distance);
      };
      ASSERT_GE(least_on_the_way(s, dx, distance), enough(distance(s.x))) << e << " " << f;
    }
}

TEST(CcdCandidates, WhatMovesTogetherIsNotFound) {
  const Sheets s = two_sheets(6);
  const Topology topology = make_topology(s.x.size(), s.triangles);
  CcdCandidates closing(s.triangles, topology);
  closing.find(s.x, std::vector<Vec3>(s.x.size(), Vec3(0.3, -1, 0.2)), all(s), false);
  EXPECT_TRUE(closing.vertex_face().empty());
  EXPECT_TRUE(closing.edge_edge().empty());
}

/// Of the pairs of `every` `some` has those with a marked particle.
void expect_those_of_marked(const CcdCandidates& some, const CcdCandidates& every, const Sheets& s,
                            const Topology& topology, const std::vector<char>& marked) {
  std::vector<std::array<int, 2>> vertex_face, edge_edge;
  for (const auto& [v, f] : every.vertex_face()) {
    const Triangle& t = s.triangles[f];
    if (marked[v] || marked[t[0]] || marked[t[1]] || marked[t[2]])
      vertex_face.push_back({v, f});
  }
  for (const auto& [e, f] : every.edge_edge()) {
    const auto &a = topology.edges[e], &b = topology.edges[f];
    if (marked[a[0]] || marked[a[1]] || marked[b[0]] || marked[b[1]])
      edge_edge.push_back({e, f});
  }
  EXPECT_FALSE(vertex_face.empty());
  EXPECT_LT(edge_edge.size(), every.edge_edge().size());
  EXPECT_EQ(some.vertex_face(), vertex_face);
  EXPECT_EQ(some.edge_edge(), edge_edge);
}

TEST(CcdCandidates, AgainLooksForPairsOfWhatMovesOtherwise) {
  const Sheets s = two_sheets(12);
  const Topology topology = make_topology(s.x.size(), s.triangles);
  std::vector<Vec3> dx = random_motion(s, 10);
  CcdCandidates closing(s.triangles, topology), fresh(s.triangles, topology);
  closing.find(s.x, dx, all(s), false);
  closing.find(s.x, dx, all(s), true);
  EXPECT_TRUE(closing.vertex_face().empty());
  EXPECT_TRUE(closing.edge_edge().empty());
  std::vector<char> other(dx.size(), 0);
  for (std::size_t i = 0; i < dx.size(); i += 17) {
    dx[i] *= -1.5;
    other[i] = 1;
  }
  closing.find(s.x, dx, all(s), true);
  fresh.find(s.x, dx, all(s), false);
  expect_those_of_marked(closing, fresh, s, topology, other);
}

TEST(CcdCandidates, FindsThePairsOfWhatIsMarked) {
  const Sheets s = two_sheets(12);
  const Topology topology = make_topology(s.x.size(), s.triangles);
  const std::vector<Vec3> dx = random_motion(s, 12);
  std::vector<char> marked(dx.size(), 0);
  for (std::size_t i = 0; i < dx.size(); i += 23)
    marked[i] = 1;
  CcdCandidates some(s.triangles, topology), every(s.triangles, topology);
  some.find(s.x, dx, marked, false);
  every.find(s.x, dx, all(s), false);
  expect_those_of_marked(some, every, s, topology, marked);
}

TEST(CcdCandidates, FindsThePairsThatAreFartherApartThanThoseKnown) {
  const Sheets s = two_sheets(12);
  const Topology topology = make_topology(s.x.size(), s.triangles);
  const std::vector<Vec3> dx = random_motion(s, 13);
  constexpr double KNOWN = 0.011; // m
  CcdCandidates some(s.triangles, topology), every(s.triangles, topology);
  some.find(s.x, dx, all(s), false, KNOWN);
  every.find(s.x, dx, all(s), false);
  const auto has = [](const auto& pairs, const std::array<int, 2>& pair) {
    return std::binary_search(pairs.begin(), pairs.end(), pair);
  };
  std::size_t farther = 0;
  for (const auto& [v, f] : every.vertex_face()) {
    const Triangle& t = s.triangles[f];
    if (point_triangle(s.x[v], s.x[t[0]], s.x[t[1]], s.x[t[2]]).squared_distance < KNOWN * KNOWN)
      continue;
    ++farther;
    EXPECT_TRUE(has(some.vertex_face(), {v, f})) << v << " " << f;
  }
  EXPECT_GT(farther, 0U);
  for (const auto& [e, f] : every.edge_edge()) {
    const auto &a = topology.edges[e], &b = topology.edges[f];
    const double squared = edge_edge(s.x[a[0]], s.x[a[1]], s.x[b[0]], s.x[b[1]]).squared_distance;
    if (squared >= KNOWN * KNOWN) {
      EXPECT_TRUE(has(some.edge_edge(), {e, f})) << e << " " << f;
    }
  }
  EXPECT_LT(some.edge_edge().size(), every.edge_edge().size());
  for (const std::array<int, 2>& pair : some.edge_edge())
    EXPECT_TRUE(has(every.edge_edge(), pair)) << pair[0] << " " << pair[1];
}

TEST(CcdCandidates, TheSameForAnyNumberOfThreads) {
  const Sheets s = two_sheets(30);
  const Topology topology = make_topology(s.x.size(), s.triangles);
  const std::vector<Vec3> dx = random_motion(s, 9);
  CcdCandidates one(s.triangles, topology), many(s.triangles, topology);
  set_thread_count(1);
  one.find(s.x, dx, all(s), false);
  set_thread_count(4);
  many.find(s.x, dx, all(s), false);
  set_thread_count(1);
  EXPECT_EQ(one.vertex_face(), many.vertex_face());
  EXPECT_EQ(one.edge_edge(), many.edge_edge());
}

} // namespace
} // namespace sloper::collision
