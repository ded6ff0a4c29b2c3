#include <support/skin_garment.hpp>

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
    panel.first_vertex = 4 * k, panel.n_vertices = 4, panel.first_triangle = 2 * k,
    panel.n_triangles = 2;
    for (const auto& [x, y] :
         {std::pair{0.0, 0.0}, std::pair{0.2, 0.0}, std::pair{0.2, 0.2}, std::pair{0.0, 0.2}}) {
      g.panels.pattern.emplace_back(x, y);
      g.particle_of.push_back(static_cast<int>(g.position.size()));
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
  std::vector<std::string> findings;
  judge_stretch(g, outcome, {"in/shirt.json", with_body ? "ben.json" : "", "", true}, other,
                findings, silent_reporter());
  EXPECT_EQ(g.converged, outcome.report.converged);
  EXPECT_EQ(outcome.document["converged"], outcome.report.converged);
  EXPECT_EQ(outcome.document["stop_reason"], stop_text(outcome.report));
  return {findings.empty() ? "" : findings[0], outcome.report.converged, stop_text(outcome.report)};
}

} // namespace

TEST(stretch, it_is_told_how_far_and_where) {
  const Stretch s = stretch_of(two_squares(0.2));
  EXPECT_NEAR(s.p99, 0.2, 1e-9);
  EXPECT_NEAR(s.max, 0.2, 1e-9);
  EXPECT_EQ(s.panel, "sleeve");
  EXPECT_GT(s.place.x(), 1);
  EXPECT_NEAR(stretch_of(two_squares(-0.2)).max, 0, 1e-9)
      << "what is pressed together is not stretched";
  Garment knit = two_squares(0.2);
  knit.materials[""] = material_preset("jersey");
  EXPECT_GT(stretch_of(knit).bound, 0.3);
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
