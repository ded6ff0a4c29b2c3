/// A drape that was killed goes on from its last checkpoint to the same bytes as one that was not.
#include <support/drape_scene.hpp>

#include <filesystem>
#include <fstream>
#include <garment/drape/layers.hpp>
#include <garment/drape/motion.hpp>
#include <gtest/gtest.h>
#include <set>
#include <sloper/base/error.hpp>
#include <sloper/base/parallel.hpp>
#include <sloper/garment/garment_json.hpp>
#include <sloper/garment/simulate/checkpoint.hpp>
#include <unistd.h>

using namespace sloper;
using namespace sloper::garment;

namespace {

/// Ends a run, as a kill does, at one of its steps: what it wrote until then is all that is left of
/// it.
class Killer : public Reporter {
public:
  explicit Killer(int at_step) : m_at(at_step) {}
  bool stop_requested() const override { return ++m_asked > m_at; }
  int asked() const { return m_asked; } ///< how often: steps, and frames of a motion

private:
  int m_at;
  mutable int m_asked = 0;
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

Case sleeve() { // its end is held while the body is inflated
  Case c = drawn_in();
  c.name = "sleeve";
  drape(c.garment, &c.body, {}, silent_reporter());
  c.garment.bind = bind_as_sleeve(c.garment, 0.8);
  for (Vec3& p : c.body.skin.positions) {
    p.x() *= 1.05;
    p.z() *= 1.05;
  }
  return c;
}

Case tucked() { // sheared against each other, panels are drawn through each other while they are
                // sewn; sheared half as far they come apart again
  Case c{"tucked", make_pillar(), make_skirt(0.75, 0.25, 0.04)};
  for (Vec3& p : c.garment.panels.placed)
    if (p.z() > 0)
      p += Vec3(1.3 * (p.y() - 0.9), 1.5 * p.x(), 0);
  return c;
}

Case dense() { // meets a coarser skin first, where the settings say so
  return {"dense", make_pillar(256, 240), make_skirt(0.75, 0.25, 0.04)};
}

Case swaying() { // a flared skirt: it goes with its inertia for a while
  return {"swaying", make_pillar(), make_skirt(0.74, 0.4, 0.04, 1.02, 0.25, 2)};
}

Case case_of(const std::string& name) {
  if (name == "drawn_in")
    return drawn_in();
  if (name == "sleeve")
    return sleeve();
  if (name == "tucked")
    return tucked();
  if (name == "dense")
    return dense();
  if (name == "swaying")
    return swaying();
  return {"sewn", make_pillar(), make_skirt(0.75, 0.25, 0.04)};
}

} // namespace

class CheckpointTest : public testing::Test {
protected:
  CheckpointTest()
      : m_folder(std::filesystem::temp_directory_path() /
                 ("sloper-checkpoint-" + std::to_string(::getpid()))) {
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

class KilledRun : public CheckpointTest, public testing::WithParamInterface<const char*> {};

TEST_P(KilledRun, goes_on_from_any_step_to_the_bytes_of_one_that_was_not_killed) {
  DrapeSettings settings;
  settings.skin_tolerance_m = 3e-4;
  const Case c = case_of(GetParam());
  const std::string name = GetParam();
  const bool tucked = name == "tucked";
  if (tucked)
    settings.max_steps = 300; // its knot is slow to come to rest
  Garment whole = c.garment;
  const DrapeReport undisturbed =
      drape(whole, &c.body, settings, silent_reporter(), {.checkpoints = {file("whole.json"), 17}});
  EXPECT_EQ(undisturbed.converged, !tucked) << stop_text(undisturbed);
  std::set<DrapePhase> phases;
  std::size_t tucks = 0, free = 0;
  for (int at = 20; at < undisturbed.steps;
       at += std::max(5, undisturbed.steps / (tucked || name == "swaying" ? 6 : 4))) {
    Garment killed = c.garment;
    Killer killer(at);
    drape(killed, &c.body, settings, killer, {.checkpoints = {file("killed.json"), 17}});
    const DrapeState state = read_checkpoint(file("killed.json")).state;
    phases.insert(state.phase);
    tucks += state.supports.tangles.size();
    free += state.settle.velocity.size();
    Garment resumed;
    set_thread_count(1 + at % 2);
    const DrapeReport report =
        resume_drape(file("killed.json"), resumed, &c.body, silent_reporter());
    set_thread_count(1);
    EXPECT_EQ(text(resumed), text(whole)) << "killed at step " << at << " of " << undisturbed.steps;
    EXPECT_EQ(report.steps, undisturbed.steps);
    EXPECT_EQ(report.repairs, undisturbed.repairs);
    EXPECT_EQ(report.solver, undisturbed.solver);
    for (std::size_t k = 0; k < report.effects.size(); ++k)
      EXPECT_EQ(report.effects[k].calls, undisturbed.effects[k].calls) << report.effects[k].name;
  }
  EXPECT_EQ(tucks > 0, tucked);
  EXPECT_TRUE(free > 0 || name != "swaying") << "killed in the middle of that";
  const bool inflates = name == "drawn_in" || name == "sleeve";
  EXPECT_TRUE(phases.count(DrapePhase::SETTLE) &&
              phases.count(inflates ? DrapePhase::INFLATE : DrapePhase::SEW));
}
INSTANTIATE_TEST_SUITE_P(starts, KilledRun,
                         testing::Values("sewn", "drawn_in", "sleeve", "tucked", "dense",
                                         "swaying"));

/// The judge extrapolates from what it saw before: a run that forgot it, or its bounds, would go on
/// for longer or for ever.
TEST_F(CheckpointTest, a_run_with_fit_bounds_is_ended_at_the_same_step_after_it_was_killed) {
  const body::Body pillar = make_pillar();
  struct Bounded {
    FitBounds bounds;
    double circumference;
    Misfit misfit;
  };
  for (const Bounded& b : {Bounded{{0.15, 0}, 0.95, Misfit::SLIDES_DOWN},
                           Bounded{{0.15, 0.05}, 0.56, Misfit::STAYS_STRETCHED}}) {
    Garment whole = make_skirt(b.circumference, 0.25, 0.04), killed = whole, resumed;
    const DrapeReport undisturbed =
        drape(whole, &pillar, {}, silent_reporter(),
              {.bounds = b.bounds, .checkpoints = {file("whole.json"), 10}});
    EXPECT_EQ(undisturbed.misfit, b.misfit);
    Killer killer(undisturbed.steps - 12);
    drape(killed, &pillar, {}, killer,
          {.bounds = b.bounds, .checkpoints = {file("killed.json"), 10}});
    const DrapeCheckpoint from = read_checkpoint(file("killed.json"));
    EXPECT_EQ(from.bounds.slip_m, b.bounds.slip_m);
    EXPECT_EQ(from.state.phase, DrapePhase::SETTLE);
    const DrapeReport report =
        resume_drape(file("killed.json"), resumed, &pillar, silent_reporter());
    EXPECT_EQ(report.misfit, b.misfit);
    EXPECT_EQ(report.stop_reason, StopReason::MISFIT);
    EXPECT_EQ(report.steps, undisturbed.steps);
    EXPECT_EQ(text(resumed), text(whole));
  }
}

TEST_F(CheckpointTest, a_run_that_was_resumed_can_be_killed_and_resumed_again) {
  const Case c{"", make_pillar(), make_skirt(0.75, 0.3, 0.04)};
  Garment whole = c.garment, killed = c.garment;
  const DrapeReport undisturbed =
      drape(whole, &c.body, {}, silent_reporter(), {.checkpoints = {file("whole.json"), 10}});
  Killer first(25);
  drape(killed, &c.body, {}, first, {.checkpoints = {file("run.json"), 10}});
  for (int times = 0; times < 2; ++times) {
    Killer again(25);
    resume_drape(file("run.json"), killed, &c.body, again, file("run.json"));
  }
  Garment resumed;
  EXPECT_EQ(read_checkpoint(file("run.json")).report.steps, 60);
  EXPECT_EQ(resume_drape(file("run.json"), resumed, &c.body, silent_reporter()).steps,
            undisturbed.steps);
  EXPECT_EQ(text(resumed), text(whole));
}

TEST_F(
    CheckpointTest,
    garments_over_each_other_killed_while_one_is_draped_alone_or_all_together_go_on_to_the_same_bytes) {
  const body::Body pillar = make_pillar(48, 40);
  const std::vector<Garment> start = {make_skirt(0.72, 0.25, 0.05), make_skirt(0.76, 0.15, 0.05)};
  std::vector<Garment> whole = start;
  Killer nobody(1 << 30);
  const DrapeReport undisturbed = drape_layers(whole, &pillar, {}, nobody, {file("whole.json"), 7});
  EXPECT_TRUE(undisturbed.converged) << stop_text(undisturbed);
  std::set<std::size_t> stages;
  const int steps = nobody.asked();
  for (int at : {steps / 8, 3 * steps / 8, 5 * steps / 8, 7 * steps / 8,
                 steps - 2}) { // all together take but a few steps
    std::vector<Garment> killed = start, resumed;
    Killer killer(at);
    EXPECT_EQ(drape_layers(killed, &pillar, {}, killer, {file("killed.json"), 7}).stop_reason,
              StopReason::INTERRUPTED);
    const DrapeCheckpoint c = read_checkpoint(file("killed.json"));
    ASSERT_TRUE(c.layers);
    stages.insert(c.layers->alone);
    set_thread_count(1 + at % 2);
    const DrapeReport report = resume_layers(c, resumed, &pillar, silent_reporter());
    set_thread_count(1);
    ASSERT_EQ(resumed.size(), 2U);
    for (std::size_t k = 0; k < 2; ++k)
      EXPECT_EQ(text(resumed[k]), text(whole[k]))
          << "garment " << k << " killed after " << at << " steps";
    EXPECT_EQ(report.steps, undisturbed.steps);
    EXPECT_EQ(report.repairs, undisturbed.repairs);
    EXPECT_EQ(report.quality, undisturbed.quality);
  }
  EXPECT_EQ(stages, (std::set<std::size_t>{0, 1, 2})) << "a kill in each of the three drapes";
  Garment one;
  EXPECT_THROW(resume_drape(file("killed.json"), one, &pillar, silent_reporter()), Error)
      << "without the other garments";
}

TEST_F(CheckpointTest, a_body_in_motion_is_gone_on_with_from_between_its_frames_to_the_same_bytes) {
  const body::Body pillar = make_pillar(48, 40);
  BodyMoves moves = swinging(pillar, 12, 0.15);
  struct Frame {
    MotionFrame reported;
    std::vector<Vec3> x;
  };
  const auto keep = [](std::vector<Frame>& list) {
    return [&list](const MotionFrame& f, const Garment& g) { list.push_back({f, g.position}); };
  };
  const Garment start = make_skirt(0.75, 0.3, 0.04);
  Garment whole = start;
  std::vector<Frame> frames;
  Killer nobody(1 << 30);
  int first = 0; // how often it was asked before the first frame
  const auto keep_and_count = [&](const MotionFrame& f, const Garment& g) {
    if (frames.empty())
      first = nobody.asked();
    frames.push_back({f, g.position});
  };
  const MotionInput walk{"a walk", 30};
  const DrapeReport undisturbed =
      drape_in_motion(whole, pillar, {}, {&moves, keep_and_count}, nobody,
                      {.checkpoints = {file("whole.json"), 8, false, walk}});
  EXPECT_TRUE(undisturbed.converged) << stop_text(undisturbed);
  std::set<std::pair<DrapePhase, bool>> places;
  for (int at : {first - 3, first + 5, first + 10, nobody.asked() - 2}) {
    Garment killed = start, resumed;
    Killer killer(at);
    std::vector<Frame> before, after;
    drape_in_motion(killed, pillar, {}, {&moves, keep(before)}, killer,
                    {.checkpoints = {file("killed.json"), 8, false, walk}});
    const DrapeCheckpoint c = read_checkpoint(file("killed.json"));
    ASSERT_TRUE(c.motion);
    EXPECT_EQ(c.motion->sha256, "a walk");
    places.insert({c.state.phase, c.state.move.over});
    set_thread_count(1 + at % 2);
    const DrapeReport report =
        resume_in_motion(c, resumed, pillar, {&moves, keep(after)}, silent_reporter());
    set_thread_count(1);
    EXPECT_EQ(text(resumed), text(whole))
        << "killed at " << at << " of " << nobody.asked() << ", frames begin at " << first;
    EXPECT_EQ(report.steps, undisturbed.steps);
    EXPECT_EQ(report.solver, undisturbed.solver);
    io::Json quality = report.quality, expected = undisturbed.quality;
    for (io::Json* q : {&quality, &expected})
      (*q)["motion"].erase("ms_per_frame");
    EXPECT_EQ(quality, expected);
    ASSERT_EQ(c.state.move.frame + after.size(), frames.size());
    for (std::size_t k = 0; k < after.size(); ++k) {
      EXPECT_EQ(after[k].x, frames[c.state.move.frame + k].x);
      EXPECT_EQ(after[k].reported.parts, frames[c.state.move.frame + k].reported.parts);
      EXPECT_EQ(after[k].reported.number, frames[c.state.move.frame + k].reported.number);
    }
  }
  EXPECT_TRUE(places.count({DrapePhase::MOVE, false}) &&
              places.count({DrapePhase::SETTLE, false}) &&
              places.count({DrapePhase::SETTLE, true}));
  Garment resumed;
  EXPECT_THROW(resume_drape(file("killed.json"), resumed, &pillar, silent_reporter()), Error)
      << "without the motion";
  moves.n_frames = 0;
  EXPECT_THROW(resume_in_motion(read_checkpoint(file("killed.json")), resumed, pillar, {&moves},
                                silent_reporter()),
               Error)
      << "with a shorter motion";
}

TEST_F(CheckpointTest,
       garments_over_each_other_in_motion_killed_before_and_during_it_go_on_to_the_same_bytes) {
  const body::Body pillar = make_pillar(48, 40);
  const BodyMoves moves = swinging(pillar, 6, 0.1);
  const std::vector<Garment> start = {make_skirt(0.72, 0.25, 0.05), make_skirt(0.76, 0.15, 0.05)};
  std::vector<Garment> whole = start;
  Killer nobody(1 << 30);
  int first = 0; // how often it was asked before the first frame
  std::vector<std::vector<Vec3>> frames;
  const auto count = [&](const MotionFrame& f, const Garment& g) {
    if (frames.empty())
      first = nobody.asked();
    EXPECT_EQ(f.self_intersections, 0U) << f.number;
    frames.push_back(g.position);
  };
  const DrapeReport undisturbed =
      drape_layers(whole, &pillar, {}, nobody, {file("whole.json"), 7}, {&moves, count});
  EXPECT_TRUE(undisturbed.converged) << stop_text(undisturbed);
  ASSERT_EQ(frames.size(), 6U);
  std::set<std::pair<std::size_t, DrapePhase>> places;
  for (int at : {60, first - 3, first + 4}) {
    std::vector<Garment> killed = start, resumed;
    Killer killer(at);
    drape_layers(killed, &pillar, {}, killer, {file("killed.json"), 7}, {&moves});
    const DrapeCheckpoint c = read_checkpoint(file("killed.json"));
    ASSERT_TRUE(c.layers && c.motion);
    EXPECT_EQ(c.motion->fps, 30);
    places.insert({c.layers->alone, c.state.phase});
    std::vector<std::vector<Vec3>> after;
    const DrapeReport report = resume_layers(
        c, resumed, &pillar, silent_reporter(), {},
        {&moves, [&](const MotionFrame&, const Garment& g) { after.push_back(g.position); }});
    for (std::size_t k = 0; k < 2; ++k)
      EXPECT_EQ(text(resumed[k]), text(whole[k]))
          << "garment " << k << " killed after " << at << " steps";
    EXPECT_EQ(report.steps, undisturbed.steps);
    EXPECT_EQ(report.quality["layers"], undisturbed.quality["layers"]);
    EXPECT_EQ(after, std::vector<std::vector<Vec3>>(
                         frames.begin() + static_cast<long>(c.state.move.frame), frames.end()));
    EXPECT_THROW(resume_layers(c, resumed, &pillar, silent_reporter()), Error)
        << "without the motion";
  }
  EXPECT_EQ(places, (std::set<std::pair<std::size_t, DrapePhase>>{
                        {0, DrapePhase::SEW}, {2, DrapePhase::SETTLE}, {2, DrapePhase::MOVE}}));
}

TEST_F(CheckpointTest, a_checkpoint_of_another_body_or_a_damaged_one_is_refused) {
  const body::Body pillar = make_pillar();
  Garment skirt = make_skirt(0.75, 0.3, 0.04);
  skirt.body_sha256 = "this body";
  DrapeSettings settings;
  settings.max_steps = 12;
  settings.extra_steps = 7;
  drape(skirt, &pillar, settings, silent_reporter(), {.checkpoints = {file("run.json"), 5}});
  EXPECT_EQ(read_checkpoint(file("run.json")).report.settings.extra_steps, 7);
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
    EXPECT_THROW(resume_drape(file("damaged.json"), resumed, &pillar, silent_reporter()), Error)
        << from;
  }
  std::string unknown = whole;
  unknown.replace(unknown.find("settle_force_ratio"), 1, "n");
  std::ofstream(file("damaged.json")) << unknown;
  try {
    read_checkpoint(file("damaged.json"));
    FAIL() << "a knob that nobody knows was read";
  } catch (const Error& e) {
    EXPECT_EQ(e.kind(), ErrorKind::INPUT);
    EXPECT_NE(std::string(e.what()).find("/settings/nettle_force_ratio"), std::string::npos)
        << e.what();
  }
  std::ofstream(file("damaged.json")) << whole.substr(0, whole.size() / 2);
  EXPECT_THROW(resume_drape(file("damaged.json"), resumed, &pillar, silent_reporter()), Error);
}

/// What fuzzers start from is read: of a seed that is refused they would see no more than the
/// refusal.
TEST(CheckpointSeeds, of_every_version_are_read) {
  const std::string folder = std::string(SLOPER_SOURCE_DIR) + "/tests/fuzz/corpus/garment/";
  EXPECT_NO_THROW(read_checkpoint(folder + "checkpoint")); // version 1
  const DrapeCheckpoint moving = read_checkpoint(folder + "checkpoint-motion"),
                        layered = read_checkpoint(folder + "checkpoint-layers");
  EXPECT_EQ(moving.state.phase, DrapePhase::MOVE);
  ASSERT_TRUE(layered.layers);
  EXPECT_EQ(layered.layers->garments.size(), 2u);
}
