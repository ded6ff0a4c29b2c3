#include <support/shapes.hpp>
#include <support/skin_garment.hpp>

#include <garment/bind/body_sides.hpp>
#include <garment/retarget/pattern_mirror.hpp>
#include <garment/retarget/retarget_grade.hpp>
#include <sloper/base/error.hpp>
#include <sloper/garment/bind/bind.hpp>
#include <sloper/garment/drape/drape.hpp>
#include <sloper/garment/fit/fit.hpp>
#include <sloper/garment/retarget/retarget.hpp>
#include <sloper/garment/retarget/retarget_pattern.hpp>
#include <sloper/io/json.hpp>
#include <sloper/pattern/mesh/mesh_pattern.hpp>
#include <sloper/pattern/read/read_pattern.hpp>

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

/// A tube of two panels around a vertical axis, sewn at both sides: pattern coordinates are true
/// lengths.
Garment sewn_tube(double radius, double length, double y) {
  Garment g;
  const int n = 24, rows = 12;
  for (int r = 0; r <= rows; ++r)
    for (int c = 0; c < 2 * n; ++c)
      g.position.emplace_back(radius * std::sin(M_PI * c / n), y + length * r / rows,
                              radius * std::cos(M_PI * c / n));
  for (int side = 0; side < 2; ++side) {
    pattern::PanelInfo p;
    p.name = side ? "back" : "front";
    p.first_vertex = static_cast<int>(g.panels.pattern.size());
    p.first_triangle = static_cast<int>(g.panels.triangles.size());
    const auto id = [&](int r, int c) { return p.first_vertex + r * (n + 1) + c; };
    for (int r = 0; r <= rows; ++r)
      for (int c = 0; c <= n; ++c) {
        g.panels.pattern.emplace_back(M_PI * radius * c / n, length * r / rows);
        g.panels.ids.push_back({side, static_cast<double>(c) / n, static_cast<double>(r) / rows});
        g.particle_of.push_back(r * 2 * n + (side * n + c) % (2 * n));
      }
    for (int r = 0; r < rows; ++r)
      for (int c = 0; c < n; ++c) {
        g.panels.triangles.push_back({id(r, c), id(r, c + 1), id(r + 1, c + 1)});
        g.panels.triangles.push_back({id(r, c), id(r + 1, c + 1), id(r + 1, c)});
      }
    for (int c = 0; c < n; ++c)
      p.outline.push_back(id(0, c));
    for (int r = 0; r < rows; ++r)
      p.outline.push_back(id(r, n));
    for (int c = n; c > 0; --c)
      p.outline.push_back(id(rows, c));
    for (int r = rows; r > 0; --r)
      p.outline.push_back(id(r, 0));
    p.n_vertices = static_cast<int>(g.panels.pattern.size()) - p.first_vertex;
    p.n_triangles = static_cast<int>(g.panels.triangles.size()) - p.first_triangle;
    g.panels.panels.push_back(p);
  }
  for (int side = 0; side < 2; ++side) {
    pattern::MeshSeam seam;
    seam.name = side ? "left" : "right";
    seam.kind = "seam";
    for (int r = 0; r <= rows; ++r) {
      seam.a.push_back(g.panels.panels[0].first_vertex + r * (n + 1) + (side ? 0 : n));
      seam.b.push_back(g.panels.panels[1].first_vertex + r * (n + 1) + (side ? n : 0));
    }
    g.panels.seams.push_back(seam);
  }
  for (std::size_t v = 0; v < g.particle_of.size(); ++v)
    g.panels.placed.push_back(g.position[g.particle_of[v]]);
  return g;
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

/// A sewn tube of rest radius `radius` that is held open to `open` at all heights.
Garment tube_around(double radius, double length, double y, double open) {
  Garment g = sewn_tube(radius, length, y);
  for (Vec3& p : g.position) {
    p.x() *= open / radius;
    p.z() *= open / radius;
  }
  return g;
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
  settle_shape(x, g.position, g.particle_triangles(), skin, 0.003);
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
    settle_shape(x, g.position, g.particle_triangles(), skin, 0.003,
                 held ? end : std::vector<int>());
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
    settle_shape(x, g.position, g.particle_triangles(), skin, 0.003);
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

TEST(regrade, cloth_that_keeps_its_shape_keeps_its_pattern) {
  const Garment g = sewn_tube(0.15, 0.4, 0.6);
  Garment graded = g;
  regrade(graded, g.position, g.position);
  for (std::size_t v = 0; v < g.panels.pattern.size(); ++v)
    EXPECT_LT((graded.panels.pattern[v] - g.panels.pattern[v]).norm(), 1e-6);
}

TEST(regrade, a_tube_around_a_wider_body_is_made_wider_and_not_longer) {
  const Garment g = sewn_tube(0.15, 0.4, 0.6);
  Garment graded = g;
  std::vector<Vec3> after = g.position;
  for (Vec3& p : after) {
    p.x() *= 1.2;
    p.z() *= 1.2;
  }
  regrade(graded, g.position, after);
  const pattern::Pattern before_pattern = pattern_of(g, g), after_pattern = pattern_of(graded, g);
  ASSERT_EQ(before_pattern.panels.size(), 2u);
  ASSERT_EQ(before_pattern.panels[0].n_edges(), 4);
  for (int e = 0; e < 4; ++e) {
    const double a = pattern::length(before_pattern.panels[0].edge(e).path),
                 b = pattern::length(after_pattern.panels[0].edge(e).path);
    EXPECT_NEAR(b / a, e % 2 == 0 ? 1.2 : 1.0, 0.002) << e;
  }
}

/// A body that widens by 6 % over the top 6 cm of the tube, as ribs do above a waist.
std::vector<Vec3> flared_at_the_top(const Garment& g) {
  std::vector<Vec3> after = g.position;
  for (Vec3& p : after) {
    const double wider = 1 + 0.06 * std::max(0.0, (p.y() - 0.94) / 0.06);
    p.x() *= wider;
    p.z() *= wider;
  }
  return after;
}

TEST(regrade, every_level_takes_its_own_girth_up_to_the_edge) {
  Garment g = sewn_tube(0.15, 0.4, 0.6);
  for (Vec3& p : g.position)
    p = Vec3(-p.z(), p.y(), p.x()); // its seams lie at the sides
  Garment graded = g;
  const std::vector<Vec3> after = flared_at_the_top(g);
  regrade(graded, g.position, after);
  const int n = 24, rows = 12;
  for (int r = 0; r <= rows; ++r) {
    double rest = 0, wanted = 0;
    for (int side = 0; side < 2; ++side)
      for (int c = 0; c < n; ++c) {
        const int v = g.panels.panels[side].first_vertex + r * (n + 1) + c;
        rest += (graded.panels.pattern[v + 1] - graded.panels.pattern[v]).norm();
        wanted += (after[g.particle_of[v + 1]] - after[g.particle_of[v]]).norm();
      }
    EXPECT_NEAR(rest / wanted, 1, 0.025) << "row " << r;
  }
}

/// Around the tube, at each of its rows, what is cut over what was cut.
std::vector<double> widths_over(const Garment& graded, const Garment& before) {
  std::vector<double> widths;
  const int n = 24, rows = 12;
  for (int r = 0; r <= rows; ++r) {
    double is = 0, was = 0;
    for (const pattern::PanelInfo& panel : before.panels.panels)
      for (int c = 0; c < n; ++c) {
        const int v = panel.first_vertex + r * (n + 1) + c;
        is += (graded.panels.pattern[v + 1] - graded.panels.pattern[v]).norm();
        was += (before.panels.pattern[v + 1] - before.panels.pattern[v]).norm();
      }
    widths.push_back(is / was);
  }
  return widths;
}

TEST(widen_strained_pieces, cloth_is_cut_wider_where_it_came_to_be_stretched_and_nowhere_else) {
  const Garment source = sewn_tube(0.15, 0.4, 0.6);
  Retargeted worn;
  worn.garment = source;
  const auto wider = [](double y) { return 1 + 0.08 * std::exp(-std::pow((y - 0.8) / 0.05, 2)); };
  for (Vec3& p : worn.garment.position) {
    p.x() *= wider(p.y());
    p.z() *= wider(p.y());
  }
  worn.garment.converged = true;
  widen_strained_pieces(worn, source, body::Body());
  EXPECT_FALSE(worn.garment.converged);
  EXPECT_EQ(worn.report.gradings, 1);
  const std::vector<double> widths = widths_over(worn.garment, source);
  Garment as_wide = source;
  regrade(as_wide, source.position, worn.garment.position);
  EXPECT_GT(widths[6], widths_over(as_wide, source)[6] +
                           0.03); // by what it is stretched, and what flat panels with straight
                                  // seams take of twice that
  EXPECT_NEAR(widths[0], 1, 0.005);
  EXPECT_NEAR(widths[12], 1, 0.005);
}

TEST(widen_strained_pieces, cloth_that_was_tight_on_its_first_body_is_not_cut_as_tight_again) {
  const Garment source = [] {
    Garment g = sewn_tube(0.15, 0.4, 0.6);
    for (Vec3& p : g.position) {
      p.x() *= 1.04;
      p.z() *= 1.04;
    }
    return g;
  }();
  Retargeted worn;
  worn.garment = source;
  widen_strained_pieces(worn, source, body::Body());
  for (const double w : widths_over(worn.garment, source))
    EXPECT_NEAR(w, std::pow(1.04 / 1.01, 3), 0.003);
}

TEST(widen_strained_pieces, cloth_that_nothing_stretches_keeps_its_pattern) {
  const Garment source = sewn_tube(0.15, 0.4, 0.6);
  Retargeted worn;
  worn.garment = source;
  widen_strained_pieces(worn, source, body::Body());
  for (const double w : widths_over(worn.garment, source))
    EXPECT_NEAR(w, 1, 0.001);
}

TEST(regrade, a_straight_seam_between_mirror_images_stays_straight) {
  Garment g = sewn_tube(
      0.15, 0.4,
      0.6); // its seams lie at the front and at the back; the second one is left open and gives way
  g.panels.seams.pop_back();
  Garment graded = g;
  regrade(graded, g.position, flared_at_the_top(g));
  for (const pattern::MeshSeam& seam : graded.panels.seams)
    for (const std::vector<int>& run : {seam.a, seam.b})
      for (const int v : run)
        EXPECT_NEAR(graded.panels.pattern[v].x(), graded.panels.pattern[run.front()].x(), 1e-3)
            << seam.name;
}

TEST(regrade, seams_stay_as_long_on_both_sides) {
  const Garment g = sewn_tube(0.15, 0.4, 0.6);
  Garment graded = g;
  std::vector<Vec3> after = g.position;
  for (Vec3& p : after)
    p.x() *= 1 + 0.5 * (p.y() - 0.6); // a flare
  const GradeReport report = regrade(graded, g.position, after);
  for (const pattern::MeshSeam& seam : graded.panels.seams)
    EXPECT_NEAR(seam.length_a, seam.length_b, 5e-5);
  EXPECT_LT(report.largest_seam_change_m, 5e-5);
  EXPECT_TRUE(report.findings.empty());
}

TEST(regrade, a_gathered_seam_keeps_its_ratio_where_the_body_is_lopsided) {
  Garment g = sewn_tube(0.15, 0.4, 0.6);
  for (int v = g.panels.panels[1].first_vertex; v < std::ssize(g.panels.pattern); ++v)
    g.panels.pattern[v].y() *= 1.25; // gathered
  Garment graded = g;
  std::vector<Vec3> after = g.position;
  for (Vec3& p : after) {
    p.y() = 0.6 + (p.y() - 0.6) * (1.1 + p.x());
    p.x() *= p.x() > 0 ? 1.3 : 1.05;
  }
  regrade(graded, g.position, after);
  for (const pattern::MeshSeam& seam : graded.panels.seams) {
    EXPECT_NEAR(seam.length_b / seam.length_a, 1.25, 2e-4) << seam.name;
    EXPECT_GT(seam.length_a, 0.41) << seam.name;
  }
}

TEST(regrade, mirror_images_are_found_by_shape_and_place) {
  const Garment g = sewn_tube(0.15, 0.4, 0.6);
  std::vector<Vec3> position;
  for (const int p : g.particle_of)
    position.push_back(g.position[p]);
  const std::vector<PanelMirror> mirrors = panel_mirrors(g.panels, position);
  ASSERT_EQ(mirrors.size(), 2u);
  EXPECT_EQ(mirrors[0].partner, 1); // the halves of the tube lie at x > 0 and x < 0
  EXPECT_EQ(mirrors[1].partner, 0);
  const Vec2 corner = mirrors[0].linear * Vec2(0, 0) + mirrors[0].shift;
  EXPECT_LT((corner - Vec2(M_PI * 0.15, 0)).norm(),
            1e-6); // turned over left to right, and not upside down
  // The other way about, each half is its own mirror image.
  for (Vec3& p : position)
    p = Vec3(-p.z(), p.y(), p.x());
  const std::vector<PanelMirror> own = panel_mirrors(g.panels, position);
  EXPECT_EQ(own[0].partner, 0);
  EXPECT_EQ(own[1].partner, 1);
}

TEST(regrade, what_was_alike_left_and_right_stays_so_on_a_lopsided_body) {
  const Garment g = sewn_tube(0.15, 0.4, 0.6);
  std::vector<Vec3> after = g.position;
  for (Vec3& p : after) {
    p.y() = 0.6 + (p.y() - 0.6) * (1 + 0.2 * p.x());
    p.x() *= p.x() > 0 ? 1.3 : 1.1;
  }
  Garment graded = g;
  EXPECT_EQ(regrade(graded, g.position, after).mirrored_panels, 2);
  const pattern::Pattern p = pattern_of(graded, g);
  const auto edge = [&](int panel, int e) { return pattern::length(p.panels[panel].edge(e).path); };
  for (const int e : {0, 2})
    EXPECT_NEAR(edge(0, e), edge(1, e), 2e-5) << e;
  EXPECT_NEAR(edge(0, 1), edge(1, 3), 2e-5);
  EXPECT_NEAR(edge(0, 3), edge(1, 1), 2e-5);
  EXPECT_GT(edge(0, 0), 1.05 * M_PI * 0.15);
  // Beyond what is graded alike the halves go apart, and that is said.
  graded = g;
  const GradeReport apart =
      regrade(graded, g.position, after,
              {{{"torso", "the left shoulder is 4.0 cm longer than the right one"}}});
  EXPECT_EQ(apart.mirrored_panels, 0);
  ASSERT_EQ(apart.findings.size(), 1u);
  EXPECT_NE(apart.findings[0].text.find("graded apart"), std::string::npos)
      << apart.findings[0].text;
  EXPECT_GT(graded.panels.seams.size(), 0u);
  const pattern::Pattern q = pattern_of(graded, g);
  EXPECT_GT(pattern::length(q.panels[0].edge(0).path),
            pattern::length(q.panels[1].edge(0).path) + 0.03);
}

TEST(regrade, a_longer_arm_is_told_and_an_even_body_is_not) {
  body::Body body = measured("f-165-a");
  EXPECT_TRUE(uneven_sides(body).empty()) << uneven_sides(body)[0].text;
  body.landmarks.at("wrist_l").p +=
      0.08 * (body.landmark("wrist_l") - body.landmark("elbow_l")).normalized();
  const std::vector<SideDifference> uneven = uneven_sides(body);
  ASSERT_EQ(uneven.size(), 1u);
  EXPECT_EQ(uneven[0].limb, "arm");
  EXPECT_EQ(uneven[0].text.rfind("the left arm is ", 0), 0u) << uneven[0].text;
}

TEST(retarget_pattern, outlines_and_seams_come_back_from_the_mesh) {
  const Garment g = sewn_tube(0.15, 0.4, 0.6);
  const pattern::Pattern p = pattern_of(g, g);
  ASSERT_EQ(p.seams.size(), 2u);
  for (const pattern::Seam& seam : p.seams) {
    ASSERT_EQ(seam.a.size(), 1u);
    EXPECT_NE(seam.a[0].panel, seam.b[0].panel);
    EXPECT_NEAR(pattern::side_length(p, seam.a), 0.4, 1e-9);
    EXPECT_NEAR(pattern::side_length(p, seam.b), 0.4, 1e-9);
  }
  std::vector<pattern::Path> loop;
  for (const pattern::PanelEdge& e : p.panels[0].loops[0])
    loop.push_back(e.path);
  EXPECT_NEAR(pattern::signed_area(loop), M_PI * 0.15 * 0.4, 1e-9);
  EXPECT_TRUE(p.findings.empty());
}

/// Two panels of 40 by 60 cm, meshed and not sewn; the back's side is sewn to the upper half of the
/// front's.
Garment drawn_panels() {
  const char* text =
      R"({"format": "pattern", "version": 1, "length_unit": "cm", "name": "apron", "panels": [
    {"name": "front", "label": "body", "place": {"part": "torso", "theta_deg": 20, "anchor": [20, 60], "height": 104}, "notches": [{"edge": "top", "at": 0.25}],
     "outline": [{"edge": "hem", "path": [["M", 0, 0], ["L", 40, 0]]}, {"edge": "side", "path": [["L", 40, 60]]}, {"edge": "top", "path": [["L", 30, 70],
     ["L", 0, 60]]}, {"edge": "other", "path": [["L", 0, 0]]}]},
    {"name": "back", "outline": [{"edge": "hem", "path": [["M", 0, 0], ["L", 40, 0]]}, {"edge": "side", "path": [["L", 40, 32]]}, {"edge": "top",
     "path": [["L", 0, 32]]}, {"edge": "other", "path": [["L", 0, 0]]}]}],
   "seams": [{"name": "half", "a": [{"panel": "front", "edge": "side", "from": 0.5, "to": 1}], "b": [{"panel": "back", "edge": "other", "from": 1, "to": 0}],
     "ease": "a little"}]})";
  Garment g;
  g.panels = pattern::mesh_pattern(pattern::read_pattern_json(io::Json::parse(text), "apron.json"),
                                   0.03, "apron.json");
  for (std::size_t v = 0; v < g.panels.pattern.size(); ++v) {
    g.particle_of.push_back(static_cast<int>(v));
    g.position.emplace_back(g.panels.pattern[v].x(), g.panels.pattern[v].y() + 0.5, 0.1);
  }
  return g;
}

