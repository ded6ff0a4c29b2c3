/// Bumps of a sheet: which ones a ring of a radius finds, and how high they stand out.
#include <body/measure/relief.hpp>
#include <gtest/gtest.h>

#include <cmath>

using namespace sloper;
using namespace sloper::body;

namespace {

/// A sheet that faces +z, 20 cm wide, with a bump 4 mm high that is narrow on the left and one of
/// 9 mm that is broad on the right.
TriangleMesh sheet_with_bumps() {
  constexpr int N = 81;
  constexpr double STEP = 0.0025;
  TriangleMesh mesh;
  auto bump = [](double x, double y, double radius) {
    return std::exp(-(x * x + y * y) / (radius * radius));
  };
  for (int j = 0; j < N; ++j)
    for (int i = 0; i < N; ++i) {
      const double x = STEP * i - 0.1, y = STEP * j - 0.1;
      mesh.positions.emplace_back(
          x, y, 0.004 * bump(x + 0.05, y, 0.006) + 0.009 * bump(x - 0.05, y, 0.028));
    }
  for (int j = 0; j + 1 < N; ++j)
    for (int i = 0; i + 1 < N; ++i) {
      const int a = j * N + i;
      mesh.triangles.push_back({a, a + 1, a + N});
      mesh.triangles.push_back({a + 1, a + N + 1, a + N});
    }
  return mesh;
}

Box3 middle_of_sheet() {
  Box3 box;
  box.low = Vec3(-0.07, -0.03, -1);
  box.high = Vec3(0.07, 0.03, 1);
  return box;
}

} // namespace

/// A breast's curve stands out farther than its nipple within a wide ring: of 40 corrupted scans
/// one had both its bust points 6 cm off for it.
TEST(Relief, a_narrow_bump_is_the_tallest_within_a_small_ring_a_broad_one_within_a_wide_ring) {
  const TriangleMesh mesh = sheet_with_bumps();
  const auto sharp = tallest_reliefs(mesh, middle_of_sheet(), 0.013, 1, 0.02, 0.0005, 4),
             wide = tallest_reliefs(mesh, middle_of_sheet(), 0.03, 1, 0.03, 0.0005, 4);
  ASSERT_EQ(sharp.size(), 2U);
  EXPECT_LT((sharp[0].p - Vec3(-0.05, 0, 0.004)).norm(), 0.003);
  EXPECT_LT((sharp[1].p - Vec3(0.05, 0, 0.009)).norm(), 0.003);
  EXPECT_GT(sharp[0].height, 1.5 * sharp[1].height);
  ASSERT_GE(wide.size(), 2U);
  EXPECT_LT((wide[0].p - Vec3(0.05, 0, 0.009)).norm(), 0.003);
  const auto strongest = strongest_relief(mesh, middle_of_sheet(), 0.03, 1);
  ASSERT_TRUE(strongest);
  EXPECT_NEAR(strongest->height, wide[0].height, 1e-12);
}
