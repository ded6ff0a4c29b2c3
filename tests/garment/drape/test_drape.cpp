#include <support/drape_scene.hpp>

#include <algorithm>
#include <garment/simulate/audit.hpp>
#include <gtest/gtest.h>
#include <sloper/base/parallel.hpp>
#include <sloper/garment/drape/drape.hpp>

using namespace sloper;
using namespace sloper::garment;

TEST(Drape, a_skirt_is_sewn_hangs_at_the_waist_and_comes_to_rest_without_crossing_anything) {
  const body::Body pillar = make_pillar();
  Garment skirt = make_skirt(0.75, 0.5, 0.02);
  const DrapeReport report = drape(skirt, &pillar, {}, silent_reporter());
  EXPECT_TRUE(report.converged) << stop_text(report);
  const collision::BodyCollider body(pillar.skin);
  const Audit a = audit(skirt, &body);
  EXPECT_TRUE(a.clean());
  EXPECT_LT(a.strain_p99, 0.05);
  double top = 0;
  for (const Vec3& p : skirt.position)
    top = std::max(top, p.y());
  EXPECT_GT(top, 0.9);
}

TEST(Drape, effects_that_are_off_are_never_called_and_named_with_a_reason) {
  Garment skirt = make_skirt(0.75, 0.3, 0.04);
  DrapeSettings settings;
  settings.gravity_m_s2 = 0;
  const DrapeReport report = drape(skirt, nullptr, settings, silent_reporter());
  for (const EffectReport& e : report.effects) {
    EXPECT_FALSE(e.why.empty()) << e.name;
    EXPECT_TRUE(e.active || (e.calls == 0 && e.wall_s == 0)) << e.name;
    EXPECT_FALSE(e.active &&
                 (e.name == "gravity" || e.name == "body_contact" || e.name == "friction"))
        << e.name;
    EXPECT_TRUE(e.name != "edge_springs" || e.calls > 0);
  }
}

TEST(Drape, after_sewing_the_cloth_breathes_until_its_weight_comes_unless_told_not_to) {
  const body::Body pillar = make_pillar();
  for (const bool breathes : {true, false}) {
    Garment skirt = make_skirt(0.75, 0.3, 0.03);
    DrapeSettings settings;
    if (!breathes)
      settings.effects = "auto,-pressure";
    const DrapeReport report = drape(skirt, &pillar, settings, silent_reporter());
    EXPECT_TRUE(report.converged);
    const auto pressure = std::find_if(report.effects.begin(), report.effects.end(),
                                       [](const EffectReport& e) { return e.name == "pressure"; });
    ASSERT_NE(pressure, report.effects.end());
    EXPECT_EQ(pressure->active, breathes);
    EXPECT_EQ(pressure->calls, breathes ? 40 : 0);
    EXPECT_EQ(pressure->why.find("dents") != std::string::npos, breathes) << pressure->why;
  }
}

TEST(Drape, same_input_gives_the_same_bytes_for_any_number_of_threads) {
  const body::Body pillar = make_pillar();
  std::string hash;
  for (int threads : {1, 2, 3}) {
    set_thread_count(threads);
    Garment skirt = make_skirt(0.75, 0.3, 0.03);
    drape(skirt, &pillar, {}, silent_reporter());
    if (hash.empty())
      hash = strict_hash(skirt);
    EXPECT_EQ(strict_hash(skirt), hash) << threads << " threads";
  }
  set_thread_count(1);
}

TEST(Drape, a_garment_that_starts_inside_the_body_is_repaired_and_the_repair_is_listed) {
  body::Body pillar = make_pillar();
  pillar.landmarks["hip_center"].p = Vec3(0, 0.2, 0);
  pillar.landmarks["neck_center"].p = Vec3(0, 1.2, 0);
  Garment skirt = make_skirt(0.75, 0.4, 0.025, 1.02, 0.06);
  const DrapeReport report = drape(skirt, &pillar, {}, silent_reporter());
  EXPECT_TRUE(report.converged) << stop_text(report);
  ASSERT_FALSE(report.repairs.empty());
  const collision::BodyCollider body(pillar.skin);
  EXPECT_TRUE(audit(skirt, &body).clean());
}

TEST(Drape, going_on_from_a_garment_at_rest_changes_nothing_that_can_be_seen) {
  const body::Body pillar = make_pillar();
  Garment skirt = make_skirt(0.75, 0.4, 0.03);
  drape(skirt, &pillar, {}, silent_reporter());
  const std::vector<Vec3> before = skirt.position;
  const DrapeReport again = drape(skirt, &pillar, {}, silent_reporter());
  EXPECT_TRUE(again.converged);
  double moved = 0;
  for (std::size_t i = 0; i < before.size(); ++i)
    moved = std::max(moved, (skirt.position[i] - before[i]).norm());
  EXPECT_LT(moved, 0.003);
}

TEST(Drape, a_skirt_that_slides_off_is_given_up_once_it_is_beyond_the_bounds) {
  const body::Body pillar = make_pillar();
  Garment skirt = make_skirt(1.3, 0.4, 0.03);
  FitBounds bounds;
  bounds.slip_m = 0.15;
  const DrapeReport report = drape(skirt, &pillar, {}, silent_reporter(), {.bounds = bounds});
  EXPECT_EQ(report.misfit, Misfit::SLIDES_DOWN);
  EXPECT_FALSE(report.converged);
  EXPECT_LT(report.steps, 600);
}

TEST(Drape, a_skirt_that_stays_stretched_is_given_up_and_one_that_fits_is_not) {
  const body::Body pillar = make_pillar();
  FitBounds bounds{0.15, 0.05};
  Garment tight = make_skirt(0.54, 0.3, 0.03);
  EXPECT_EQ(drape(tight, &pillar, {}, silent_reporter(), {.bounds = bounds}).misfit,
            Misfit::STAYS_STRETCHED);
  Garment good = make_skirt(0.75, 0.3, 0.03);
  const DrapeReport report = drape(good, &pillar, {}, silent_reporter(), {.bounds = bounds});
  EXPECT_EQ(report.misfit, Misfit::NONE);
  EXPECT_TRUE(report.converged);
}
