#include <gtest/gtest.h>
#include <sloper/body/measure/section.hpp>
#include <support/shapes.hpp>

#include <cmath>

using namespace sloper;
using namespace sloper::body;

namespace {

TriangleMesh cylinder(double radius, double y0, double y1, int n, double x = 0) {
  return shapes::cylinder(radius, y0, y1, n, 1, Vec3(x, 0, 0),
                          0.25 * n); // the first vertex of a ring at +x
}

} // namespace

TEST(Section, of_a_cylinder_has_its_area_centre_and_girth) {
  const std::vector<Loop> loops = cut(cylinder(0.1, 0, 1, 200, 0.3), level_plane(0.4321));
  ASSERT_EQ(loops.size(), 1u);
  EXPECT_TRUE(loops[0].closed);
  EXPECT_NEAR(loops[0].area, 3.14159 * 0.01, 2e-5);
  EXPECT_NEAR(loops[0].centroid.x(), 0.3, 1e-9);
  EXPECT_NEAR(taut_girth(loops[0]), 2 * 3.14159 * 0.1, 1e-4);
  EXPECT_TRUE(encloses(loops[0], Vec2(0.3, 0.05)));
  EXPECT_FALSE(encloses(loops[0], Vec2(0.45, 0.0)));
}

TEST(Section, through_a_vertex_ring_is_still_one_loop) {
  const std::vector<Loop> loops = cut(cylinder(0.1, 0, 1, 64), level_plane(1.0));
  ASSERT_LE(loops.size(), 1u);
  const std::vector<Loop> below = cut(cylinder(0.1, 0, 1, 64), level_plane(1.0 - 1e-12));
  ASSERT_EQ(below.size(), 1u);
  EXPECT_TRUE(below[0].closed);
}

TEST(Section, of_two_cylinders_gives_two_loops_the_larger_first) {
  TriangleMesh mesh = cylinder(0.05, 0, 1, 48, -0.2);
  const TriangleMesh other = cylinder(0.08, 0, 1, 48, 0.2);
  shapes::append(mesh, other);
  const std::vector<Loop> loops = cut(mesh, level_plane(0.5));
  ASSERT_EQ(loops.size(), 2u);
  EXPECT_GT(loops[0].centroid.x(), 0);
  EXPECT_LT(loops[1].centroid.x(), 0);
}

TEST(Section, in_a_tilted_plane_keeps_the_body_on_the_left) {
  const Plane plane = cross_plane(Vec3(0, 0.5, 0), Vec3(0.3, 1, 0.2));
  EXPECT_NEAR(plane.normal().dot(Vec3(0.3, 1, 0.2).normalized()), 1, 1e-12);
  const std::vector<Loop> loops = cut(cylinder(0.1, 0, 1, 100), plane);
  ASSERT_EQ(loops.size(), 1u);
  EXPECT_GT(loops[0].area, 0);
}

TEST(Section, knows_when_the_skin_ends) {
  TriangleMesh mesh = cylinder(0.1, 0, 1, 64);
  mesh.triangles.erase(mesh.triangles.begin(), mesh.triangles.begin() + 2);
  const std::vector<Loop> loops = cut(mesh, level_plane(0.5));
  ASSERT_EQ(loops.size(), 1u);
  EXPECT_FALSE(loops[0].closed);
}

TEST(LevelledMesh, gives_the_same_bits_as_a_cut_of_the_whole_mesh) {
  TriangleMesh mesh = cylinder(0.1, 0, 1, 60, 0.3);
  for (std::size_t v = 0; v < mesh.positions.size(); ++v)
    mesh.positions[v].y() += 0.07 * std::sin(5.0 * static_cast<double>(v)); // no level ends
  constexpr double SPACING = 0.05;
  const LevelledMesh levelled(mesh, 0.5 * SPACING, SPACING, 24);
  int n = 0;
  for (double y = 0.001; y < 1.2; y += 0.0137) {
    const std::vector<Loop> all = cut(mesh, level_plane(y)),
                            quick = levelled.cut(static_cast<int>(y / SPACING), y);
    ASSERT_EQ(all.size(), quick.size()) << y;
    for (std::size_t k = 0; k < all.size(); ++k, ++n) {
      EXPECT_EQ(all[k].segments, quick[k].segments) << y;
      EXPECT_EQ(all[k].area, quick[k].area) << y;
    }
  }
  EXPECT_GT(n, 70);
}

TEST(ConvexHull, of_a_square_with_points_inside_and_on_its_sides_has_four_corners) {
  std::vector<Vec2> points;
  for (int i = 0; i <= 4; ++i)
    for (int j = 0; j <= 4; ++j)
      points.emplace_back(0.25 * i, 0.25 * j);
  const std::vector<Vec2> hull = convex_hull(points);
  EXPECT_EQ(hull.size(), 4u);
  EXPECT_NEAR(closed_length(hull), 4, 1e-12);
}
