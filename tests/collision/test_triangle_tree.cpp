#include <sloper/collision/triangle_tree.hpp>

#include <support/shapes.hpp>

#include <algorithm>
#include <gtest/gtest.h>
#include <sloper/base/error.hpp>

namespace sloper::collision {
namespace {

using shapes::random_point;

ClosestPoint brute_closest(const TriangleMesh& mesh, const Vec3& p, double max_distance) {
  ClosestPoint best;
  for (int f = 0; f < std::ssize(mesh.triangles); ++f) {
    const Triangle& t = mesh.triangles[f];
    const PointTriangle d =
        point_triangle(p, mesh.positions[t[0]], mesh.positions[t[1]], mesh.positions[t[2]]);
    if (d.squared_distance <= max_distance * max_distance &&
        d.squared_distance < best.squared_distance)
      best = {f, d.point, d.barycentric, d.squared_distance, d.feature};
  }
  return best;
}

void expect_like_brute_force(const TriangleTree& tree, const TriangleMesh& mesh, std::uint64_t seed,
                             int n_points) {
  Random random(seed);
  int hint = -1;
  for (int i = 0; i < n_points; ++i) {
    const Vec3 p = i % 5 == 0 ? mesh.positions[random.next() % mesh.positions.size()]
                              : random_point(random, 1.5);
    const double radii[] = {0.2, 1e300, std::numeric_limits<double>::infinity()};
    const double radius = radii[i % 3];
    const ClosestPoint found = tree.closest_point(p, radius, hint),
                       expected = brute_closest(mesh, p, radius);
    ASSERT_EQ(found.triangle, expected.triangle) << "point " << i;
    if (found.triangle >= 0) {
      ASSERT_EQ(found.squared_distance, expected.squared_distance);
    }
    hint = static_cast<int>(random.next() % mesh.triangles.size());
  }
}

class TreeOfEachK : public testing::TestWithParam<int> {};
INSTANTIATE_TEST_SUITE_P(Dop, TreeOfEachK, testing::Values(6, 14, 18, 26));

TEST_P(TreeOfEachK, ClosestPointEqualsBruteForceOnASphereWhateverTheHint) {
  const TriangleMesh mesh = shapes::sphere(3);
  expect_like_brute_force(TriangleTree(mesh.positions, mesh.triangles, GetParam()), mesh, 11, 300);
}

TEST_P(TreeOfEachK, ClosestPointEqualsBruteForceAfterARefitThatWasNotForPoints) {
  TriangleMesh mesh = shapes::sphere(3);
  TriangleTree tree(mesh.positions, mesh.triangles, GetParam());
  for (Vec3& p : mesh.positions)
    p.y() *= 0.5;
  tree.refit(mesh.positions, false);
  expect_like_brute_force(tree, mesh, 13, 100);
}

TEST_P(TreeOfEachK, ClosestPointEqualsBruteForceOnASoupWithSliversAndZeroAreas) {
  const TriangleMesh mesh = shapes::soup(500, 0.2, 5);
  expect_like_brute_force(TriangleTree(mesh.positions, mesh.triangles, GetParam()), mesh, 12, 300);
}

TEST_P(TreeOfEachK, StaysTrueAfterRefit) {
  TriangleMesh mesh = shapes::sphere(3);
  TriangleTree tree(mesh.positions, mesh.triangles, GetParam());
  shapes::jitter(mesh, 0.5, 13);
  tree.refit(mesh.positions);
  expect_like_brute_force(tree, mesh, 14, 300);
}

TEST_P(TreeOfEachK, OverlapQueryMissesNoTriangleThatMeetsTheBox) {
  const TriangleMesh mesh = shapes::soup(400, 0.3, 6);
  const TriangleTree tree(mesh.positions, mesh.triangles, GetParam());
  Random random(15);
  for (int i = 0; i < 100; ++i) {
    Box3 box;
    const Vec3 p = random_point(random);
    box.add(p);
    box.add(p + random_point(random, 0.2));
    std::vector<char> seen(mesh.triangles.size(), 0);
    tree.visit_overlaps(box, [&](int f) {
      ASSERT_FALSE(seen[f]) << "visited twice";
      seen[f] = 1;
    });
    for (std::size_t f = 0; f < mesh.triangles.size(); ++f) {
      // points of the triangle inside the box: certainly a meeting
      for (int s = 0; s < 20; ++s) {
        const double u = random.uniform(), v = random.uniform() * (1 - u);
        const Triangle& t = mesh.triangles[f];
        const Vec3 q = (1 - u - v) * mesh.positions[t[0]] + u * mesh.positions[t[1]] +
                       v * mesh.positions[t[2]];
        if ((q.array() >= box.low.array()).all() && (q.array() <= box.high.array()).all()) {
          ASSERT_TRUE(seen[f]);
        }
      }
    }
  }
}

TEST_P(TreeOfEachK, VisitsEachUnorderedSlotPairWithinTheMarginOnce) {
  const TriangleMesh mesh = shapes::sphere(2);
  const TriangleTree tree(mesh.positions, mesh.triangles, GetParam());
  std::vector<std::array<int, 2>> pairs;
  for (int s = 0; s < tree.n_slots(); ++s)
    tree.visit_slots(tree.dop_of_slot(s, 0.05), s + 1, [&](int other) {
      pairs.push_back({s, other});
    });
  auto sorted = pairs;
  std::sort(sorted.begin(), sorted.end());
  EXPECT_EQ(std::unique(sorted.begin(), sorted.end()), sorted.end());
  for (const auto& [a, b] : pairs)
    ASSERT_LT(a, b);
  for (int a = 0; a < tree.n_slots(); ++a)
    for (int b = a + 1; b < tree.n_slots(); ++b) {
      double nearest = 1e300;
      for (const Vec3& p : tree.corners(a))
        nearest = std::min(
            nearest, point_triangle(p, tree.corners(b)[0], tree.corners(b)[1], tree.corners(b)[2])
                         .squared_distance);
      if (nearest <= 0.05 * 0.05) {
        ASSERT_TRUE(std::binary_search(pairs.begin(), pairs.end(), std::array<int, 2>{a, b}) ||
                    std::find(pairs.begin(), pairs.end(), std::array<int, 2>{a, b}) != pairs.end());
      }
    }
}

TEST_P(TreeOfEachK, LowestNodesHoldFourSlotsEachAndABoxWithoutBordersOverlapsThemAllOnce) {
  const double all = std::numeric_limits<double>::infinity();
  for (int n : {1, 4, 5, 6, 9, 17, 33, 101}) {
    const TriangleMesh mesh = shapes::soup(n, 0.3, 7);
    const TriangleTree tree(mesh.positions, mesh.triangles, GetParam());
    const Dop everything = tree.dop_of({Vec3::Constant(-all), Vec3::Constant(all)});
    std::vector<int> slots, first;
    tree.visit_slots(everything, 0, [&](int slot) { slots.push_back(slot); });
    tree.visit_lowest(everything, 0, [&](int node) {
      ASSERT_TRUE(tree.nodes()[node].is_lowest());
      first.push_back(tree.nodes()[node].first_slot());
    });
    std::sort(slots.begin(), slots.end());
    std::sort(first.begin(), first.end());
    ASSERT_EQ(static_cast<int>(slots.size()), n);
    ASSERT_EQ(static_cast<int>(first.size()), (n + 3) / 4);
    for (int i = 0; i < n; ++i)
      ASSERT_EQ(slots[i], i);
    for (std::size_t i = 0; i < first.size(); ++i)
      ASSERT_EQ(first[i], 4 * static_cast<int>(i));
  }
}

TEST(TriangleTree, MoreDirectionsVisitFewerPairs) {
  TriangleMesh mesh = shapes::sphere(4);
  std::vector<long> visits;
  for (int k : {6, 14, 18, 26}) {
    const TriangleTree tree(mesh.positions, mesh.triangles, k);
    long n = 0;
    for (int s = 0; s < tree.n_slots(); ++s)
      tree.visit_slots(tree.dop_of_slot(s, 0), s + 1, [&](int) { ++n; });
    visits.push_back(n);
  }
  EXPECT_LT(visits[1], visits[0]);
  EXPECT_LT(visits[2], visits[0]);
  EXPECT_LE(visits[3], std::min(visits[1], visits[2]));
}

TEST(TriangleTree, EmptyAndOneTriangleTreesAnswer) {
  EXPECT_EQ(TriangleTree().closest_point({0, 0, 0}, 1).triangle, -1);
  EXPECT_EQ(TriangleTree({}, {}).closest_point({0, 0, 0}, 1).triangle, -1);
  const TriangleTree one({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}});
  EXPECT_EQ(one.closest_point({0.2, 0.2, 0.5}, 1).triangle, 0);
  EXPECT_EQ(one.closest_point({0.2, 0.2, 0.5}, 0.4).triangle, -1);
  EXPECT_EQ(one.closest_point({0.2, 0.2, std::nan("")}, 1).triangle, -1);
}

TEST(TriangleTree, a_way_meets_the_first_triangle_on_it) {
  const TriangleMesh mesh = shapes::sphere(3);
  const TriangleTree tree(mesh.positions, mesh.triangles);
  Random random(11);
  for (int i = 0; i < 200; ++i) {
    const double x = random.uniform(-1, 1), y = random.uniform(-1, 1), z = random.uniform(-1, 1);
    const Vec3 out = Vec3(x, y, z).normalized();
    const double hit = tree.first_hit(
        2 * out, -2 * out); // from both sides the chords lie a little below the unit sphere
    EXPECT_GT(hit, 0.25 - 1e-9);
    EXPECT_LT(hit, 0.26);
    EXPECT_FALSE(tree.first_hit(2 * out, 1.01 * out) <= 1) << "it ends before";
    EXPECT_LT(tree.first_hit(0.5 * out, 1.5 * out), 0.51) << "from inside too";
  }
}

TEST(TriangleTree, ManyEqualTrianglesDoNotUnbalanceIt) {
  TriangleMesh mesh;
  mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  mesh.triangles.assign(3000, Triangle{0, 1, 2});
  const TriangleTree tree(mesh.positions, mesh.triangles);
  EXPECT_EQ(tree.closest_point({0.2, 0.2, 1}, 2).triangle, 0) << "ties go to the lowest index";
  EXPECT_LT(tree.nodes().size(), 3000u);
}

TEST(TriangleTree, RefusesOtherK) {
  EXPECT_THROW(TriangleTree({}, {}, 8), Error);
}

TEST(TriangleTree, NonFiniteVerticesHideOnlyTheirOwnTriangles) {
  TriangleMesh mesh = shapes::sphere(2);
  mesh.positions[5] = Vec3::Constant(std::nan(""));
  const TriangleTree tree(mesh.positions, mesh.triangles);
  const ClosestPoint c = tree.closest_point({0, 0, 2}, 10);
  EXPECT_GE(c.triangle, 0);
  EXPECT_TRUE(c.point.allFinite());
}

} // namespace
} // namespace sloper::collision
