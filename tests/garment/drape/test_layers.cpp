#include <support/drape_scene.hpp>

#include <garment/drape/layers.hpp>
#include <garment/simulate/audit.hpp>
#include <gtest/gtest.h>
#include <sloper/garment/sewing.hpp>

using namespace sloper;
using namespace sloper::garment;

namespace {

/// A skirt sewn and put around the pillar as a tube of this radius, m.
Garment tube(double girth, double length, double edge, double radius) {
  Garment g = make_skirt(girth, length, edge);
  unsew(g);
  std::vector<Vec3> x(g.panels.pattern.size());
  for (std::size_t v = 0; v < x.size(); ++v) {
    const bool back = static_cast<int>(v) >= g.panels.panels[1].first_vertex;
    const double angle = g.panels.pattern[v].x() / girth * 2 * M_PI + (back ? M_PI : 0);
    x[v] = Vec3(radius * std::sin(angle), g.panels.placed[v].y(), radius * std::cos(angle));
  }
  weld(g, x);
  return g;
}

} // namespace

TEST(Layers, merged_garments_come_apart_as_they_were) {
  std::vector<Garment> garments = {tube(0.9, 0.2, 0.05, 0.2), tube(1.0, 0.3, 0.05, 0.25)};
  const std::vector<Garment> before = garments;
  const Garment merged = merge_layers(garments);
  EXPECT_EQ(merged.position.size(), before[0].position.size() + before[1].position.size());
  EXPECT_EQ(merged.particle_triangles().size(),
            before[0].panels.triangles.size() + before[1].panels.triangles.size());
  for (Garment& g : garments)
    for (Vec3& p : g.position)
      p.setZero();
  split_layers(merged, garments);
  for (std::size_t k = 0; k < 2; ++k)
    EXPECT_EQ(garments[k].position, before[k].position);
}

TEST(Layers, inner_cloth_outside_of_the_outer_is_tucked_in_until_nothing_crosses) {
  const body::Body pillar = make_pillar(48, 40);
  const collision::BodyCollider body(pillar.skin);
  std::vector<Garment> garments = {tube(1.3, 0.3, 0.03, 0.19), tube(1.0, 0.2, 0.03, 0.16)};
  for (std::size_t i = 0; i < garments[0].position.size(); i += 3)
    garments[0].position[i] *= 1 + 1e-3 * static_cast<double>(i % 7); // not a grid on a grid
  EXPECT_GT(order_violations(garments, body)[0], 10U);
  const LayerOrder order = order_layers(garments, body, 0.002);
  EXPECT_GT(order.tucked, 10U);
  EXPECT_EQ(order.remain, 0U);
  EXPECT_EQ(order_violations(garments, body)[0], 0U);
  for (const Garment& g : garments) {
    const Audit a = audit(g, &body);
    EXPECT_TRUE(a.through.empty() && a.inside.empty());
  }
}

TEST(Layers, a_skirt_below_a_skirt_comes_to_rest_in_order) {
  const body::Body pillar = make_pillar(48, 40);
  const collision::BodyCollider body(pillar.skin);
  std::vector<Garment> garments = {make_skirt(0.72, 0.3, 0.035), make_skirt(0.76, 0.2, 0.035)};
  const DrapeReport report = drape_layers(garments, &pillar, {}, silent_reporter());
  EXPECT_TRUE(report.converged) << stop_text(report);
  const Audit a = audit(merge_layers(garments), &body);
  EXPECT_TRUE(a.clean());
  EXPECT_EQ(order_violations(garments, body)[0], 0U);
  ASSERT_EQ(report.quality["layers"].size(), 2U);
  EXPECT_EQ(report.quality["layers"][0]["order_violations"].get<int>(), 0);
  for (const EffectReport& e : report.effects)
    if (e.name == "layers") {
      EXPECT_TRUE(e.active);
      EXPECT_GT(e.calls, 0);
    }
}

TEST(Layers, without_a_body_there_is_no_order_and_the_user_is_told) {
  std::vector<Garment> garments = {tube(1.0, 0.2, 0.05, 0.2), tube(1.0, 0.2, 0.05, 0.22)};
  EXPECT_THROW(drape_layers(garments, nullptr, {}, silent_reporter()), Error);
}

TEST(Layers, a_little_of_a_garment_in_the_body_moves_out_and_the_body_is_not_drawn_in) {
  const body::Body pillar = make_pillar(48, 40);
  Garment skirt = make_skirt(0.76, 0.3, 0.03);
  ASSERT_TRUE(drape(skirt, &pillar, {}, silent_reporter()).converged);
  const std::vector<Vec3> rest = skirt.position;
  const collision::BodyCollider body(pillar.skin);
  const auto nearer = [&](const Vec3& a, const Vec3& b) {
    return body.signed_distance(a, 1).distance < body.signed_distance(b, 1).distance;
  };
  Vec3& pressed = *std::min_element(skirt.position.begin(), skirt.position.end(), nearer);
  pressed -=
      0.005 *
      Vec3(pressed.x(), 0, pressed.z()).normalized(); // as where something was tucked below it
  const DrapeReport report = drape(skirt, &pillar, {}, silent_reporter());
  EXPECT_TRUE(report.converged) << stop_text(report);
  ASSERT_EQ(report.repairs.size(), 1U);
  EXPECT_NE(report.repairs[0].find("moved out"), std::string::npos) << report.repairs[0];
  EXPECT_TRUE(audit(skirt, &body).clean());
  double farthest = 0;
  for (std::size_t i = 0; i < rest.size(); ++i)
    farthest = std::max(farthest, (skirt.position[i] - rest[i]).norm());
  EXPECT_LT(farthest, 0.01) << "it hangs as it did";
}
