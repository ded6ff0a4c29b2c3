#include <support/skin_garment.hpp>

#include <sloper/garment/fit/cloth_strain.hpp>
#include <sloper/garment/fit/stretch.hpp>
#include <sloper/garment/materials.hpp>

#include <gtest/gtest.h>

namespace sloper::garment {

namespace {

/// Two squares of 20 cm side by side, the second one stretched along x.
Garment two_squares(double stretch) {
  Garment g;
  for (int k = 0; k < 2; ++k) {
    pattern::PanelInfo panel;
    panel.name = k ? "sleeve" : "front";
    panel.first_vertex = 4 * k;
    panel.n_vertices = 4;
    panel.first_triangle = 2 * k;
    panel.n_triangles = 2;
    for (const auto& [x, y] :
         {std::pair{0.0, 0.0}, std::pair{0.2, 0.0}, std::pair{0.2, 0.2}, std::pair{0.0, 0.2}}) {
      g.panels.pattern.emplace_back(x, y);
      g.particle_of.push_back(std::ssize(g.position));
      g.position.emplace_back(k + x * (k ? 1 + stretch : 1), 1 + y, 0);
    }
    g.panels.triangles.push_back({4 * k, 4 * k + 1, 4 * k + 2});
    g.panels.triangles.push_back({4 * k, 4 * k + 2, 4 * k + 3});
    g.panels.panels.push_back(panel);
  }
  g.converged = true;
  return g;
}

struct Judged {
  std::string finding;
  bool converged;
  std::string stop_reason;
};

/// @param other  its strain on another body
Judged judged(double stretch, std::optional<double> other, bool with_body = true) {
  Garment g = two_squares(stretch);
  DrapeOutcome outcome;
  outcome.report.converged = true;
  outcome.report.stop_reason = StopReason::AT_REST;
  outcome.report.quality = {{"particles_held", 3}};
  outcome.document = {{"converged", true}, {"stop_reason", "at rest"}};
  std::vector<Message> findings;
  judge_stretch(g, outcome, {"in/shirt.json", with_body ? "ben.json" : "", "", true}, other,
                findings, silent_reporter());
  EXPECT_EQ(g.converged, outcome.report.converged);
  EXPECT_EQ(outcome.document["converged"], outcome.report.converged);
  EXPECT_EQ(outcome.document["stop_reason"], stop_text(outcome.report));
  return {findings.empty() ? "" : findings[0].text, outcome.report.converged,
          stop_text(outcome.report)};
}

} // namespace

TEST(stretch, it_is_told_how_far_and_where) {
  const Stretch s = stretch_of(two_squares(0.2));
  EXPECT_NEAR(s.p99, 0.2, 1e-9);
  EXPECT_NEAR(s.max, 0.2, 1e-9);
  EXPECT_EQ(s.panel, "sleeve");
  EXPECT_GE(s.place.x(), 1);
  EXPECT_NEAR(stretch_of(two_squares(-0.2)).max, 0, 1e-9)
      << "what is pressed together is not stretched";
  Garment knit = two_squares(0.2);
  knit.materials[""] = material_preset("jersey");
  EXPECT_GT(stretch_of(knit).bound, 0.3);
}

TEST(stretch, gathered_triangles_are_not_stretched_and_the_fit_says_the_same) {
  Garment g = two_squares(0.3);
  const std::vector<TriangleStrain> tight = triangle_strains(g, g.position);
  const auto& at_seam = strains_around(g, tight, {0, 1, 2, 3});
  EXPECT_NEAR(stretch_of(g).max, at_seam.back().value(), 1e-12);
  for (std::size_t i = 4; i < g.position.size();
       ++i) // a gather: pressed to less than half its height
    g.position[i].y() = 1 + 0.4 * (g.position[i].y() - 1);
  EXPECT_NEAR(stretch_of(g).p99, 0, 1e-9);
  EXPECT_NEAR(stretch_of(g).max, 0, 1e-9);
  g.position = two_squares(0.3).position; // as far drawn out as pressed together, and a little more
  for (std::size_t i = 4; i < g.position.size(); ++i)
    g.position[i].y() = 1 + 0.75 * (g.position[i].y() - 1);
  EXPECT_NEAR(stretch_of(g).p99, 0.3, 1e-9);
}

TEST(stretch, one_place_is_told_though_the_rest_hangs_as_it_should) {
  for (const double stretch : {0.25, 0.36}) {
    Garment g = two_squares(0);
    pattern::PanelInfo patch;
    patch.name = "patch";
    patch.first_vertex = 8;
    patch.n_vertices = 3;
    patch.first_triangle = 4;
    patch.n_triangles = 1;
    for (const Vec2& p : {Vec2(0, 0), Vec2(0.01, 0), Vec2(0, 0.01)}) {
      g.panels.pattern.push_back(p);
      g.particle_of.push_back(std::ssize(g.position));
      g.position.emplace_back((1 + stretch) * p.x(), 2 + p.y(), 0);
    }
    g.panels.triangles.push_back({8, 9, 10});
    g.panels.panels.push_back(patch);
    const auto text = stretched_place(stretch_of(g));
    ASSERT_EQ(text.has_value(), stretch > 0.3);
    if (!text)
      continue;
    EXPECT_NE(text->find("stretched by 36 %, in panel patch at (0.0"), std::string::npos) << *text;
    EXPECT_NE(text->find("99 % of the cloth is by less than 0.0 %"), std::string::npos) << *text;
  }
  EXPECT_FALSE(stretched_place(stretch_of(two_squares(0.5)))) << "that is told as a whole";
}

TEST(stretch, where_it_hung_before_is_told_by_the_skin) {
  Garment g = two_squares(0.03);
  EXPECT_FALSE(stretch_elsewhere(g, "b")) << "panels hung on none";
  g.body_sha256 = "a";
  EXPECT_NEAR(stretch_elsewhere(g, "b").value(), 0.03, 1e-9);
  EXPECT_FALSE(stretch_elsewhere(g, "a"));
  EXPECT_FALSE(stretch_elsewhere(g, ""));
}

TEST(stretch, a_garment_of_another_body_that_ends_stretched_has_failed) {
  const Judged gross = judged(0.19, 0.02);
  EXPECT_FALSE(gross.converged);
  EXPECT_EQ(gross.stop_reason, "at rest, but stretched by 19 %, on its own body by 2.0 %");
  EXPECT_NE(gross.finding.find("retarget-garment --garment shirt.json --to ben.json"),
            std::string::npos)
      << gross.finding;
  EXPECT_NE(gross.finding.find("panel sleeve (19 %), at most by 19 % at (1."), std::string::npos)
      << gross.finding;
  EXPECT_NE(gross.finding.find("3 particles are caught"), std::string::npos) << gross.finding;
  EXPECT_TRUE(judged(0.04, 0.01).converged) << "woven cloth bears that";
  EXPECT_TRUE(judged(0.09, 0.066).converged) << "it was tight there too";
}

TEST(stretch, a_tight_garment_on_its_own_body_is_done_and_told_only_where_it_is_gross) {
  EXPECT_EQ(judged(0.066, {}).finding, "");
  const Judged gross = judged(0.19, {});
  EXPECT_TRUE(gross.converged);
  EXPECT_NE(gross.finding.find("in panel sleeve"), std::string::npos);
  EXPECT_EQ(judged(0.19, {}, false).finding, "") << "nothing to be worn by";
}

} // namespace sloper::garment
