/// A dense skin's few triangles: near the skin, its own vertices, and a means only.
#include <support/drape_scene.hpp>

#include <garment/simulate/audit.hpp>
#include <gtest/gtest.h>
#include <random>
#include <sloper/collision/body_collider.hpp>
#include <sloper/collision/triangle_tree.hpp>
#include <sloper/garment/body_model/coarse_skin.hpp>
#include <sloper/garment/drape/drape.hpp>

using namespace sloper;
using namespace sloper::garment;

namespace {

constexpr double TOLERANCE = 3e-4;

body::Body dense_pillar() {
  return make_pillar(256, 240);
} // 123,000 triangles

} // namespace

TEST(CoarseSkin, lies_near_the_skin_with_few_triangles) {
  const TriangleMesh skin = dense_pillar().skin;
  const CoarseSkin coarse(skin, TOLERANCE);
  EXPECT_TRUE(coarse.pays());
  EXPECT_LT(coarse.mesh().triangles.size(), skin.triangles.size() / 4);
  const collision::TriangleTree tree(coarse.mesh().positions, coarse.mesh().triangles);
  double farthest = 0;
  for (const Vec3& p : skin.positions)
    farthest = std::max(farthest, (tree.closest_point(p, 0.05).point - p).norm());
  EXPECT_GT(farthest, 0);
  EXPECT_LT(farthest, 4 * TOLERANCE);
}

TEST(CoarseSkin, moves_with_the_skin_whose_vertices_it_has) {
  const TriangleMesh skin = dense_pillar().skin;
  const CoarseSkin coarse(skin, TOLERANCE);
  std::vector<Vec3> moved = skin.positions;
  for (Vec3& p : moved)
    p = Vec3(p.y(), 2 * p.x(), -p.z());
  const std::vector<Vec3> got = coarse.positions(moved);
  ASSERT_EQ(got.size(), coarse.mesh().positions.size());
  for (std::size_t v = 0; v < got.size(); ++v) {
    const Vec3& p = coarse.mesh().positions[v];
    EXPECT_EQ(got[v], Vec3(p.y(), 2 * p.x(), -p.z()));
  }
}

TEST(CoarseSkin, what_has_no_triangle_to_spare_does_not_pay) {
  TriangleMesh jagged = make_pillar(64, 60).skin; // by centimetres
  for (std::size_t v = 0; v < jagged.positions.size(); ++v)
    jagged.positions[v].x() *= 1 + 0.1 * std::sin(static_cast<double>(v * v));
  EXPECT_FALSE(CoarseSkin(jagged, TOLERANCE).pays());
}

class OnCoarseSkin : public testing::TestWithParam<double> {}; // m, noise of the skin

TEST_P(OnCoarseSkin, cloth_ends_at_rest_on_the_skin_itself_where_it_hung_before) {
  body::Body pillar = dense_pillar();
  std::mt19937 random(1);
  std::normal_distribution<double> noise(0, 1);
  for (Vec3& p : pillar.skin.positions)
    for (double& coordinate : p)
      coordinate += GetParam() * noise(random);
  EXPECT_EQ(CoarseSkin(pillar.skin, TOLERANCE).pays(), GetParam() == 0)
      << "noise takes twice the tolerance";
  const collision::BodyCollider skin(pillar.skin);
  DrapeSettings settings;
  settings.settle_speed_m_s = 0.002;
  settings.skin_tolerance_m = 0;
  Garment whole = make_skirt(0.75, 0.3, 0.04);
  ASSERT_TRUE(drape(whole, &pillar, settings, silent_reporter()).converged);
  Garment again = whole;
  settings.skin_tolerance_m = TOLERANCE;
  const DrapeReport report = drape(again, &pillar, settings, silent_reporter());
  EXPECT_TRUE(report.converged) << stop_text(report);
  EXPECT_TRUE(audit(again, &skin).clean());
  double squares = 0, nearest = 1e300;
  for (std::size_t i = 0; i < again.position.size(); ++i) {
    squares += (again.position[i] - whole.position[i]).squaredNorm() /
               static_cast<double>(again.position.size());
    nearest = std::min(nearest, skin.signed_distance(again.position[i], 0.1).distance);
  }
  EXPECT_LT(std::sqrt(squares), 0.002);
  EXPECT_GT(squares, 0); // there was a coarser skin
  EXPECT_GT(nearest, 0);
  EXPECT_LT(nearest, settings.contact_gap_m) << "the skirt touches";
}

INSTANTIATE_TEST_SUITE_P(Noise, OnCoarseSkin, testing::Values(0, 3e-4));
