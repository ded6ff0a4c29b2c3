#include <support/drape_scene.hpp>

#include <garment/drape/layers.hpp>
#include <garment/drape/motion.hpp>
#include <garment/scene/effects.hpp>
#include <garment/simulate/audit.hpp>
#include <gtest/gtest.h>

using namespace sloper;
using namespace sloper::garment;

TEST(Motion, a_skirt_on_a_swinging_body_is_clean_in_every_frame_and_at_rest_at_the_end) {
  const body::Body pillar = make_pillar(48, 40);
  Garment skirt = make_skirt(0.75, 0.3, 0.04);
  int frames = 0;
  Vec3 first = Vec3::Zero();
  double farthest = 0;
  BodyMoves moves = swinging(pillar, 15, 0.15); // up to 0.94 m/s
  moves.lead_in = 4;
  const DrapeReport report =
      drape_in_motion(skirt, pillar, {},
                      {.moves = &moves,
                       .on_frame =
                           [&](const MotionFrame& f, const Garment& g) {
                             EXPECT_EQ(f.number, ++frames);
                             EXPECT_EQ(f.pose, std::max(0, frames - 4));
                             EXPECT_EQ(f.faces_through, 0U) << f.number;
                             EXPECT_EQ(f.vertices_inside, 0U) << f.number;
                             EXPECT_EQ(f.self_intersections, 0U) << f.number;
                             EXPECT_FALSE(f.forced) << f.number;
                             Vec3 sum = Vec3::Zero();
                             for (const Vec3& p : g.position)
                               sum += p / static_cast<double>(g.position.size());
                             if (frames == 1)
                               first = sum;
                             farthest = std::max(farthest, (sum - first).norm());
                           }},
                      silent_reporter());
  EXPECT_EQ(frames, 15);
  EXPECT_GT(farthest, 0.08); // the skirt goes with its body
  EXPECT_TRUE(report.converged) << stop_text(report);
  EXPECT_TRUE(is_active(report.effects, "body_motion"));
  for (const EffectReport& e : report.effects)
    if (e.name == "body_motion") {
      EXPECT_GE(e.calls, 15);
    }
  EXPECT_EQ(report.quality["motion"]["frames"].get<int>(), 15);
}

TEST(Motion, steps_may_take_more_solves_and_be_shorter) {
  const body::Body pillar = make_pillar(48, 40);
  const BodyMoves moves = swinging(pillar, 10, 0.15);
  const auto run = [&](int newton_iterations, double motion_step_s) {
    Garment skirt = make_skirt(0.75, 0.3, 0.04);
    DrapeSettings settings;
    settings.newton_iterations = newton_iterations;
    settings.motion_step_s = motion_step_s;
    return drape_in_motion(
        skirt, pillar, settings,
        {.moves = &moves,
         .on_frame =
             [&](const MotionFrame& f, const Garment&) {
               EXPECT_EQ(f.faces_through + f.vertices_inside + f.self_intersections, 0U)
                   << f.number;
             }},
        silent_reporter());
  };
  const DrapeReport one = run(1, 1.0 / 60), more = run(6, 1.0 / 60), shorter = run(1, 1.0 / 240);
  EXPECT_LT(one.solver["newton"].get<double>(), 1.1);
  EXPECT_GT(more.solver["newton"].get<double>(), one.solver["newton"].get<double>() + 0.1);
  EXPECT_GE(shorter.quality["motion"]["parts"].get<int>(), 80); // of 1/30 s, in eight
  EXPECT_TRUE(more.converged && shorter.converged);
}
TEST(Motion, cloth_at_rest_sleeps_until_skin_near_it_moves) {
  const body::Body pillar = make_pillar(48, 40);
  Garment skirt = make_skirt(0.75, 0.3, 0.04);
  const BodyMoves swing = swinging(pillar, 10, 0.05);
  const std::size_t n_still = 90;
  BodyMoves moves = swing;
  moves.n_frames = 10 + n_still + 5;
  // A swing, a hold in which only the foot of the pillar moves, far below the skirt, and another
  // swing.
  moves.skin = [&](std::size_t k) {
    std::size_t frame_of_swing = k;
    if (k >= 10)
      frame_of_swing = k < 10 + n_still ? 9 : k - n_still;
    std::vector<Vec3> x = swing.skin(frame_of_swing);
    if (k >= 10 && k < 10 + n_still)
      for (Vec3& p : x)
        if (p.y() < 0.3)
          p.x() += 0.0005 * static_cast<double>(k - 9);
    return x;
  };
  Garment last;
  int asleep = 0;
  const DrapeReport report = drape_in_motion(
      skirt, pillar, {},
      {.moves = &moves,
       .on_frame =
           [&](const MotionFrame& f, const Garment& g) {
             EXPECT_EQ(f.faces_through + f.vertices_inside + f.self_intersections, 0U) << f.number;
             const bool still = f.number > 10 && f.number <= 10 + static_cast<int>(n_still);
             if (!still) {
               EXPECT_GT(f.parts, 0) << f.number;
             }
             if (f.parts == 0) {
               EXPECT_EQ(g.position, last.position) << f.number;
               EXPECT_EQ(f.speed_m_s, 0);
               ++asleep;
             } else {
               EXPECT_EQ(asleep > 0 && still, false) << "woke in frame " << f.number;
             }
             last = g;
           }},
      silent_reporter());
  EXPECT_GT(asleep, 20);
  EXPECT_EQ(report.quality["motion"]["asleep_frames"].get<int>(), asleep);
  EXPECT_TRUE(report.converged) << stop_text(report);
}

