/// Shadows, folds, silhouettes, and what material-fit finds from them.
#include <garment/drapemeter/shadow.hpp>
#include <gtest/gtest.h>
#include <sloper/base/parallel.hpp>
#include <sloper/base/random.hpp>
#include <sloper/cloth/bending_plates.hpp>
#include <sloper/garment/drapemeter/material_fit.hpp>
#include <sloper/garment/drapemeter/silhouette.hpp>
#include <sloper/garment/material_json.hpp>
#include <sloper/garment/materials.hpp>
#include <sloper/io/json.hpp>

#include <cmath>
#include <ctime>

using namespace sloper;
using namespace sloper::garment;

namespace {

/// A picture as a camera makes it: noise of the grey, and single pixels that are wrong.
void add_noise(io::Image& image, std::uint64_t seed) {
  Random random(seed);
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x) {
      const double off = random.uniform(-25, 25);
      const bool wrong = random.uniform() < 0.002;
      for (int c = 0; c < 3; ++c) {
        const double grey = wrong ? 255 - image.at(x, y)[c] : image.at(x, y)[c] + off;
        image.at(x, y)[c] = static_cast<std::uint8_t>(std::clamp(grey, 0.0, 255.0));
      }
    }
}

std::vector<Vec3> waved(double radius, double swing, int folds) {
  std::vector<Vec3> rim;
  for (int k = 0; k < 200; ++k) {
    const double a = 2 * M_PI * k / 200, r = radius + swing * std::sin(folds * a);
    rim.emplace_back(0.03 + r * std::cos(a), 0, r * std::sin(a) - 0.02);
  }
  return rim;
}

} // namespace

TEST(Shadow, of_a_tilted_square_is_its_projection_less_the_hole) {
  const std::vector<Vec3> x{{-0.1, 0, -0.1}, {0.1, 0.3, -0.1}, {0.1, 0.3, 0.1}, {-0.1, 0, 0.1}};
  const std::vector<Triangle> t{{0, 1, 2}, {0, 2, 3}};
  EXPECT_NEAR(shadow_area(t, x, 2.5e-4), 0.04, 1e-4);
  EXPECT_NEAR(shadow_area(t, x, 2.5e-4, 0.05), 0.04 - M_PI * 0.0025, 1e-4);
  EXPECT_EQ(shadow_area({}, x, 1e-3), 0);
}

TEST(Folds, are_counted_where_they_swing_far_enough) {
  for (int folds : {2, 5, 8})
    EXPECT_EQ(count_folds(waved(0.12, 0.01, folds)), folds);
  EXPECT_EQ(count_folds(waved(0.12, 0.001, 5)), 0) << "a ripple";
  EXPECT_EQ(count_folds({}), 0);
}

TEST(Silhouette, has_the_coefficient_and_the_folds_of_what_was_drawn_through_noise) {
  DrapemeterSetup setup;
  setup.edge_m = 0.012;
  const DrapemeterResult drape = drape_specimen(material_preset("wool-suiting"), setup, 3);
  ASSERT_TRUE(drape.at_rest);
  io::Image picture = draw_silhouette(drape.triangles, drape.position, 0.18, 600, 0.33);
  const Silhouette clean = measure_silhouette(picture, "clean", {});
  EXPECT_NEAR(clean.coefficient, drape.coefficient, 0.01);
  // The outline around the shadow's middle is not the rim around the disc's: a fold that swings by
  // nearly 2 mm may count in one of them.
  EXPECT_NEAR(clean.folds, drape.folds, 1);
  add_noise(picture, 1);
  const Silhouette noisy = measure_silhouette(picture, "noisy", {});
  EXPECT_NEAR(noisy.coefficient, drape.coefficient, 0.01);
  EXPECT_EQ(noisy.folds, clean.folds);
  EXPECT_NEAR(noisy.m_per_pixel, 0.33 / 600, 0.005 * 0.33 / 600);
  for (int k = 0; k + 3 < std::ssize(picture.rgba); k += 4) // white on black
    for (int c = 0; c < 3; ++c)
      picture.rgba[k + c] = static_cast<std::uint8_t>(255 - picture.rgba[k + c]);
  EXPECT_NEAR(measure_silhouette(picture, "negative", {}).coefficient, drape.coefficient, 0.01);
}

