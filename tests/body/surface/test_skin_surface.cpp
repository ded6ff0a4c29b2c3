#include <support/figures.hpp>

#include <body/surface/skin_surface.hpp>
#include <gtest/gtest.h>

using namespace sloper;
using namespace sloper::body;

namespace {

std::vector<char> all(const TriangleMesh& mesh) {
  return std::vector<char>(mesh.positions.size(), 1);
}

double mean_distance(const TriangleMesh& from, const TriangleMesh& to) {
  double sum = 0;
  int n = 0;
  for (std::size_t v = 0; v < from.positions.size(); v += 37, ++n) {
    double least = 1e300;
    for (const Vec3& q : to.positions)
      least = std::min(least, (q - from.positions[v]).squaredNorm());
    sum += std::sqrt(least);
  }
  return sum / n;
}

/// What of a mesh lies on one side of the plane x = at, closed with a fan.
TriangleMesh beside(const TriangleMesh& mesh, double at, bool outside) {
  TriangleMesh part;
  part.positions = mesh.positions;
  std::map<std::pair<int, int>, int> edges;
  for (const Triangle& t : mesh.triangles) {
    if (std::any_of(t.begin(), t.end(),
                    [&](int v) { return (mesh.positions[v].x() > at) != outside; }))
      continue;
    part.triangles.push_back(t);
    for (int k = 0; k < 3; ++k)
      ++edges[{t[k], t[(k + 1) % 3]}];
  }
  Vec3 sum = Vec3::Zero();
  std::vector<std::pair<int, int>> border;
  for (const auto& [edge, n] : edges)
    if (!edges.count({edge.second, edge.first})) {
      border.push_back(edge);
      sum += part.positions[edge.first];
    }
  part.positions.emplace_back(sum / static_cast<double>(border.size()));
  const int middle = static_cast<int>(part.positions.size()) - 1;
  for (const auto& [from, to] : border)
    part.triangles.push_back({to, from, middle});
  return part;
}

} // namespace

TEST(Skin, of_arms_that_are_pieces_of_their_own_in_their_sleeves_is_one) {
  const TriangleMesh& whole = test::mannequin("m-178-a").mesh;
  TriangleMesh mesh = beside(whole, 0.30, false);     // a sleeve, closed at its end
  const TriangleMesh arm = beside(whole, 0.27, true); // and an arm that begins within it
  const int first = std::ssize(mesh.positions);
  mesh.positions.insert(mesh.positions.end(), arm.positions.begin(), arm.positions.end());
  for (const Triangle& t : arm.triangles)
    mesh.triangles.push_back({t[0] + first, t[1] + first, t[2] + first});
  const MeasuredScan measured = test::measure(mesh);
  EXPECT_TRUE(measured.missing.empty());
  EXPECT_TRUE(measured.doubts.empty());
  const Body expected = test::measure(whole).body;
  for (const char* name : {"wrist_l", "elbow_l", "acromion_l", "wrist_r"})
    EXPECT_LT((test::in_scan(measured.body, name) - test::in_scan(expected, name)).norm(), 0.025)
        << name;
}

TEST(Skin, of_a_sound_mesh_is_the_mesh_itself) {
  const TriangleMesh& mesh = test::mannequin("f-165-a").mesh;
  const SkinSurface skin = make_skin(mesh.positions, mesh.triangles, all(mesh), 1.65);
  EXPECT_FALSE(skin.rebuilt);
  EXPECT_EQ(skin.mesh.triangles.size(), mesh.triangles.size());
  EXPECT_GT(test::volume(skin.mesh), 0.03);
}

