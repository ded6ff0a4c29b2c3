/// Skin that touches skin is parted for cloth; all other skin stays as it was scanned.
#include <body/surface/touching_skin.hpp>
#include <gtest/gtest.h>
#include <support/shapes.hpp>

#include <cmath>
#include <random>

using namespace sloper;

namespace {

/// An upright cylinder without caps, outward.
void add_column(TriangleMesh& mesh, double x, double radius, double height, int around, int rows) {
  std::vector<shapes::Ring> rings;
  for (int r = 0; r <= rows; ++r)
    rings.push_back({height * r / rows, radius, radius});
  shapes::append(mesh, shapes::revolve(around, rings, Vec3(x, 0, 0),
                                       0.25 * around)); // the first vertex of a ring at +x
}

double least_gap(const TriangleMesh& mesh, std::size_t n_first) {
  double left = -1e300, right = 1e300;
  for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
    if (v < n_first)
      left = std::max(left, mesh.positions[v].x());
    else
      right = std::min(right, mesh.positions[v].x());
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
    const auto opened =
        body::open_touching_skin(mesh, std::vector<char>(mesh.positions.size(), 1), 0.004);
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

/// A slot that ends in a round roof, as between two thighs: outward is into the slot, and the skin
/// is as rough as a scan's. Columns of vertices go up one wall, over the roof and down the other;
/// n_columns says how many.
TriangleMesh slot(double width, double edge, double roughness, int& n_columns) {
  constexpr double DEPTH = 0.03, LENGTH = 0.02; // m
  std::vector<std::array<double, 2>> profile;
  for (double y = -DEPTH; y < 0; y += edge)
    profile.push_back({-width / 2, y});
  const std::size_t n_wall = profile.size();
  const int n_roof = std::max(4, static_cast<int>(std::lround(M_PI * width / 2 / edge)));
  for (int k = 0; k <= n_roof; ++k)
    profile.push_back(
        {-width / 2 * std::cos(M_PI * k / n_roof), width / 2 * std::sin(M_PI * k / n_roof)});
  for (std::size_t k = n_wall; k-- > 0;)
    profile.push_back({width / 2, profile[k][1]});
  n_columns = static_cast<int>(profile.size());
  TriangleMesh mesh;
  std::mt19937 random(1);
  std::normal_distribution<double> noise(0, roughness);
  const int rows = static_cast<int>(std::lround(LENGTH / edge));
  for (int r = 0; r <= rows; ++r)
    for (const auto& [x, y] : profile)
      mesh.positions.emplace_back(x + noise(random), y + noise(random), r * edge);
  for (int r = 0; r < rows; ++r)
    for (int c = 0; c + 1 < n_columns; ++c) {
      const int a = r * n_columns + c;
      mesh.triangles.push_back({a, a + 1, a + 1 + n_columns});
      mesh.triangles.push_back({a, a + 1 + n_columns, a + n_columns});
    }
  return mesh;
}

TEST(TouchingSkin, FineSkinWhereTheWallsOfASlotMeetDoesNotLieInFolds) {
  for (const double width : {0.0005, 0.002})
    for (const double edge : {0.001, 0.002, 0.004})
      for (const double roughness : {0.0, 0.0001, 0.0003}) {
        int n_columns = 0;
        TriangleMesh mesh = slot(width, edge, roughness, n_columns);
        const TriangleMesh before = mesh;
        body::open_touching_skin(mesh, std::vector<char>(mesh.positions.size(), 1), 0.004);
        int folded = 0;
        for (const auto& [a, b, c] : mesh.triangles)
          if (before.positions[a].y() < -0.002)
            folded += area_normal(mesh.positions[a], mesh.positions[b], mesh.positions[c])
                          .dot(area_normal(before.positions[a], before.positions[b],
                                           before.positions[c])) < 0;
        EXPECT_EQ(folded, 0) << "width " << width << ", edge " << edge << ", roughness "
                             << roughness;
        double left = -1, right = 1; // below the roof there is room for cloth
        for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
          if (before.positions[v].y() > -0.008)
            continue;
          const double x = mesh.positions[v].x();
          if (static_cast<int>(v) % n_columns < n_columns / 2)
            left = std::max(left, x);
          else
            right = std::min(right, x);
        }
        EXPECT_GT(right - left, 0.003)
            << "width " << width << ", edge " << edge << ", roughness " << roughness;
      }
}

TEST(TouchingSkin, SkinThatTouchesNothingOrMayNotMoveIsLeftAlone) {
  TriangleMesh apart;
  add_column(apart, -0.06, 0.055, 0.3, 64, 40);
  add_column(apart, 0.06, 0.055, 0.3, 64, 40);
  const TriangleMesh before = apart;
  EXPECT_EQ(
      body::open_touching_skin(apart, std::vector<char>(apart.positions.size(), 1), 0.004).vertices,
      0);
  EXPECT_EQ(apart.positions, before.positions);
  TriangleMesh hands;
  add_column(hands, -0.06, 0.0599, 0.3, 64, 40);
  add_column(hands, 0.06, 0.0599, 0.3, 64, 40);
  EXPECT_EQ(
      body::open_touching_skin(hands, std::vector<char>(hands.positions.size(), 0), 0.004).vertices,
      0);
}

} // namespace