TEST(Drapemeter, another_seed_is_another_drape_and_the_same_seed_the_same) {
  DrapemeterSetup setup;
  setup.edge_m = 0.015;
  const Material cotton = material_preset("cotton-poplin");
  const DrapemeterResult a = drape_specimen(cotton, setup, 1), b = drape_specimen(cotton, setup, 1),
                         c = drape_specimen(cotton, setup, 2);
  EXPECT_EQ(a.position, b.position);
  EXPECT_NE(a.position, c.position);
  setup.specimen_radius_m = 0.1;
  EXPECT_THROW(drape_specimen(cotton, setup, 1), Error) << "hangs over by less than two edges";
}

TEST(MaterialFit, overhangs_give_directions_with_the_errors_of_a_ruler) {
  FabricTests tests;
  tests.base = material_preset("cotton-poplin");
  tests.overhang_m = {std::vector{0.042, 0.043, 0.041, 0.042}, {0.036}, {0.038}};
  const MaterialFit fit = fit_material(tests, silent_reporter());
  const double weight = 0.12 * 9.80665;
  ASSERT_TRUE(fit.mean && fit.from_overhang[0]);
  EXPECT_NEAR(fit.material.bend_warp_n_m, weight * std::pow(0.021, 3), 1e-12);
  EXPECT_NEAR(fit.material.bend_weft_n_m, weight * std::pow(0.018, 3), 1e-12);
  EXPECT_NEAR(fit.from_overhang[2]->value, weight * std::pow(0.019, 3), 1e-12);
  EXPECT_NEAR(fit.material.bend_bias_n_m,
              cloth::bias_of_strip(fit.material.bend_warp_n_m, fit.material.bend_weft_n_m,
                                   fit.from_overhang[2]->value),
              1e-15);
  EXPECT_NEAR(fit.from_overhang[1]->sd / fit.from_overhang[1]->value, 3 * 0.002 / 0.036, 1e-9);
  EXPECT_LT(fit.from_overhang[0]->sd / fit.from_overhang[0]->value, 0.04) << "four strips";
  EXPECT_TRUE(fit.cannot_tell.empty());
  EXPECT_EQ(fit.simulations, 0);
}

namespace {

/// Six pictures of a fabric with the noise of a camera, from a finer mesh and other seeds than
/// those of the fit. What the fit does not look for is known.
FabricTests tests_of_pictures(const Material& truth) {
  DrapemeterSetup finer;
  finer.edge_m = 0.0065;
  FabricTests tests;
  tests.base = truth;
  tests.base.bend_n_m = 8e-6;
  tests.base.bend_warp_n_m = tests.base.bend_weft_n_m = tests.base.bend_bias_n_m = 0;
  tests.shear_error = 0;
  for (std::uint64_t seed = 1001; seed < 1007; ++seed) {
    const DrapemeterResult drape = drape_specimen(truth, finer, seed);
    io::Image picture = draw_silhouette(drape.triangles, drape.position, 0.18, 500, 0.34);
    add_noise(picture, seed);
    const Silhouette s = measure_silhouette(picture, truth.name, {});
    tests.coefficient.push_back(s.coefficient);
    tests.folds.push_back(s.folds);
  }
  return tests;
}

double cpu_s() {
  return static_cast<double>(std::clock()) / CLOCKS_PER_SEC;
}

} // namespace