TEST(Skin, of_a_mesh_with_turned_and_doubled_faces_is_whole_again) {
  TriangleMesh mesh = test::mannequin("f-165-a").mesh;
  const double volume = test::volume(mesh);
  Random random(5);
  const std::size_t n = mesh.triangles.size();
  for (std::size_t t = 0; t < n; ++t) {
    if (random.uniform() < 0.05)
      mesh.triangles.push_back(mesh.triangles[t]);
    if (random.uniform() < 0.3)
      std::swap(mesh.triangles[t][0], mesh.triangles[t][1]);
  }
  mesh.triangles.push_back({1, 1, 2});
  const SkinSurface skin = make_skin(mesh.positions, mesh.triangles, all(mesh), 1.65);
  EXPECT_FALSE(skin.rebuilt);
  EXPECT_TRUE(test::is_closed_and_oriented(skin.mesh));
  EXPECT_NEAR(test::volume(skin.mesh), volume, 1e-9);
}

/// The whole skin was rebuilt for such cuts, and lost the ends of fingers and toes.
TEST(Skin, of_a_mesh_without_soles_and_crown_keeps_its_own_faces) {
  TriangleMesh mesh = test::mannequin("m-178-a").mesh;
  const std::size_t whole = mesh.triangles.size();
  std::erase_if(mesh.triangles, [&](const Triangle& t) {
    double low = 1e300, high = -1e300;
    for (const int v : t) {
      low = std::min(low, mesh.positions[v].y());
      high = std::max(high, mesh.positions[v].y());
    }
    return low < 0.012 || high > 1.70;
  });
  ASSERT_LT(mesh.triangles.size(), whole - 100);
  const SkinSurface skin = make_skin(mesh.positions, mesh.triangles, all(mesh), 1.70);
  EXPECT_FALSE(skin.rebuilt);
  EXPECT_TRUE(test::is_closed_and_oriented(skin.mesh));
}

TEST(Skin, of_bare_noisy_points_is_a_closed_surface_near_them) {
  const TriangleMesh& clean = test::mannequin("f-165-a").mesh;
  const TriangleMesh noisy = test::with_noise(clean, 0.0015, 3);
  const SkinSurface skin = make_skin(noisy.positions, {}, all(noisy), 1.65);
  EXPECT_TRUE(skin.rebuilt);
  EXPECT_TRUE(test::is_closed_and_oriented(skin.mesh));
  EXPECT_LT(skin.mesh.triangles.size(), 70000u);
  EXPECT_NEAR(test::volume(skin.mesh), test::volume(clean), 0.04 * test::volume(clean));
  EXPECT_LT(mean_distance(skin.mesh, clean), 0.008);
  EXPECT_FALSE(skin.findings.empty());
}

TEST(Skin, of_a_mesh_with_one_small_hole_keeps_its_vertices_and_is_closed) {
  TriangleMesh mesh = test::mannequin("m-178-a").mesh;
  std::erase_if(mesh.triangles, [&](const Triangle& t) {
    return (mesh.positions[t[0]] - Vec3(0, 1.2, 0.12)).norm() < 0.03;
  });
  const SkinSurface skin = make_skin(mesh.positions, mesh.triangles, all(mesh), 1.78);
  EXPECT_FALSE(skin.rebuilt);
  EXPECT_TRUE(test::is_closed_and_oriented(skin.mesh));
}

TEST(Skin, of_a_mesh_with_large_holes_is_closed) {
  TriangleMesh mesh = test::mannequin("m-178-a").mesh;
  for (const Vec3& hole : {Vec3(0, 1.2, 0.12), Vec3(0, 1.75, 0), Vec3(0.2, 0.05, 0.1),
                           Vec3(-0.2, 1.3, 0), Vec3(0, 0.9, -0.1)})
    std::erase_if(mesh.triangles,
                  [&](const Triangle& t) { return (mesh.positions[t[0]] - hole).norm() < 0.12; });
  const SkinSurface skin = make_skin(mesh.positions, mesh.triangles, all(mesh), 1.78);
  EXPECT_TRUE(skin.rebuilt);
  EXPECT_GT(skin.border_edges, 0);
  EXPECT_TRUE(test::is_closed_and_oriented(skin.mesh));
}