TEST(Motion, cloth_on_a_body_that_walks_on_evenly_hangs_as_on_one_that_stands_still) {
  const body::Body pillar = make_pillar(48, 40);
  Garment skirt = make_skirt(0.75, 0.3, 0.04);
  ASSERT_TRUE(drape(skirt, &pillar, {}, silent_reporter()).converged);
  const auto shift_at = [](std::size_t k) { // up to 1 m/s within half a second
    const double t = (static_cast<double>(k) + 1) / 30;
    return t < 0.5 ? t * t : 0.25 + t - 0.5;
  };
  const std::vector<Vec3> stood = skirt.position;
  BodyMoves moves;
  moves.n_frames = 60;
  moves.skin = [&](std::size_t k) {
    std::vector<Vec3> x = pillar.skin.positions;
    for (Vec3& p : x)
      p.z() += shift_at(k);
    return x;
  };
  long parts = 0;
  drape_in_motion(
      skirt, pillar, {},
      {.moves = &moves,
       .on_frame =
           [&](const MotionFrame& f, const Garment& g) {
             EXPECT_EQ(f.faces_through + f.vertices_inside + f.self_intersections, 0U) << f.number;
             if (f.number <= 20)
               parts += f.parts;
             if (f.number < 50)
               return;
             double off2 = 0;
             for (std::size_t i = 0; i < stood.size(); ++i)
               off2 +=
                   (g.position[i] - stood[i] - Vec3(0, 0, shift_at(f.number - 1))).squaredNorm();
             EXPECT_LT(std::sqrt(off2 / static_cast<double>(stood.size())), 0.003) << f.number;
           }},
      silent_reporter());
  EXPECT_LE(parts, 45);
}

TEST(Motion, frames_that_are_not_clean_are_no_success) {
  const body::Body pillar = make_pillar(48, 40);
  Garment skirt = make_skirt(0.75, 0.3, 0.04);
  ASSERT_TRUE(drape(skirt, &pillar, {}, silent_reporter()).converged);
  for (const char* panel : {"front", "back"})
    skirt.scene.pins.push_back({{panel, Vec2(0, 1), Vec2(1, 1)}, false, Vec3::Zero(), 1e5});
  BodyMoves moves;
  moves.n_frames = 12;
  moves.skin = [&](std::size_t k) { // out of a skirt that is nailed to the air, and back
    std::vector<Vec3> x = pillar.skin.positions;
    for (Vec3& p : x)
      p.x() += 0.05 * static_cast<double>(std::min(k + 1, 11 - std::min<std::size_t>(k, 11)));
    return x;
  };
  std::size_t through = 0;
  const DrapeReport report = drape_in_motion(
      skirt, pillar, {},
      {.moves = &moves,
       .on_frame = [&](const MotionFrame& f,
                       const Garment&) { through = std::max(through, f.faces_through); }},
      silent_reporter());
  ASSERT_GT(through, 0U);
  EXPECT_FALSE(report.converged);
  EXPECT_TRUE(!skirt.converged || stop_text(report).find("12 frames before") != std::string::npos)
      << stop_text(report);
}

TEST(Motion, a_skirt_below_a_skirt_goes_with_the_body_and_the_order_is_kept) {
  const body::Body pillar = make_pillar(48, 40);
  std::vector<Garment> garments = {make_skirt(0.72, 0.3, 0.04), make_skirt(0.76, 0.2, 0.04)};
  const BodyMoves moves = swinging(pillar, 12, 0.15);
  int frames = 0;
  const DrapeReport report =
      drape_layers(garments, &pillar, {}, silent_reporter(), {},
                   {&moves, [&](const MotionFrame& f, const Garment& all) {
                      ++frames;
                      EXPECT_EQ(all.panels.panels.size(), 4U) << "of both";
                      EXPECT_EQ(f.faces_through + f.vertices_inside + f.self_intersections, 0U)
                          << f.number;
                      EXPECT_FALSE(f.forced) << f.number;
                    }});
  EXPECT_EQ(frames, 12);
  EXPECT_TRUE(report.converged) << stop_text(report);
  EXPECT_TRUE(is_active(report.effects, "body_motion") && is_active(report.effects, "layers"));
  collision::BodyCollider end(
      TriangleMesh{moves.skin(11), pillar.skin.triangles}); // the body as the motion leaves it
  EXPECT_TRUE(audit(merge_layers(garments), &end).clean());
  EXPECT_EQ(order_violations(garments, end)[0], 0U);
  for (const io::Json& layer : report.quality["layers"]) {
    EXPECT_EQ(layer["vertices_inside_body"].get<int>(), 0);
    EXPECT_EQ(layer["order_violations"].get<int>(), 0);
  }
}

TEST(Motion, without_a_motion_the_effect_is_off_and_not_called) {
  const body::Body pillar = make_pillar(32, 30);
  Garment skirt = make_skirt(0.75, 0.2, 0.05);
  DrapeSettings settings;
  settings.max_steps = 5;
  const DrapeReport report = drape(skirt, &pillar, settings, silent_reporter());
  for (const EffectReport& e : report.effects)
    if (e.name == "body_motion") {
      EXPECT_FALSE(e.active);
      EXPECT_EQ(e.calls, 0);
      EXPECT_EQ(e.why, "the body stands still");
    }
}