TEST(MaterialFit, bending_is_found_within_15_percent_from_noisy_silhouettes_of_another_mesh) {
  if (!std::getenv("SLOPER_VALIDATION"))
    GTEST_SKIP() << "slow: run it with make validation";
  set_thread_count(2);
  for (const auto& [preset, factor] : {std::pair{"cotton-poplin", 1.0},
                                       {"wool-suiting", 1.6},
                                       {"denim", 0.7},
                                       {"cotton-poplin", 0.6},
                                       {"jersey", 2.0},
                                       {"canvas", 0.5}}) {
    Material truth = material_preset(preset);
    truth.bend_n_m *= factor;
    const FabricTests tests = tests_of_pictures(truth);
    const double began = cpu_s();
    const MaterialFit fit = fit_material(tests, silent_reporter());
    const double took = cpu_s() - began;
    ASSERT_TRUE(fit.mean) << preset << ": " << fit.cannot_tell.back();
    std::printf("[ FIGURE ] bending of %s, uN m: %.3g (sd %.2g) beside %.3g, %+.0f %%; coefficient "
                "%.1f %%, %d drapes, %.0f CPU s\n",
                preset, 1e6 * fit.mean->value, 1e6 * fit.mean->sd, 1e6 * truth.bend_n_m,
                100 * (fit.mean->value / truth.bend_n_m - 1), 100 * fit.coefficient,
                fit.simulations, took);
    EXPECT_NEAR(fit.mean->value / truth.bend_n_m, 1, 0.15) << preset;
    EXPECT_LT(took, 60) << preset;
  }
  set_thread_count(1);
}

TEST(MaterialFit, says_that_silhouettes_of_cloth_as_stiff_as_card_cannot_tell) {
  if (!std::getenv("SLOPER_VALIDATION"))
    GTEST_SKIP() << "slow: run it with make validation";
  Material truth = material_preset("canvas");
  truth.bend_n_m *= 10;
  const double began = cpu_s();
  const MaterialFit fit = fit_material(tests_of_pictures(truth), silent_reporter());
  std::printf("[ FIGURE ] card: %.0f CPU s: %s\n", cpu_s() - began,
              fit.cannot_tell.empty() ? "decided" : fit.cannot_tell.back().c_str());
  EXPECT_FALSE(fit.from_drape);
  EXPECT_FALSE(fit.cannot_tell.empty());
}

TEST(MaterialFit, says_so_where_overhang_and_drape_contradict_each_other) {
  FabricTests tests;
  tests.base = material_preset("cotton-poplin");
  tests.setup.edge_m = 0.015;
  tests.shear_error = 0;
  tests.overhang_m[0] = tests.overhang_m[1] = {0.07, 0.07, 0.071};
  tests.coefficient = {0.72, 0.74, 0.73, 0.72};
  const MaterialFit fit = fit_material(tests, silent_reporter());
  EXPECT_FALSE(fit.contradiction.empty());
  EXPECT_NEAR(fit.material.bend_n_m, 0.12 * 9.80665 * std::pow(0.5 * 0.211 / 3, 3), 1e-9);
}

TEST(MaterialFit, ends_where_softer_cloth_drapes_no_softer_and_names_no_coefficient_of_the_model) {
  // It went on softer and softer for 28 drapes and more than 60 CPU seconds, and wrote 0 %.
  FabricTests tests;
  tests.base = material_preset("cotton-poplin");
  tests.setup.edge_m = 0.018;
  tests.coefficient = {0.2, 0.22};
  const MaterialFit fit = fit_material(tests, silent_reporter());
  EXPECT_FALSE(fit.from_drape);
  EXPECT_LE(fit.simulations, 16);
  ASSERT_FALSE(fit.cannot_tell.empty());
  EXPECT_NE(fit.cannot_tell.back().find("is below what any cloth"), std::string::npos)
      << fit.cannot_tell.back();
  const io::Json document = material_fit_json(fit, tests, "test");
  EXPECT_FALSE(document["fit"]["coefficient_percent"].contains("model"));
  EXPECT_EQ(document["fit"]["coefficient_percent"]["drapes"], 2);
  EXPECT_FALSE(document["fit"].contains("folds"));
}

TEST(MaterialFit, what_nothing_can_have_is_refused) {
  FabricTests tests;
  tests.base = material_preset("silk");
  EXPECT_THROW(fit_material(tests, silent_reporter()), Error);
  tests.coefficient = {1.2};
  EXPECT_THROW(fit_material(tests, silent_reporter()), Error);
  tests.coefficient = {};
  tests.overhang_m[0] = {3.0};
  EXPECT_THROW(fit_material(tests, silent_reporter()), Error);
}
