#include <support/sewn_tube.hpp>
#include <support/shapes.hpp>
#include <support/skin_garment.hpp>

#include <sloper/base/error.hpp>
#include <sloper/garment/bind/bind.hpp>
#include <sloper/garment/drape/drape.hpp>
#include <sloper/garment/fit/fit.hpp>
#include <sloper/garment/retarget/retarget.hpp>

#include <gtest/gtest.h>

namespace sloper::garment {

namespace {

Garment bound(Garment g, const body::Body& body) {
  bind_garment(g, body);
  return g;
}

FitReport before_drape(const Garment& garment, const body::Body& to) {
  const collision::BodyCollider skin(to.skin);
  const Retargeted r = retarget(garment, to, skin, RetargetMode::KEEP_FABRIC, silent_reporter());
  return fit_before_drape(r.garment, garment.position, to, standard_fit_policy());
}

/// A closed surface of revolution about y from 0.1 to 1.1 m, of radius `radius(y)`.
template<class Radius> body::Body round_body(Radius radius) {
  const int rows = 100;
  std::vector<shapes::Ring> rings;
  for (int r = 0; r <= rows; ++r) {
    const double y = 0.1 + static_cast<double>(r) / rows;
    rings.push_back({y, radius(y), radius(y)});
  }
  body::Body body;
  body.skin = shapes::revolve(96, rings);
  shapes::close_ends(body.skin, 96, Vec3(0, 0.1, 0), Vec3(0, 1.1, 0));
  body.face_part.assign(body.skin.triangles.size(), body::Part::TORSO);
  return body;
}

} // namespace

TEST(retarget, a_placed_garment_is_cleared_of_the_skin) {
  const body::Body from = measured("f-165-a"), to = measured("m-178-a");
  const Garment g = bound(skin_shirt(from, 0.012), from);
  const collision::BodyCollider skin(to.skin);
  const Retargeted r = retarget(g, to, skin, RetargetMode::KEEP_FABRIC, silent_reporter());
  EXPECT_EQ(r.report.cleared.vertices_inside, 0);
  EXPECT_LT(r.report.cleared.faces_through, 20);
  EXPECT_LT(r.report.largest_move_m, 0.15);
  EXPECT_FALSE(r.garment.converged);
}

TEST(retarget, on_its_own_body_nothing_moves_but_out_of_the_contact_gap) {
  const body::Body body = measured("f-165-a");
  const Garment g = bound(skin_shirt(body, 0.012), body);
  const collision::BodyCollider skin(body.skin);
  const Retargeted r = retarget(g, body, skin, RetargetMode::KEEP_FABRIC, silent_reporter());
  EXPECT_EQ(r.report.placed.vertices_inside, r.report.cleared.vertices_inside);
  EXPECT_LT(r.report.largest_move_m, 0.01);
}

TEST(retarget, cloth_that_was_placed_too_long_slides_along_the_skin_to_its_own_length) {
  const Garment g = sewn_tube(0.15, 0.4, 0.6);
  const collision::BodyCollider skin(shapes::cylinder(0.148, -0.2, 1.6, 96));
  std::vector<Vec3> x = g.position;
  for (Vec3& p : x)
    p.y() = 0.8 + 1.1 * (p.y() - 0.8); // as on a longer limb, everywhere within reach of the skin
  settle_shape(x, {g.position, g.particle_triangles()}, skin, 0.003);
  double low = 1e300, high = -1e300;
  for (const Vec3& p : x) {
    low = std::min(low, p.y());
    high = std::max(high, p.y());
    EXPECT_GT(std::hypot(p.x(), p.z()), 0.148);
  }
  EXPECT_LT((high - low) / 0.4 - 1, 0.04); // a tenth, where the skin holds what is near it
}

TEST(retarget, cloth_that_is_held_at_its_end_does_not_slide_to_its_own_length) {
  const Garment g = sewn_tube(0.15, 0.4, 0.6);
  const collision::BodyCollider skin(shapes::cylinder(0.148, -0.2, 1.6, 96));
  std::vector<Vec3> placed = g.position;
  for (Vec3& p : placed)
    p.y() = 0.8 + 0.9 * (p.y() - 0.8); // as on a shorter limb
  std::vector<int> end;
  for (std::size_t i = 0; i < placed.size(); ++i)
    if (g.position[i].y() < 0.63)
      end.push_back(static_cast<int>(i));
  double shift[2] = {0, 0};
  for (const bool held : {false, true}) {
    std::vector<Vec3> x = placed;
    settle_shape(x, {g.position, g.particle_triangles(), held ? end : std::vector<int>()}, skin,
                 0.003);
    for (int i : end)
      shift[held] += (placed[i].y() - x[i].y()) / static_cast<double>(end.size());
  }
  EXPECT_GT(shift[0], 0.01);
  EXPECT_LT(std::abs(shift[1]), 0.003);
}

TEST(retarget, cloth_is_graded_as_near_to_the_skin_as_it_was_placed) {
  const collision::BodyCollider skin(shapes::cylinder(0.148, -0.2, 1.6, 96));
  for (const auto& [placed, wanted] :
       {std::pair{0.1495, 0.0015}, std::pair{0.147, 0.0015}, std::pair{0.156, 0.008}}) {
    const Garment g = sewn_tube(placed, 0.3, 0.6);
    std::vector<Vec3> x = g.position;
    settle_shape(x, {g.position, g.particle_triangles()}, skin, 0.003);
    x = as_near_as_placed(std::move(x), g.position, skin, 0.003);
    double mean = 0;
    for (const Vec3& p : x)
      mean += std::hypot(p.x(), p.z()) / static_cast<double>(x.size());
    EXPECT_NEAR(mean - 0.148, wanted, 5e-4) << placed;
  }
}

TEST(retarget, strain_is_waited_for_longer_where_no_girth_is_tight) {
  const body::Body body = measured("f-165-a");
  const FitPolicy policy = standard_fit_policy();
  const FitBounds loose =
      early_termination_bounds(policy, before_drape(bound(skin_shirt(body, 0.03), body), body));
  const FitBounds tight = early_termination_bounds(
      policy, before_drape(bound(skin_shirt(body, 0.004, 0.05), body), body));
  EXPECT_FALSE(loose.tight);
  EXPECT_TRUE(tight.tight);
  EXPECT_GT(tight.strain_p99, policy.strain_p99("top", ""));
  EXPECT_GT(tight.slip_m, policy.slip_m("top", ""));
}

TEST(retarget, a_tube_that_cannot_widen_is_given_up_or_at_rest_within_a_hundred_steps) {
  const body::Body pillar = round_body([](double) { return 0.165; });
  for (const bool tight : {true, false}) {
    Garment tube = tube_around(0.15, 0.2, 0.6, 0.17); // a tenth too narrow
    const DrapeReport report =
        drape(tube, &pillar, {}, silent_reporter(), {.bounds = {0.11, 0.0625, tight}});
    EXPECT_LE(report.steps, 100) << stop_text(report);
    EXPECT_NE(report.converged, report.misfit == Misfit::STAYS_STRETCHED);
  }
}

TEST(retarget, a_tube_that_starts_stretched_and_slides_to_where_it_is_wide_enough_is_not_given_up) {
  const body::Body waisted = round_body(
      [](double y) { return 0.13 + 0.6 * std::max(0.0, y - 0.7) + 0.6 * std::max(0.0, 0.5 - y); });
  for (const bool tight : {true, false}) {
    Garment tube = tube_around(0.15, 0.06, 0.75, 0.20); // a fifteenth to a third too narrow there
    const DrapeReport report =
        drape(tube, &waisted, {}, silent_reporter(), {.bounds = {1.0, 0.0625, tight}});
    EXPECT_EQ(report.misfit, Misfit::NONE) << report.steps << " steps";
    EXPECT_TRUE(report.converged) << stop_text(report);
  }
}

TEST(
    retarget,
    trousers_that_lack_a_twentieth_at_the_waist_are_refused_before_any_step_and_those_that_lack_a_hundredth_are_tried) {
  const body::Body body = measured("f-165-a");
  const collision::BodyCollider skin(body.skin);
  const FitPolicy policy = standard_fit_policy();
  for (const double lacks : {0.01, 0.06}) {
    const double gap = 0.004,
                 strain =
                     lacks + 2 * M_PI * gap /
                                 body.levels.at("waist_semantic").girth_m; // the gap made up for
    Garment g = bound(skin_trousers(body, gap), body);
    for (auto& scale : g.rest_scale)
      for (double& s : scale)
        s *= 1 - strain;
    const FitReport report = fit_before_drape(g, g.position, body, policy);
    EXPECT_TRUE(report.fits)
        << "as far as on the first body"; // it was stretched there, as an elastic band is
    std::vector<Vec3> unstretched = g.position;
    for (Vec3& p : unstretched)
      p *= 1 - strain;
    const FitReport again = fit_before_drape(g, unstretched, body, policy);
    EXPECT_EQ(again.fits, lacks < 0.03) << again.reason;
    EXPECT_EQ(again.reason.rfind("does not close at the ", 0) == 0, lacks > 0.03) << again.reason;
    EXPECT_EQ(again.reason.find(" unless it is stretched by ") != std::string::npos, lacks > 0.03)
        << again.reason;
    EXPECT_EQ(again.state, "placed");
  }
}

TEST(retarget, a_childs_shirt_on_a_large_man_does_not_close) {
  samples::Mannequin child, man;
  child.sex = "m";
  child.stature_m = 1.3;
  child.bmi = 17;
  man.sex = "m";
  man.stature_m = 1.9;
  man.bmi = 33;
  const body::Body from = measured(child), to = measured(man);
  const FitReport report = before_drape(bound(skin_shirt(from, 0.012), from), to);
  EXPECT_FALSE(report.fits);
  EXPECT_EQ(report.verdict, FitVerdict::TOO_SMALL);
  EXPECT_EQ(report.reason.rfind("does not close at the ", 0), 0u) << report.reason;
  EXPECT_LT(report.margin_m, -0.1);
}

TEST(retarget, a_shirt_of_the_right_size_is_not_refused_before_it_is_tried) {
  const body::Body from = measured("f-165-a"), to = measured("m-168-slim");
  EXPECT_TRUE(before_drape(bound(skin_shirt(from, 0.015), from), to).fits);
}

TEST(retarget, cloth_that_was_stretched_on_its_first_body_may_be_stretched_as_far_again) {
  const body::Body body = measured("f-165-a");
  const Garment g =
      bound(skin_shirt(body, 0.003, 0.2), body); // an elastic top: a fifth shorter at rest
  EXPECT_TRUE(before_drape(g, body).fits);
}

TEST(retarget, what_a_body_lacks_is_named) {
  const body::Body whole = measured("f-165-a"), armless = without_arms(whole);
  const Garment shirt = bound(skin_shirt(whole), whole), skirt = bound(tube_skirt(whole), whole);
  EXPECT_EQ(why_impossible(shirt, whole), "");
  EXPECT_NE(why_impossible(shirt, armless).find("arm"), std::string::npos);
  EXPECT_EQ(why_impossible(skirt, armless), "");
}

TEST(retarget, sleeves_between_arms_and_a_trunk_that_touch_are_named) {
  const body::Body whole = measured("f-165-a");
  const Garment shirt = bound(skin_shirt(whole), whole), skirt = bound(tube_skirt(whole), whole);
  EXPECT_EQ(why_stuck(shirt, whole), "");
  body::Body touching = whole;
  touching.landmarks.erase("axilla_r");
  EXPECT_EQ(why_stuck(shirt, touching).rfind("has a right sleeve", 0), 0u)
      << why_stuck(shirt, touching);
  EXPECT_EQ(why_stuck(skirt, touching), "");
}

TEST(retarget, trousers_on_a_torso_are_impossible) {
  const body::Body whole = measured("f-165-a");
  body::Body torso = without_arms(whole);
  std::vector<Triangle> faces;
  std::vector<body::Part> parts;
  for (std::size_t f = 0; f < torso.skin.triangles.size(); ++f)
    if (torso.face_part[f] == body::Part::TORSO) {
      faces.push_back(torso.skin.triangles[f]);
      parts.push_back(torso.face_part[f]);
    }
  torso.skin.triangles = faces;
  torso.face_part = parts;
  for (const char* name : {"leg_l", "leg_r", "lower_body", "head"})
    torso.frames.erase(name);
  for (const char* name : {"ankle_l", "ankle_r", "knee_l", "knee_r", "head_tip"})
    torso.landmarks.erase(name);
  EXPECT_NE(why_impossible(bound(skin_trousers(whole), whole), torso).find("leg_"),
            std::string::npos);
  const Garment top = bound(skin_garment(whole, {body::Part::TORSO}, whole.levels.at("hip").y,
                                         whole.landmark("axilla_l").y() - 0.02, 0.01),
                            whole);
  EXPECT_EQ(why_impossible(top, torso), "");
  torso.frames.clear();
  torso.landmarks.erase("hip_center");
  EXPECT_NE(why_impossible(top, torso), "");
}

} // namespace sloper::garment
