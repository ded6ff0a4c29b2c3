/// Drapes whose starts differ: the same for any number of threads, what is measured of them, and
/// what is kept.
#include <support/hung_sheet.hpp>
#include <support/scratch_folder.hpp>

#include <gtest/gtest.h>
#include <sloper/base/parallel.hpp>
#include <sloper/base/random.hpp>
#include <sloper/garment/garment_json.hpp>
#include <sloper/garment/materials.hpp>
#include <sloper/garment/redrape/spread.hpp>
#include <sloper/garment/scene/scene.hpp>
#include <sloper/io/json.hpp>

using namespace sloper;
using namespace sloper::garment;

namespace {

/// A square of cloth of n by n vertices and 0.3 m, pinned at two places of its top edge.
Garment hung_square(int n) {
  Garment g = hung_sheet(n - 1, n - 1, 0.3 / (n - 1));
  ScenePin left, right;
  left.run = {"sheet", Vec2(0.1, 1), Vec2(0.1, 1)};
  right.run = {"sheet", Vec2(0.9, 1), Vec2(0.9, 1)};
  left.has_target = right.has_target = true;
  left.target = Vec3(0.06, 1.3, 0);
  right.target = Vec3(0.24, 1.3, 0);
  g.scene.pins = {left, right};
  return g;
}

RedrapeSet drapes(int count, int threads) {
  set_thread_count(threads);
  RedrapeRequest request;
  request.count = count;
  const RedrapeSet set =
      redrape(hung_square(9), nullptr, preset_settings("draft"), request, silent_reporter());
  set_thread_count(1);
  return set;
}

} // namespace

TEST(StartJitter, start_0_is_the_start_itself_and_any_other_is_the_same_wherever_it_is_made) {
  std::vector<Vec3> x;
  for (int k = 0; k < 50; ++k)
    x.emplace_back(0.01 * k, 1 + 0.02 * k, 0.1);
  auto zero = x, three = x, again = x, four = x;
  jitter_start(zero, {}, 1, 0);
  EXPECT_EQ(zero, x);
  jitter_start(three, {}, 1, 3);
  jitter_start(again, {}, 1, 3);
  jitter_start(four, {}, 1, 4);
  EXPECT_EQ(three, again);
  EXPECT_NE(three, four);
}

TEST(StartJitter, neighbours_move_together_so_that_layers_do_not_cross) {
  // Two layers a millimetre apart: the largest bounds that --jitter takes turn no distance about.
  StartJitter jitter;
  jitter.order_m = 0.02;
  std::vector<Vec3> x;
  Random random(3);
  for (int k = 0; k < 200; ++k) {
    const double a = random.uniform(-0.4, 0.4), b = random.uniform(0.8, 1.5);
    x.emplace_back(a, b, 0.1);
    x.emplace_back(a, b, 0.101);
  }
  for (int index = 1; index < 20; ++index) {
    auto moved = x;
    jitter_start(moved, jitter, 7, index);
    for (std::size_t k = 0; k < x.size(); k += 2)
      EXPECT_NEAR((moved[k + 1] - moved[k]).norm(), 0.001, 0.0008);
  }
}

TEST(StartJitter, what_is_no_bound_is_refused) {
  StartJitter jitter;
  set_jitter(jitter, "turn_deg=2");
  EXPECT_NEAR(jitter.turn_rad, 2 * M_PI / 180, 1e-12);
  for (const char* text :
       {"turn_deg", "turn_deg=", "turn_deg=x", "twist=1", "offset_mm=-1", "order_mm=30"})
    EXPECT_THROW(set_jitter(jitter, text), Error) << text;
}

TEST(Redrapes, are_the_same_bytes_for_any_number_of_threads) {
  const RedrapeSet one = drapes(4, 1), three = drapes(4, 3);
  for (std::size_t k = 0; k < 4; ++k)
    EXPECT_EQ(one.garments[k].position, three.garments[k].position) << k;
  RedrapeRequest request;
  EXPECT_EQ(io::to_text(spread_json(measure_spread(one, nullptr), request, "test")),
            io::to_text(spread_json(measure_spread(three, nullptr), request, "test")));
}

TEST(Redrapes, what_all_thrown_errors_leave_is_the_first) {
  set_thread_count(2);
  try {
    run_alone(5, [](std::size_t k) {
      if (k > 1)
        throw Error(ErrorKind::INPUT, "test.fact"_id, "", "task " + std::to_string(k),
                    "went wrong");
    });
    FAIL();
  } catch (const Error& e) {
    EXPECT_NE(std::string(e.what()).find("task 2"), std::string::npos) << e.what();
  }
  EXPECT_EQ(thread_count(), 2);
  set_thread_count(1);
}

TEST(Spread, figures_are_those_of_the_drapes) {
  RedrapeSet set;
  // Three sheets that are moved as a whole by 0, 3 and 4 mm.
  for (double z : {0.0, 0.003, 0.004}) {
    Garment g = hung_square(5);
    g.particle_of.resize(25);
    for (int k = 0; k < 25; ++k)
      g.particle_of[k] = k;
    g.position = g.panels.placed;
    for (Vec3& p : g.position)
      p.z() += z;
    g.converged = true;
    set.garments.push_back(g);
  }
  set.garments.push_back(set.garments[0]);
  set.garments.back().converged = false;
  set.reports.resize(4);
  const Spread spread = measure_spread(set, nullptr);
  EXPECT_EQ(spread.count, 4);
  EXPECT_EQ(spread.at_rest, 3);
  EXPECT_EQ(spread.medoid, 1);
  EXPECT_NEAR(spread.to_medoid_m[0], 0.003, 1e-12);
  EXPECT_NEAR(spread.to_medoid_m[2], 0.001, 1e-12);
  EXPECT_EQ(spread.to_medoid_m[3], -1);
  EXPECT_NEAR(spread.pairs.at("rms_mm").mean, (3 + 4 + 1) / 3.0, 1e-9);
  EXPECT_NEAR(spread.pairs.at("max_mm").mean, (3 + 4 + 1) / 3.0, 1e-9);
  EXPECT_NEAR(spread.particles_m[7], spread_figure({0, 0.003, 0.004}).sd, 1e-12);
  EXPECT_NEAR(spread.strain_p99.sd, 0, 1e-9);
  const SpreadFigure f = spread_figure({1, 2, 3, 6});
  EXPECT_NEAR(f.mean, 3, 1e-12);
  EXPECT_NEAR(f.sd, std::sqrt(14.0 / 3), 1e-12);
  EXPECT_NEAR(f.error(), f.sd / 2, 1e-12);
}

TEST(Spread, goes_with_the_garment_and_a_garment_without_it_has_no_word_of_it) {
  const test::ScratchFolder folder;
  const RedrapeSet set = drapes(3, 2);
  const Spread spread = measure_spread(set, nullptr);
  ASSERT_GE(spread.at_rest, 2);
  Garment g = set.garments[spread.medoid];
  write_garment(folder / "plain.json", g, "test");
  EXPECT_FALSE(io::read_json(folder / "plain.json").contains("redrapes"));
  keep_spread(spread, g);
  write_garment(folder / "again.json", g, "test");
  const Garment read = read_garment(folder / "again.json");
  EXPECT_EQ(read.redrapes.count, spread.at_rest);
  EXPECT_EQ(read.redrapes.spread_m, spread.particles_m);
}
