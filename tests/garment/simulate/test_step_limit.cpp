/// The limit of steps: a preset's may be passed while the cloth nears rest, a stated one never.
#include <gtest/gtest.h>
#include <sloper/garment/scene/scene.hpp>
#include <sloper/garment/sewing.hpp>
#include <sloper/garment/simulate/step_controller.hpp>
#include <sloper/io/json.hpp>
#include <support/drape_scene.hpp>

using namespace sloper;
using namespace sloper::garment;

namespace {

/// Steps that a falling skirt makes until its limit, when it is said to near rest or not.
int steps_made(const DrapeSettings& settings, bool nears_rest) {
  Garment skirt = make_skirt(0.8, 0.2, 0.1);
  weld(skirt, skirt.panels.placed);
  Telemetry telemetry(settings, silent_reporter());
  CollisionBody no_body(nullptr, 0, silent_reporter());
  SimulatedCloth cloth(skirt, settings, no_body, telemetry);
  cloth.choose_effects();
  cloth.build(false);
  StepController stepper(cloth, settings, telemetry);
  stepper.set_patient(nears_rest);
  while (stepper.advance({})) {}
  EXPECT_EQ(telemetry.report.stop_reason, StopReason::STEP_LIMIT);
  return telemetry.report.steps;
}

} // namespace

TEST(StepLimit, every_preset_lets_cloth_that_nears_rest_go_on_for_half_as_long_again) {
  for (const std::string& name : accuracy_names()) {
    const DrapeSettings settings = preset_settings(name);
    EXPECT_EQ(settings.extra_steps, settings.max_steps / 2) << name;
  }
}

TEST(StepLimit, a_stated_limit_allows_no_more_whatever_its_number) {
  for (const std::string& name : accuracy_names()) {
    DrapeSettings settings = preset_settings(name);
    set_knob(settings, "max_steps", settings.max_steps); // the preset's own, but stated
    EXPECT_EQ(settings.extra_steps, 0) << name;
    set_knob(settings, "time_step_s", 0.01);
    EXPECT_EQ(settings.extra_steps, 0) << name;
  }
  DrapeSettings other_knob = preset_settings("standard");
  set_knob(other_knob, "time_step_s=0.01");
  EXPECT_EQ(other_knob.extra_steps, other_knob.max_steps / 2);
}

TEST(StepLimit, extra_steps_are_made_only_near_rest) {
  DrapeSettings settings;
  settings.max_steps = 6;
  settings.extra_steps = 3;
  EXPECT_EQ(steps_made(settings, false), 6);
  EXPECT_EQ(steps_made(settings, true), 9);
  settings.extra_steps = 0;
  EXPECT_EQ(steps_made(settings, true), 6);
}

TEST(StepLimit, a_report_says_how_many_extra_steps_there_are) {
  EXPECT_EQ(settings_json(preset_settings("standard"))["extra_steps"], 750);
  DrapeSettings stated = preset_settings("standard");
  set_knob(stated, "max_steps=1500");
  EXPECT_EQ(settings_json(stated)["extra_steps"], 0);
}

TEST(TimeLimit, that_sewing_alone_used_up_is_told_from_one_that_ended_the_drape) {
  DrapeReport report;
  report.stop_reason = StopReason::TIME_LIMIT;
  report.settings.max_seconds = 2;
  report.phases = {{"prepare body", 0.1}, {"sew", 1.9}};
  EXPECT_EQ(stop_text(report), "time limit of 2.0 s, before the garment was sewn");
  report.phases = {{"sew coarse", 1.8}, {"carry to the mesh", 0.7}, {"settle", 0.1}};
  EXPECT_EQ(stop_text(report),
            "time limit of 2.0 s, which sewing alone used up (2.5 s): it is sewn, not draped");
  report.phases = {{"sew coarse", 0.8}, {"settle", 1.3}};
  EXPECT_EQ(stop_text(report), "time limit");
  report.phases = {{"settle", 2.1}}; // a retargeting sews nothing
  EXPECT_EQ(stop_text(report), "time limit");
}
