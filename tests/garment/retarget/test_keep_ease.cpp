/// The ease that keep-fit keeps: what threads of a limb are lengthened by.
#include <garment/retarget/keep_ease.hpp>

#include <gtest/gtest.h>

using namespace sloper;
using namespace sloper::garment;

namespace {

/// A square of 10 cm on a frame, its weft along x and its warp along y.
Garment square_on(const std::string& frame) {
  Garment g;
  g.position = {{0, 0.5, 0.1}, {0.1, 0.5, 0.1}, {0.1, 0.6, 0.1}, {0, 0.6, 0.1}};
  g.panels.pattern = {{0, 0}, {0.1, 0}, {0.1, 0.1}, {0, 0.1}};
  g.panels.placed = g.position;
  g.panels.triangles = {{0, 1, 2}, {0, 2, 3}};
  g.particle_of = {0, 1, 2, 3};
  pattern::PanelInfo panel;
  panel.n_vertices = 4;
  panel.n_triangles = 2;
  panel.grain = Vec2(0, 1);
  g.panels.panels = {panel};
  g.bind.frames = {frame};
  g.bind.particles.assign(4, {BindWeight{.frame = 0, .weight = 1, .theta = 0, .z = 0, .gap = 0}});
  return g;
}

EaseAtGirth girth(const std::string& limb, double along, double wanted, double has) {
  return {.name = "girth",
          .limb = limb,
          .center = Vec3(0, along, 0),
          .axis = Vec3::UnitY(),
          .ease_m = 0,
          .wanted_m = wanted,
          .has_m = has};
}

} // namespace

TEST(KeptEase, lengthens_the_threads_that_run_around_the_limb) {
  const auto longer =
      lengthening_for_ease(square_on("upper_arm_l"), {girth("arm_l", 0.5, 0.55, 0.5)});
  ASSERT_EQ(longer.size(), 2u);
  for (const Vec2& l : longer) {
    EXPECT_NEAR(l.x(), std::log(1.1), 1e-12);
    EXPECT_NEAR(l.y(), 0, 1e-12);
  }
}

TEST(KeptEase, is_linear_between_girths_and_leaves_other_limbs_alone) {
  const std::vector<EaseAtGirth> girths = {girth("arm_r", 0.45, 0.55, 0.5),
                                           girth("arm_r", 0.65, 0.5, 0.5)};
  const auto longer = lengthening_for_ease(square_on("forearm_r"), girths);
  // Mean height of the first triangle's corners is 0.533 m: 0.083 of 0.2 m from the lower girth.
  EXPECT_NEAR(longer[0].x(), std::log(1.1) * (1 - 0.25 / 3 / 0.2), 1e-12);
  EXPECT_EQ(lengthening_for_ease(square_on("forearm_l"), girths)[0], Vec2(0, 0));
}

TEST(KeptEase, of_a_bent_arm_runs_from_girth_to_girth) {
  EaseAtGirth upper = girth("arm_l", 0.4, 0.55, 0.5), wrist = girth("arm_l", 0.7, 0.5, 0.5);
  wrist.axis = Vec3(0, 0.5, std::sqrt(0.75)); // the forearm turns off by 60 degrees
  const auto longer = lengthening_for_ease(square_on("forearm_l"), {upper, wrist});
  // Mean height of the first triangle's corners is 0.533 m, of 0.4 to 0.7.
  EXPECT_NEAR(longer[0].x(), std::log(1.1) * (1 - (0.4 / 3) / 0.3), 1e-12);
}

TEST(KeptEase, that_changed_is_told_where_it_is_more_than_its_uncertainty) {
  const auto row = [](const std::string& name, double ease, std::optional<double> before) {
    FitRow r;
    r.name = name;
    r.ease_m = ease;
    r.source_ease_m = before;
    return r;
  };
  FitRow unsure = row("waist_semantic", 0.15, 0.08);
  unsure.ease_uncertainty_m = 0.04;
  FitReport fit;
  fit.rows = {row("hip", 0.08, 0.07), row("bust", 0.15, 0.08), unsure,
              row("thigh_l", 0.5, std::nullopt)};
  EXPECT_EQ(changed_ease_text(fit),
            "has 7.0 cm more ease at the bust than on the body that it comes from: 15.0 cm, there "
            "8.0 cm");
  fit.rows = {row("hip", 0.08, 0.07)};
  EXPECT_EQ(changed_ease_text(fit), "");
}
