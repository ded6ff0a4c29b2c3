#include <support/drape_scene.hpp>

#include <garment/simulate/audit.hpp>
#include <gtest/gtest.h>
#include <sloper/garment/drape/drape.hpp>

using namespace sloper;
using namespace sloper::garment;

namespace {

/// One drape for all tests.
const Garment& draped() {
  static const Garment garment = [] {
    Garment g = make_skirt(0.75, 0.3, 0.025);
    const body::Body pillar = make_pillar();
    drape(g, &pillar, {}, silent_reporter());
    return g;
  }();
  return garment;
}

body::Body pillar_with_bones() {
  body::Body pillar = make_pillar();
  pillar.landmarks["hip_center"].p = Vec3(0, 0.2, 0);
  pillar.landmarks["neck_center"].p = Vec3(0, 1.2, 0);
  return pillar;
}

Audit audit_on(const Garment& garment, const body::Body& body) {
  const collision::BodyCollider collider(body.skin);
  return audit(garment, &collider);
}

double far_motion(const Garment& a, const Garment& b, const Vec3& from, double radius) {
  double most = 0;
  for (std::size_t i = 0; i < a.position.size(); ++i)
    if ((b.position[i] - from).norm() > radius)
      most = std::max(most, (a.position[i] - b.position[i]).norm());
  return most;
}

Vec3 front_middle(const Garment& g) {
  Vec3 best = g.position[0];
  for (const Vec3& p : g.position)
    if ((p - Vec3(0, 0.87, 0.2)).norm() < (best - Vec3(0, 0.87, 0.2)).norm())
      best = p;
  return best;
}

} // namespace

TEST(UntangleOnly, a_clean_garment_stays_as_it_is_to_the_bit) {
  const body::Body pillar = make_pillar();
  Garment g = draped();
  ASSERT_TRUE(audit_on(g, pillar).clean());
  const DrapeReport report = untangle_only(g, &pillar, {}, silent_reporter());
  EXPECT_TRUE(report.converged);
  EXPECT_EQ(strict_hash(g), strict_hash(draped()));
  EXPECT_TRUE(g.converged);
}

TEST(UntangleOnly, cloth_pressed_into_the_body_comes_out_and_the_rest_stays) {
  const body::Body pillar = make_pillar();
  for (double depth : {0.005, 0.02, 0.05}) {
    Garment g = draped();
    const Vec3 at = front_middle(g);
    for (Vec3& p : g.position)
      if (const double r = (p - at).norm(); r < 0.06)
        p.z() -= depth * (1 - r / 0.06);
    ASSERT_GT(audit_on(g, pillar).through.size(), 0U);
    const DrapeReport report = untangle_only(g, &pillar, {}, silent_reporter());
    EXPECT_TRUE(report.converged) << stop_text(report);
    EXPECT_TRUE(audit_on(g, pillar).clean()) << depth;
    EXPECT_LT(far_motion(g, draped(), at, 0.12), 1e-12) << depth;
    EXPECT_FALSE(g.converged) << "what moved is not at rest";
    EXPECT_GT(report.quality["untangled"]["before"]["faces_through_body"], 0);
    EXPECT_EQ(report.quality["untangled"]["after"]["faces_through_body"], 0);
  }
}

TEST(UntangleOnly, cloth_drawn_through_cloth_comes_out_also_without_a_body) {
  Garment g = make_skirt(0.75, 0.3, 0.025);
  DrapeSettings hang;
  hang.gravity_m_s2 = 0;
  drape(g, nullptr, hang, silent_reporter());
  const Garment before = g;
  Vec3 at = Vec3::Zero();
  for (const Vec3& p : g.position)
    if (p.z() > at.z())
      at = p;
  double back = 0; // the way from the front to the back there
  for (const Vec3& p : g.position)
    if ((p - at).head<2>().norm() < 0.03)
      back = std::max(back, at.z() - p.z());
  for (Vec3& p : g.position)
    if (const double r = (p - at).norm(); r < 0.06)
      p.z() -= (back + 0.01) * (1 - r / 0.06);
  ASSERT_GT(audit(g, nullptr).self.size(), 0U);
  const DrapeReport report = untangle_only(g, nullptr, {}, silent_reporter());
  EXPECT_TRUE(report.converged) << stop_text(report) << ": " << report.quality["untangled"].dump();
  EXPECT_EQ(audit(g, nullptr).self.size(), 0U);
}

TEST(UntangleOnly, a_garment_wholly_inside_the_body_comes_out_by_way_of_a_body_drawn_in) {
  const body::Body pillar = pillar_with_bones();
  Garment g = draped();
  for (Vec3& p : g.position)
    p = Vec3(0.6 * p.x(), p.y(), 0.6 * p.z());
  const DrapeReport report = untangle_only(g, &pillar, {}, silent_reporter());
  EXPECT_TRUE(report.converged) << stop_text(report) << ": " << report.quality["untangled"].dump();
  EXPECT_TRUE(audit_on(g, pillar).clean());
}