TEST(retarget_pattern, edges_keep_their_names_and_panels_where_they_go) {
  const Garment before = drawn_panels();
  Garment after = before, twice = before;
  for (Vec2& p : after.panels.pattern)
    p.x() *= 1.1;
  for (Vec3& p : after.position)
    p.y() += 0.07;
  for (Vec2& p : twice.panels.pattern)
    p.x() *= 1.2;
  for (const pattern::Pattern& p :
       {pattern_of(after, before), pattern_of(twice, after)}) { // what was regraded before as well
    const pattern::Panel& front = p.panels[0];
    std::vector<std::string> names;
    for (const pattern::PanelEdge& e : front.loops[0])
      names.push_back(e.name);
    EXPECT_EQ(names, (std::vector<std::string>{"hem", "side_1", "side_2", "top", "other"}))
        << "a corner ends no edge";
    EXPECT_EQ(front.edge(p.seams[0].a[0].edge).name, "side_2");
    EXPECT_EQ(p.seams[0].ease, "a little");
    EXPECT_EQ(front.label, "body");
    EXPECT_EQ(front.hint.part, "torso");
    EXPECT_NEAR(front.hint.theta.value(), 20 * M_PI / 180, 1e-9);
    ASSERT_EQ(front.notches.size(), 1u);
    EXPECT_EQ(front.edge(front.notches[0].edge).name, "top");
  }
  const pattern::Panel front = pattern_of(after, before).panels[0];
  EXPECT_NEAR(front.hint.anchor->x(), 0.22, 0.003);
  EXPECT_NEAR(front.hint.height.value(), 0.6 + 0.07 + 0.5, 1e-6) << "where the cloth lies now";
  const pattern::ArcLength top(front.edge(front.notches[0].edge).path);
  const Vec2 notch = top.at(front.notches[0].at * top.length()),
             drawn = Vec2(0.4, 0.6) + 0.25 * (std::hypot(0.1, 0.1) + std::hypot(0.3, 0.1)) *
                                          Vec2(-1, 1).normalized();
  EXPECT_NEAR((notch - Vec2(1.1 * drawn.x(), drawn.y())).norm(), 0, 0.002);
}

