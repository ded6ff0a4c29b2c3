/// --max-error-mm and --max-seconds, on scenes that the presets were not measured on.
#include <support/drape_scene.hpp>

#include <algorithm>
#include <garment/scene/preset_table.hpp>
#include <gtest/gtest.h>
#include <numeric>
#include <sloper/garment/drape/accuracy.hpp>
#include <sloper/garment/materials.hpp>
#include <sloper/garment/scene/scene.hpp>
#include <sloper/io/json.hpp>

using namespace sloper;
using namespace sloper::garment;

namespace {

void keep(DrapeSettings&) {}

double rms(const Garment& a, const Garment& b) {
  double sum = 0;
  for (std::size_t i = 0; i < a.position.size(); ++i)
    sum += (a.position[i] - b.position[i]).squaredNorm() / static_cast<double>(a.position.size());
  return std::sqrt(sum);
}

} // namespace

/// The table's figures are of three samples. On other scenes presets may be farther off; on these
/// they are not. Of a single scene the rest within half a millimetre is a matter of chance, so that
/// only the mean says which preset is nearer; and as the table's budgets are kept from all starts
/// but one in nine, one scene may fall into other folds: silk has rests 0.1 to 5 mm apart.
TEST(
    Presets,
    are_within_ten_times_their_table_on_scenes_that_it_was_not_made_from_and_each_is_nearer_than_the_last) {
  const body::Body pillar = make_pillar();
  std::vector<double> before;
  std::array<std::vector<double>, std::size(PRESETS)> off; // m, by fabric
  for (const char* fabric : {"cotton-poplin", "denim", "silk", "wool-suiting", "jersey"}) {
    Garment start = make_skirt(0.76, 0.28, 0.04);
    start.materials[""] = material_preset(fabric);
    DrapeSettings sewn = preset_settings("standard");
    sewn.settle_force_ratio = 10;
    sewn.settle_speed_m_s = 1;
    drape(start, &pillar, sewn, silent_reporter());
    Garment reference = start;
    const DrapeReport finest =
        drape(reference, &pillar, preset_settings("reference"), silent_reporter());
    ASSERT_TRUE(finest.converged) << fabric << ": " << stop_text(finest);
    before.push_back(rms(start, reference));
    for (std::size_t k = 0; k < off.size(); ++k) {
      const Preset& p = PRESETS[k];
      Garment cloth = start;
      EXPECT_TRUE(drape(cloth, &pillar, preset_settings(p.name), silent_reporter()).converged)
          << fabric << ", " << p.name;
      off[k].push_back(rms(cloth, reference));
    }
  }
  const auto all_but_worst = [](std::vector<double>& of) {
    std::sort(of.begin(), of.end());
    return std::accumulate(of.begin(), of.end() - 1, 0.0);
  };
  double last = all_but_worst(before);
  for (std::size_t k = 0; k < off.size(); ++k) {
    const double now = all_but_worst(off[k]);
    EXPECT_LE(off[k].end()[-2], 10e-3 * PRESETS[k].worst_rms_mm) << PRESETS[k].name;
    EXPECT_LT(now, last) << PRESETS[k].name;
    last = now;
  }
}

/// From a residual of 0.01 on, a solve also ends at its error in the energy norm, which is reached
/// before the residual is small.
TEST(
    Presets,
    that_end_solves_at_the_error_in_the_energy_norm_take_fewer_iterations_than_for_a_small_residual) {
  const body::Body pillar = make_pillar();
  Garment placed = make_skirt(0.76, 0.28, 0.04);
  ASSERT_TRUE(drape(placed, &pillar, preset_settings("standard"), silent_reporter()).converged);
  for (Vec3& p : placed.position)
    p = Vec3(1.02 * p.x(), p.y() + 0.01, 1.02 * p.z());
  const auto iterations = [&](double cg_tolerance) {
    Garment cloth = placed;
    DrapeSettings settings = preset_settings("standard");
    settings.cg_tolerance = cg_tolerance;
    const DrapeReport report = drape(cloth, &pillar, settings, silent_reporter());
    EXPECT_TRUE(report.converged) << cg_tolerance;
    EXPECT_LT(report.quality["residual_force_ratio"].get<double>(), settings.settle_force_ratio);
    return report.steps * report.solver["cg_iterations"]["mean"].get<double>();
  };
  EXPECT_LT(iterations(0.01), 0.7 * iterations(0.001)); // below 0.01 the residual alone counts
}

class Goal : public testing::TestWithParam<double> {};

TEST_P(Goal, is_met_against_the_reference_going_on_from_the_same_state) {
  const body::Body pillar = make_pillar();
  Garment skirt = make_skirt(0.78, 0.35, 0.035);
  const AccuracyReport report =
      drape_to_goal(skirt, &pillar, {GetParam(), 0}, keep, silent_reporter());
  ASSERT_TRUE(report.drape.converged) << stop_text(report.drape);
  Garment reference = skirt;
  drape(reference, &pillar, preset_settings("reference"), silent_reporter());
  if (report.met) {
    EXPECT_LT(rms(skirt, reference), GetParam()) << report.achieved.dump();
  } else {
    EXPECT_EQ(report.drape.settings.accuracy, "reference") << "gave up before the finest preset";
  }
  EXPECT_EQ(report.achieved["met"], report.met);
  EXPECT_GE(report.achieved["presets"].size(), 2u);
}

INSTANTIATE_TEST_SUITE_P(millimetres, Goal, testing::Values(2e-3, 5e-4, 1e-4),
                         [](const auto& goal) {
                           return std::to_string(static_cast<int>(1e6 * goal.param)) + "_um";
                         });

TEST(Goal, of_time_is_kept_and_a_tighter_goal_takes_finer_presets) {
  const body::Body pillar = make_pillar(32, 30);
  Garment loose = make_skirt(0.78, 0.3, 0.05), tight = loose, hurried = loose;
  const AccuracyReport a = drape_to_goal(loose, &pillar, {5e-3, 0}, keep, silent_reporter());
  const AccuracyReport b = drape_to_goal(tight, &pillar, {5e-5, 0}, keep, silent_reporter());
  EXPECT_LE(a.achieved["presets"].size(), b.achieved["presets"].size());
  EXPECT_GT(b.drape.steps, a.drape.steps);
  const AccuracyReport c = drape_to_goal(hurried, &pillar, {0, 1e-3}, keep, silent_reporter());
  EXPECT_FALSE(c.met);
  EXPECT_EQ(c.drape.stop_reason, StopReason::TIME_LIMIT);
}

TEST(Goal, that_needs_two_presets_reports_the_steps_and_the_sewing_of_both) {
  const body::Body pillar = make_pillar(32, 30);
  Garment skirt = make_skirt(0.78, 0.3, 0.05);
  const AccuracyReport report = drape_to_goal(skirt, &pillar, {0, 1000}, keep, silent_reporter());
  EXPECT_EQ(report.achieved["presets"].size(), 2u);
  EXPECT_EQ(report.drape.settings.accuracy, "standard");
  for (const EffectReport& e : report.drape.effects)
    if (e.name == "sewing") {
      EXPECT_GT(e.calls, 0);
    }
  EXPECT_TRUE(report.met);
}
