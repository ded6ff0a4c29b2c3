/// Skin of the head that nobody sees is left out, and what it hung on is closed.
#include <body/surface/head_sacs.hpp>
#include <body/surface/mesh_repair.hpp>
#include <gtest/gtest.h>
#include <support/shapes.hpp>

using namespace sloper;
using namespace sloper::body;

namespace {

constexpr int AROUND = 48;

/// A vessel of 20 cm with walls of 2 cm, whose mouth is `mouth` wide: outside, rim, inside.
TriangleMesh vessel(double mouth) {
  std::vector<shapes::Ring> rings;
  for (int r = 0; r <= 20; ++r) {
    const double up = r / 20.0;
    const double radius = 0.02 + 0.08 * std::sin(units::PI * (0.05 + 0.9 * up));
    rings.push_back({0.2 * up, radius, radius});
  }
  rings.push_back({0.2, 0.5 * mouth, 0.5 * mouth});
  for (int r = 20; r >= 2; --r) {
    const double up = r / 20.0;
    const double radius = 0.08 * std::sin(units::PI * (0.05 + 0.9 * up));
    rings.push_back(
        {0.2 * up - 0.01, std::max(radius, 0.5 * mouth), std::max(radius, 0.5 * mouth)});
  }
  TriangleMesh mesh = shapes::revolve(AROUND, rings);
  shapes::close_ends(mesh, AROUND, Vec3::Zero(), Vec3(0, rings.back().y, 0));
  return mesh;
}

/// A bowl of 20 cm width and 10 cm height with walls of 1 cm.
TriangleMesh bowl() {
  std::vector<shapes::Ring> rings;
  for (int r = 0; r <= 10; ++r)
    rings.push_back({0.01 * r, 0.1, 0.1});
  for (int r = 10; r >= 1; --r)
    rings.push_back({0.01 * r, 0.09, 0.09});
  TriangleMesh mesh = shapes::revolve(AROUND, rings);
  shapes::close_ends(mesh, AROUND, Vec3::Zero(), Vec3(0, rings.back().y, 0));
  return mesh;
}

double volume(const TriangleMesh& mesh) {
  double sum = 0;
  for (const Triangle& t : mesh.triangles)
    sum += mesh.positions[t[0]].dot(mesh.positions[t[1]].cross(mesh.positions[t[2]])) / 6;
  return sum;
}

/// The same skin with every vertex and face where it was.
bool same(const TriangleMesh& a, const TriangleMesh& b) {
  return a.positions == b.positions && a.triangles == b.triangles;
}

} // namespace

TEST(SacsOfTheHead, behind_a_narrow_mouth_are_left_out_and_the_skin_stays_closed) {
  TriangleMesh skin = vessel(0.004);
  const TriangleMesh before = skin;
  std::vector<Part> part(skin.triangles.size(), Part::HEAD);
  const ClosedSacs closed = close_head_sacs(skin, part);
  EXPECT_EQ(closed.sacs, 1);
  EXPECT_GT(closed.area_m2, 0.05);
  EXPECT_NEAR(closed.place.x(), 0, 0.005);
  EXPECT_EQ(part.size(), skin.triangles.size());
  EXPECT_LT(skin.triangles.size(), before.triangles.size());
  const EdgeCounts edges = count_edges(half_edges(skin));
  EXPECT_EQ(edges.border, 0);
  EXPECT_EQ(edges.flipped, 0);
  EXPECT_GT(volume(skin), 2 * volume(before));
  for (const Vec3& p : skin.positions)
    EXPECT_TRUE(p.allFinite());
}

TEST(SacsOfTheHead, that_can_be_looked_into_stay) {
  TriangleMesh skin = bowl();
  const TriangleMesh before = skin;
  std::vector<Part> part(skin.triangles.size(), Part::HEAD);
  EXPECT_EQ(close_head_sacs(skin, part).sacs, 0);
  EXPECT_TRUE(same(skin, before));
}

TEST(SacsOfTheHead, of_other_parts_stay) {
  TriangleMesh skin = vessel(0.004);
  const TriangleMesh before = skin;
  std::vector<Part> part(skin.triangles.size(), Part::TORSO);
  EXPECT_EQ(close_head_sacs(skin, part).sacs, 0);
  EXPECT_TRUE(same(skin, before));
}

TEST(SacsOfTheHead, a_convex_head_has_none_on_coarse_and_fine_meshes) {
  for (const int levels : {1, 2, 3, 4, 5}) {
    TriangleMesh skin = shapes::sphere(levels, 0.1);
    const TriangleMesh before = skin;
    std::vector<Part> part(skin.triangles.size(), Part::HEAD);
    EXPECT_EQ(close_head_sacs(skin, part).sacs, 0) << levels;
    EXPECT_TRUE(same(skin, before));
  }
}
