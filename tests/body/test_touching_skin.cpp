/// Skin that touches skin is parted for cloth; all other skin stays as it was scanned.
#include <body/touching_skin.hpp>
#include <gtest/gtest.h>

#include <cmath>

using namespace sloper;

namespace {

/// An upright cylinder without caps, outward.
void add_column(TriangleMesh& mesh, double x, double radius, double height, int around, int rows) {
  const int first = static_cast<int>(mesh.positions.size());
  for (int r = 0; r <= rows; ++r)
    for (int c = 0; c < around; ++c) {
      const double angle = 2 * M_PI * c / around;
      mesh.positions.emplace_back(x + radius * std::cos(angle), height * r / rows, -radius * std::sin(angle));
    }
  for (int r = 0; r < rows; ++r)
    for (int c = 0; c < around; ++c) {
      const int a = first + r * around + c, b = first + r * around + (c + 1) % around;
      mesh.triangles.push_back({a, b, b + around});
      mesh.triangles.push_back({a, b + around, a + around});
    }
}

double least_gap(const TriangleMesh& mesh, std::size_t n_first) {
  double left = -1e300, right = 1e300;
  for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
    if (v < n_first) left = std::max(left, mesh.positions[v].x());
    else right = std::min(right, mesh.positions[v].x());
  }
  return right - left;
}

TEST(TouchingSkin, TwoLegsThatTouchOrOverlapALittleArePartedAndTheRestStays) {
  for (double gap : {0.001, -0.001}) {
    TriangleMesh mesh;
    add_column(mesh, -0.06, 0.06 - 0.5 * gap, 0.3, 64, 40);
    const std::size_t n_first = mesh.positions.size();
    add_column(mesh, 0.06, 0.06 - 0.5 * gap, 0.3, 64, 40);
    const TriangleMesh before = mesh;
    const auto opened = body::open_touching_skin(mesh, std::vector<char>(mesh.positions.size(), 1), 0.004);
    EXPECT_GT(least_gap(mesh, n_first), 0.0035) << gap;
    EXPECT_LE(opened.largest_m, 0.003 + 1e-12);
    EXPECT_GT(opened.vertices, 50);
    for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
      if (std::abs(before.positions[v].x()) > 0.03) {
        EXPECT_EQ(mesh.positions[v], before.positions[v]);
      }
    }
  }
}

TEST(TouchingSkin, SkinThatTouchesNothingOrMayNotMoveIsLeftAlone) {
  TriangleMesh apart;
  add_column(apart, -0.06, 0.055, 0.3, 64, 40);
  add_column(apart, 0.06, 0.055, 0.3, 64, 40);
  const TriangleMesh before = apart;
  EXPECT_EQ(body::open_touching_skin(apart, std::vector<char>(apart.positions.size(), 1), 0.004).vertices, 0);
  EXPECT_EQ(apart.positions, before.positions);
  TriangleMesh hands;
  add_column(hands, -0.06, 0.0599, 0.3, 64, 40);
  add_column(hands, 0.06, 0.0599, 0.3, 64, 40);
  EXPECT_EQ(body::open_touching_skin(hands, std::vector<char>(hands.positions.size(), 0), 0.004).vertices, 0);
}

} // namespace
