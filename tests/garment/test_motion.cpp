#include "drape_scene.hpp"

#include <garment/effects.hpp>
#include <garment/motion.hpp>
#include <gtest/gtest.h>

using namespace sloper;
using namespace sloper::garment;

namespace {

/// The pillar swings to its side and turns, as hips do.
BodyMoves swinging(const body::Body& body, std::size_t frames, double way) {
  BodyMoves moves;
  moves.n_frames = frames;
  moves.skin = [&body, way](std::size_t k) {
    const double t = (static_cast<double>(k) + 1) / 30;
    std::vector<Vec3> x = body.skin.positions;
    for (Vec3& p : x) p = Eigen::AngleAxisd(0.3 * std::sin(6 * t), Vec3::UnitY()) * p + Vec3(way * std::sin(2 * M_PI * t), 0, 0);
    return x;
  };
  return moves;
}

} // namespace

TEST(Motion, a_skirt_on_a_swinging_body_is_clean_in_every_frame_and_at_rest_at_the_end) {
  const body::Body pillar = make_pillar(48, 40);
  Garment skirt = make_skirt(0.75, 0.3, 0.04);
  int frames = 0;
  Vec3 first = Vec3::Zero();
  double farthest = 0;
  const BodyMoves moves = swinging(pillar, 15, 0.15); // up to 0.94 m/s
  const DrapeReport report = drape_in_motion(
      skirt, pillar, moves, {},
      [&](const MotionFrame& f, const Garment& g) {
        EXPECT_EQ(f.number, ++frames);
        EXPECT_EQ(f.faces_through, 0U) << f.number;
        EXPECT_EQ(f.vertices_inside, 0U) << f.number;
        EXPECT_EQ(f.self_intersections, 0U) << f.number;
        EXPECT_FALSE(f.forced) << f.number;
        Vec3 sum = Vec3::Zero();
        for (const Vec3& p : g.position) sum += p / static_cast<double>(g.position.size());
        if (frames == 1) first = sum;
        farthest = std::max(farthest, (sum - first).norm());
      },
      silent_reporter());
  EXPECT_EQ(frames, 15);
  EXPECT_GT(farthest, 0.08); // the skirt goes with its body
  EXPECT_TRUE(report.converged) << report.stop_reason;
  EXPECT_TRUE(is_active(report.effects, "body_motion"));
  for (const EffectReport& e : report.effects)
    if (e.name == "body_motion") {
      EXPECT_GE(e.calls, 15);
    }
  EXPECT_EQ(report.quality["motion"]["frames"].get<int>(), 15);
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
