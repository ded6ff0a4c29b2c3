/// A drape that was killed goes on from its last checkpoint to the same bytes as one that was not.
#include "drape_scene.hpp"

#include <base/error.hpp>
#include <base/parallel.hpp>
#include <filesystem>
#include <fstream>
#include <garment/drape_state.hpp>
#include <garment/garment_json.hpp>
#include <gtest/gtest.h>
#include <set>
#include <unistd.h>

using namespace sloper;
using namespace sloper::garment;

namespace {

/// Ends a run, as a kill does, at one of its steps: what it wrote until then is all that is left of it.
class Killer : public Reporter {
public:
  explicit Killer(int at_step) : m_left(at_step) {}
  bool stop_requested() const override { return m_left-- <= 0; }

private:
  mutable int m_left;
};

struct Case {
  const char* name;
  body::Body body;
  Garment garment;
};

Case drawn_in() { // starts inside the body
  Case c{"drawn_in", make_pillar(), make_skirt(0.75, 0.25, 0.04, 1.02, 0.06)};
  c.body.landmarks["hip_center"].p = Vec3(0, 0.2, 0);
  c.body.landmarks["neck_center"].p = Vec3(0, 1.2, 0);
  return c;
}

} // namespace

class CheckpointTest : public testing::Test {
protected:
  CheckpointTest() : m_folder(std::filesystem::temp_directory_path() / ("sloper-checkpoint-" + std::to_string(::getpid()))) {
    std::filesystem::create_directories(m_folder);
  }
  ~CheckpointTest() override { std::filesystem::remove_all(m_folder); }
  std::string file(const std::string& name) const { return (m_folder / name).string(); }
  std::string text(const Garment& garment) const {
    const GarmentText t = garment_text(garment, "g.obj", "test");
    return io::to_text(t.document) + t.mesh;
  }

private:
  std::filesystem::path m_folder;
};

TEST_F(CheckpointTest, a_run_killed_at_any_step_goes_on_to_the_bytes_of_one_that_was_not) {
  DrapeSettings settings;
  for (const Case& c : {Case{"sewn", make_pillar(), make_skirt(0.75, 0.25, 0.04)}, drawn_in()}) {
    Garment whole = c.garment;
    const DrapeReport undisturbed = drape(whole, &c.body, settings, silent_reporter(), {}, {file("whole.json"), 17});
    EXPECT_TRUE(undisturbed.converged) << undisturbed.stop_reason;
    std::set<DrapePhase> phases;
    for (int at = 20; at < undisturbed.steps; at += std::max(5, undisturbed.steps / 4)) {
      Garment killed = c.garment;
      Killer killer(at);
      drape(killed, &c.body, settings, killer, {}, {file("killed.json"), 17});
      phases.insert(read_checkpoint(file("killed.json")).state.phase);
      Garment resumed;
      set_thread_count(1 + at % 2);
      const DrapeReport report = resume_drape(file("killed.json"), resumed, &c.body, silent_reporter());
      set_thread_count(1);
      EXPECT_EQ(text(resumed), text(whole)) << c.name << " killed at step " << at << " of " << undisturbed.steps;
      EXPECT_EQ(report.steps, undisturbed.steps);
      EXPECT_EQ(report.repairs, undisturbed.repairs);
      EXPECT_EQ(report.solver, undisturbed.solver);
      for (std::size_t k = 0; k < report.effects.size(); ++k) EXPECT_EQ(report.effects[k].calls, undisturbed.effects[k].calls) << report.effects[k].name;
    }
    EXPECT_TRUE(phases.count(DrapePhase::SETTLE) && phases.count(c.name == std::string("sewn") ? DrapePhase::SEW : DrapePhase::INFLATE)) << c.name;
  }
}

TEST_F(CheckpointTest, a_run_that_was_resumed_can_be_killed_and_resumed_again) {
  const Case c{"", make_pillar(), make_skirt(0.75, 0.3, 0.04)};
  Garment whole = c.garment, killed = c.garment;
  const DrapeReport undisturbed = drape(whole, &c.body, {}, silent_reporter(), {}, {file("whole.json"), 10});
  Killer first(25);
  drape(killed, &c.body, {}, first, {}, {file("run.json"), 10});
  for (int times = 0; times < 2; ++times) {
    Killer again(25);
    resume_drape(file("run.json"), killed, &c.body, again, file("run.json"));
  }
  Garment resumed;
  EXPECT_EQ(read_checkpoint(file("run.json")).report.steps, 60);
  EXPECT_EQ(resume_drape(file("run.json"), resumed, &c.body, silent_reporter()).steps, undisturbed.steps);
  EXPECT_EQ(text(resumed), text(whole));
}

TEST_F(CheckpointTest, a_checkpoint_of_another_body_or_a_damaged_one_is_refused) {
  const body::Body pillar = make_pillar();
  Garment skirt = make_skirt(0.75, 0.3, 0.04);
  skirt.body_sha256 = "this body";
  DrapeSettings settings;
  settings.max_steps = 12;
  drape(skirt, &pillar, settings, silent_reporter(), {}, {file("run.json"), 5});
  Garment resumed;
  EXPECT_THROW(resume_drape(file("run.json"), resumed, nullptr, silent_reporter()), Error);
  resumed.body_sha256 = "another body";
  EXPECT_THROW(resume_drape(file("run.json"), resumed, &pillar, silent_reporter()), Error);
  const std::string whole = io::to_text(io::read_json(file("run.json")));
  for (const char* from : {"\"phase\": \"sew\"", "\"every_steps\": 5", "\"latest\": 0"}) {
    std::string damaged = whole;
    ASSERT_NE(damaged.find(from), std::string::npos) << from;
    const std::string key(from, std::string(from).find(':'));
    damaged.replace(damaged.find(from), std::string(from).size(), key + ": \"?\"");
    std::ofstream(file("damaged.json")) << damaged;
    resumed = {};
    EXPECT_THROW(resume_drape(file("damaged.json"), resumed, &pillar, silent_reporter()), Error) << from;
  }
  std::string unknown = whole;
  unknown.replace(unknown.find("settle_force_ratio"), 1, "n");
  std::ofstream(file("damaged.json")) << unknown;
  try {
    read_checkpoint(file("damaged.json"));
    FAIL() << "a knob that nobody knows was read";
  } catch (const Error& e) {
    EXPECT_EQ(e.kind(), ErrorKind::INPUT);
    EXPECT_NE(std::string(e.what()).find("/settings/nettle_force_ratio"), std::string::npos) << e.what();
  }
  std::ofstream(file("damaged.json")) << whole.substr(0, whole.size() / 2);
  EXPECT_THROW(resume_drape(file("damaged.json"), resumed, &pillar, silent_reporter()), Error);
}
