#include <sloper/garment/drape/judge_faults.hpp>
#include <sloper/io/json.hpp>

#include <gtest/gtest.h>

namespace sloper::garment {

namespace {

struct Ended {
  Garment garment;
  DrapeOutcome outcome;
};

/// A drape that has ended. @param faults  of its panels
Ended ended(bool at_rest, const std::vector<std::string>& faults) {
  Ended e;
  e.garment.panels.faults = faults;
  e.garment.converged = e.outcome.report.converged = at_rest;
  e.outcome.report.stop_reason = at_rest ? StopReason::AT_REST : StopReason::STEP_LIMIT;
  e.outcome.report.steps = 40;
  e.outcome.document = {{"converged", at_rest}, {"stop_reason", stop_text(e.outcome.report)}};
  judge_faults(e.garment, e.outcome);
  EXPECT_EQ(e.garment.converged, e.outcome.report.converged);
  EXPECT_EQ(e.outcome.document["converged"], e.outcome.report.converged);
  EXPECT_EQ(e.outcome.document["stop_reason"], stop_text(e.outcome.report));
  return e;
}

} // namespace

TEST(judge_faults, what_rests_still_on_panels_that_are_half_sewn_has_failed) {
  const Ended half = ended(true, {"sleeve: half of it is open", "front: is below the floor"});
  EXPECT_FALSE(half.outcome.report.converged);
  EXPECT_EQ(stop_text(half.outcome.report),
            "at rest, but its panels are at fault: sleeve: half of it is open");
  const Message warning = not_done(half.outcome.report, "shirt.json");
  EXPECT_EQ(warning.id, "drape.panels-at-fault");
  EXPECT_NE(warning.text.find("--accept-faults"), std::string::npos) << warning.text;
}

TEST(judge_faults, a_drape_without_a_rest_and_one_of_sound_panels_end_as_they_ended) {
  const Ended tossed = ended(false, {"sleeve: half of it is open"});
  EXPECT_EQ(tossed.outcome.report.stop_reason, StopReason::STEP_LIMIT);
  EXPECT_EQ(not_done(tossed.outcome.report, "shirt.json").id, "drape.not-at-rest");
  EXPECT_TRUE(ended(true, {}).outcome.report.converged);
}

} // namespace sloper::garment
