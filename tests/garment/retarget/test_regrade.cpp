#include <support/sewn_tube.hpp>
#include <support/skin_garment.hpp>

#include <garment/bind/body_sides.hpp>
#include <garment/retarget/pattern_mirror.hpp>
#include <garment/retarget/retarget_grade.hpp>
#include <sloper/garment/retarget/retarget.hpp>
#include <sloper/garment/retarget/retarget_pattern.hpp>

#include <gtest/gtest.h>

namespace sloper::garment {

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

/// The tube, as it hung so far from the skin of a torso.
Garment hung_tube(double gap) {
  Garment g = sewn_tube(0.15, 0.4, 0.6);
  for (Vec3& p : g.position)
    p = Vec3(-p.z(), p.y(), p.x()); // its seams lie at the sides
  g.bind.frames = {"torso"};
  g.bind.lengths_m = {1};
  g.bind.marks.resize(1);
  for (const Vec3& p : g.position)
    g.bind.particles.push_back(
        {{.frame = 0, .weight = 1, .theta = std::atan2(p.x(), p.z()), .z = p.y(), .gap = gap}});
  return g;
}

TEST(regrade, loose_cloth_takes_the_trend_of_the_levels_and_close_cloth_each_of_them) {
  // 5 % wider above than below, and 6 % more around one level
  const auto trend = [](double y) { return 1.05 + 0.125 * (y - 0.8); };
  const auto bump = [](double y) { return 0.06 * std::exp(-std::pow((y - 0.8) / 0.035, 2)); };
  for (const bool loose : {false, true}) {
    const Garment g = hung_tube(loose ? 0.04 : 0.004);
    std::vector<Vec3> after = g.position;
    for (Vec3& p : after) {
      const double wider = trend(p.y()) + bump(p.y());
      p.x() *= wider;
      p.z() *= wider;
    }
    Garment graded = g;
    regrade(graded, g.position, after);
    const std::vector<double> widths = widths_over(graded, g);
    for (int r = 0; r <= 12; ++r) {
      const double y = 0.6 + 0.4 * r / 12;
      if (loose) // the bump's area is spread over the levels
        EXPECT_NEAR(widths[r], trend(y) + 0.01, 0.014) << "row " << r;
      else
        EXPECT_NEAR(widths[r], trend(y) + bump(y), 0.02) << "row " << r;
    }
  }
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

} // namespace sloper::garment
