#include <sloper/geometry/triangle_mesh.hpp>

#include <gtest/gtest.h>

#include <cmath>

using namespace sloper;

/// A unit cube with outward faces.
static TriangleMesh cube() {
  TriangleMesh mesh;
  for (int i = 0; i < 8; ++i)
    mesh.positions.emplace_back(i & 1, i >> 1 & 1, i >> 2 & 1);
  mesh.triangles = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
                    {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
  return mesh;
}

TEST(TriangleMesh, has_vertex_normals_that_do_not_depend_on_how_a_cube_is_cut) {
  const TriangleMesh mesh = cube();
  const std::vector<Vec3> normals = vertex_normals(mesh);
  for (std::size_t v = 0; v < 8; ++v) {
    const Vec3 outward = (mesh.positions[v] - Vec3::Constant(0.5)).normalized();
    EXPECT_LT((normals[v] - outward).norm(), 1e-12) << "vertex " << v;
  }
}

TEST(TriangleMesh, has_the_same_normals_where_only_some_are_asked) {
  const TriangleMesh mesh = cube();
  const std::vector<Vec3> all = vertex_normals(mesh);
  const std::vector<Vec3> some = vertex_normals(mesh, {0, 0, 1, 0, 0, 1, 0, 0});
  EXPECT_EQ(some[2], all[2]);
  EXPECT_EQ(some[5], all[5]);
}

TEST(TriangleMesh, has_zero_normals_where_no_triangle_or_only_a_flat_one_meets) {
  TriangleMesh mesh;
  mesh.positions = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {5, 5, 5}};
  mesh.triangles = {{0, 1, 2}, {1, 1, 0}};
  for (const Vec3& n : vertex_normals(mesh))
    EXPECT_EQ(n, Vec3::Zero());
}

TEST(TriangleMesh, lists_each_edge_once_in_order) {
  const auto edges = edges_of(cube().triangles);
  EXPECT_EQ(edges.size(), 18u);
  for (std::size_t i = 0; i < edges.size(); ++i) {
    EXPECT_LT(edges[i][0], edges[i][1]);
    if (i > 0) {
      EXPECT_LT(edges[i - 1], edges[i]);
    }
  }
}

TEST(TriangleMesh, lists_the_edges_of_one_triangle_alone) {
  EXPECT_TRUE(free_edges_of(cube().triangles).empty());
  const std::vector<std::array<int, 2>> rim = {{0, 1}, {0, 2}, {1, 3}, {2, 3}};
  EXPECT_EQ(free_edges_of({{0, 1, 2}, {2, 1, 3}}), rim);
  EXPECT_TRUE(free_edges_of({}).empty());
}

TEST(TriangleMesh, numbers_components_by_their_lowest_vertex) {
  const std::vector<Triangle> triangles = {{4, 5, 6}, {0, 2, 6}};
  EXPECT_EQ(connected_components(8, triangles), (std::vector<int>{0, 1, 0, 2, 0, 0, 0, 3}));
  EXPECT_TRUE(connected_components(0, {}).empty());
}

TEST(Box3, is_empty_until_a_point_is_added) {
  EXPECT_TRUE(bounding_box({}).empty());
  const Box3 box = bounding_box({{1, 2, 3}, {-1, 5, 3}});
  EXPECT_FALSE(box.empty());
  EXPECT_EQ(box.size(), Vec3(2, 3, 0));
  EXPECT_EQ(box.center(), Vec3(0, 3.5, 3));
}

TEST(AreaNormal, follows_the_right_hand_rule_with_twice_the_area) {
  EXPECT_EQ(area_normal({0, 0, 0}, {2, 0, 0}, {0, 3, 0}), Vec3(0, 0, 6));
}
