#include <sloper/garment/fit/slid_down.hpp>
#include <sloper/io/json.hpp>

#include <gtest/gtest.h>

namespace sloper::garment {

namespace {

/// A waistband of 6 cm that was placed at 1.06 m and hangs lower, over a skirt placed below it.
Garment skirt_that_sank(double by, pattern::Placement placement) {
  Garment g;
  g.panels.placement = placement;
  for (int k = 0; k < 2; ++k) {
    pattern::PanelInfo panel;
    panel.name = k ? "skirt" : "band";
    panel.part = "lower_body";
    panel.first_vertex = 4 * k;
    panel.n_vertices = 4;
    const double top = k ? 1.0 : 1.06;
    for (const double y : {top, top, top - 0.06, top - 0.06}) {
      g.particle_of.push_back(std::ssize(g.position));
      g.panels.placed.emplace_back(0, y, 0);
      g.position.emplace_back(0, y - (k ? 2 * by : by), 0);
    }
    g.panels.panels.push_back(panel);
  }
  return g;
}

struct SlideJudged {
  std::vector<Message> findings;
  DrapeReport report;
};

/// On a body whose crotch is at 80 cm.
SlideJudged judged_slide(Garment garment, bool at_rest, bool draped) {
  body::Body body;
  body.landmarks["crotch"].p = Vec3(0, 0.8, 0);
  DrapeOutcome outcome;
  garment.converged = outcome.report.converged = at_rest;
  outcome.report.stop_reason = at_rest ? StopReason::AT_REST : StopReason::STEP_LIMIT;
  outcome.document = {{"converged", at_rest}, {"stop_reason", stop_text(outcome.report)}};
  SlideJudged result;
  judge_slid_down(garment, body, outcome, {"in/skirt.json", "ben.json", "", draped},
                  result.findings, silent_reporter());
  EXPECT_EQ(garment.converged, outcome.report.converged);
  EXPECT_EQ(outcome.document["converged"], outcome.report.converged);
  EXPECT_EQ(outcome.document["stop_reason"], stop_text(outcome.report));
  result.report = outcome.report;
  return result;
}

} // namespace

TEST(slid_down, a_waistband_that_ended_around_the_thighs_has_failed_and_is_told_with_centimetres) {
  const SlideJudged fell =
      judged_slide(skirt_that_sank(0.43, pattern::Placement::BODY), true, false);
  ASSERT_EQ(fell.findings.size(), 1U);
  EXPECT_EQ(fell.findings[0].id, "drape.slid-down");
  EXPECT_NE(fell.findings[0].text.find("skirt.json on ben.json: its upper edge hangs at 63"),
            std::string::npos)
      << fell.findings[0].text;
  EXPECT_FALSE(fell.report.converged);
  EXPECT_EQ(stop_text(fell.report), "the garment slides down too far to fit");
}

TEST(slid_down, what_hangs_loosely_on_the_hips_is_told_and_may_be_meant_so) {
  const SlideJudged loose =
      judged_slide(skirt_that_sank(0.255, pattern::Placement::BODY), true, false);
  EXPECT_EQ(loose.findings.size(), 1U);
  EXPECT_TRUE(loose.report.converged);
}

TEST(slid_down, what_hangs_where_it_was_placed_and_what_does_not_rest_are_not_told) {
  const Garment sank = skirt_that_sank(0.43, pattern::Placement::BODY);
  for (const SlideJudged& other :
       {judged_slide(skirt_that_sank(0.1, pattern::Placement::BODY), true, false),
        judged_slide(skirt_that_sank(0.43, pattern::Placement::STATED), true, false),
        judged_slide(sank, true, true)}) {
    EXPECT_TRUE(other.findings.empty());
    EXPECT_TRUE(other.report.converged);
  }
  EXPECT_TRUE(judged_slide(sank, false, false).findings.empty()) << "another finding tells of it";
}

} // namespace sloper::garment