TEST(retarget_pattern, a_garment_that_is_meshed_otherwise_than_its_pattern_has_edges_of_its_own) {
  Garment g = drawn_panels();
  g.panels.edge_length = 0.04;
  const pattern::Pattern p = pattern_of(g, g);
  EXPECT_EQ(p.panels[0].edge(0).name, "e0");
}

TEST(retarget_pattern, a_seam_inside_a_panel_is_told_and_left_out) {
  Garment g = sewn_tube(0.15, 0.4, 0.6);
  g.panels.seams[0].a = {30, 31, 32};
  g.panels.seams[0].b = {60, 61, 62};
  const pattern::Pattern p = pattern_of(g, g);
  EXPECT_EQ(p.seams.size(), 1u);
  EXPECT_EQ(p.findings.size(), 1u);
}

TEST(retarget_pattern, the_table_tells_what_grew) {
  const Garment g = sewn_tube(0.15, 0.4, 0.6);
  Garment wide = g;
  for (Vec2& p : wide.panels.pattern)
    p.x() *= 1.1;
  const std::string table = grade_table(pattern_of(g, g), pattern_of(wide, g));
  EXPECT_NE(table.find("width,front,,47.12,51.84,+4.71\r\n"), std::string::npos) << table;
  EXPECT_NE(table.find("height,front,,40.00,40.00,+0.00\r\n"), std::string::npos) << table;
}

} // namespace sloper::garment
