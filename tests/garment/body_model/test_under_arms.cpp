/// Cloth between a hanging arm and the trunk, not around the arm.
#include <support/drape_scene.hpp>

#include <garment/simulate/audit.hpp>
#include <gtest/gtest.h>
#include <sloper/garment/body_model/under_arms.hpp>
#include <sloper/garment/simulate/checkpoint.hpp>

using namespace sloper;
using namespace sloper::garment;

namespace {

constexpr double ARM_X = 0.24, ARM_R = 0.03, ELBOW_Y = 1.0, WRIST_Y = 0.85, TIP_Y = 0.7;

/// The pillar, and beside it on its left an upright arm with its hand, which ends above the skirt's
/// hem.
body::Body pillar_with_arm() {
  body::Body body = make_pillar(48, 40);
  const body::Body other = make_pillar(24, 40);
  const int first = std::ssize(body.skin.positions);
  for (const Vec3& p : other.skin.positions) {
    const double share = (p.y() - 0.2) / 1.0, round = std::min(1.0, 4 * std::min(share, 1 - share));
    const Vec3 across = Vec3(p.x(), 0, p.z()).normalized() *
                        (p.x() == 0 && p.z() == 0 ? 0 : ARM_R * std::sqrt(round));
    body.skin.positions.push_back(Vec3(ARM_X, TIP_Y + share * 0.5, 0) + across);
  }
  for (const Triangle& t : other.skin.triangles)
    body.skin.triangles.push_back({t[0] + first, t[1] + first, t[2] + first});
  body.face_part.resize(body.skin.triangles.size(), body::Part::ARM_L);
  body.landmarks["shoulder_joint_l"].p = Vec3(ARM_X, 1.18, 0);
  body.landmarks["elbow_l"].p = Vec3(ARM_X, ELBOW_Y, 0);
  body.landmarks["wrist_l"].p = Vec3(ARM_X, WRIST_Y, 0);
  body.landmarks["hand_tip_l"].p = Vec3(ARM_X, TIP_Y, 0);
  return body;
}

} // namespace

TEST(UnderArms, what_lies_beyond_the_forearm_comes_before_it) {
  const body::Body body = pillar_with_arm();
  const std::vector<Vec3> start = {{0.4, 0.9, 0}, {0.24, 0.8, 0}, {0.2, 0.9, 0.3}, {-0.4, 0.9, 0},
                                   {0.4, 0.6, 0}, {0.4, 1.1, 0},  {0.4, 0.9, 0}};
  std::vector<Vec3> x = start;
  EXPECT_EQ(bring_under_arms(x, {0, 0, 0, 0, 0, 0, 1}, body, 0.005), 2U);
  for (int i : {0, 1}) {
    EXPECT_LT(x[i].x(), ARM_X - ARM_R);
    EXPECT_GT(x[i].x(), 0.14);
    EXPECT_NEAR(x[i].z(), 0, 0.01);
  }
  EXPECT_EQ(std::vector<Vec3>(x.begin() + 2, x.end()),
            std::vector<Vec3>(start.begin() + 2, start.end()))
      << "before the arm, on the other side, below the hand, above the elbow, of a sleeve";
}

TEST(UnderArms, without_an_elbow_nothing_moves) {
  body::Body body = pillar_with_arm();
  body.landmarks.erase("elbow_l");
  std::vector<Vec3> x = {{0.4, 0.9, 0}};
  EXPECT_EQ(bring_under_arms(x, {0}, body, 0.005), 0U);
  EXPECT_FALSE(Forearms(body).are_near(x));
}

TEST(UnderArms, a_forearm_drawn_in_is_at_its_elbow) {
  const body::Body body = pillar_with_arm();
  const Forearms forearms(body);
  const std::vector<Vec3> drawn = forearms.drawn_in(body.skin.positions);
  for (std::size_t v = 0; v < drawn.size(); ++v) {
    const Vec3& p = body.skin.positions[v];
    if (p.x() > 0.2 && p.y() < ELBOW_Y)
      EXPECT_LT((drawn[v] - body.landmark("elbow_l")).norm(), 0.01);
    else
      EXPECT_EQ(drawn[v], p);
  }
  EXPECT_TRUE(forearms.are_near({{0.3, 0.9, 0.1}, {-0.3, 0.9, -0.1}}));
  EXPECT_FALSE(forearms.are_near({}));
  EXPECT_FALSE(forearms.are_near({{0.15, 0.9, 0.1}, {-0.3, 0.9, -0.1}}));
}

TEST(UnderArms, a_long_sleeve_covers_the_forearm) {
  const Forearms forearms(pillar_with_arm());
  EXPECT_TRUE(forearms.is_covered(body::Part::ARM_L, {{0.24, 1.2, 0}, {0.24, 0.9, 0}}));
  EXPECT_TRUE(forearms.is_covered(body::Part::ARM_L, {{0.24, 1.0, 0}, {0.24, 0.7, 0}}))
      << "wherever it lies";
  EXPECT_FALSE(forearms.is_covered(body::Part::ARM_L, {{0.24, 1.2, 0}, {0.24, 0.95, 0}}));
  EXPECT_FALSE(forearms.is_covered(body::Part::ARM_L, {}));
  EXPECT_FALSE(forearms.is_covered(body::Part::ARM_R, {{0.24, 1.2, 0}, {0.24, 0.7, 0}}))
      << "it was not found";
}

TEST(UnderArms, what_a_sleeve_is_sewn_around_stays) {
  const body::Body body = pillar_with_arm();
  Forearms forearms(body);
  forearms.leave_in(body::Part::ARM_L, {{0.24, 1.2, 0}, {0.24, 0.95, 0}}); // 5 cm of the forearm
  const std::vector<Vec3> drawn = forearms.drawn_in(body.skin.positions);
  const Vec3 elbow = body.landmark("elbow_l"),
             down = (body.landmark("wrist_l") - elbow).normalized();
  const double covered = 0.25 - (elbow - body.landmark("shoulder_joint_l")).norm();
  int left = 0, away = 0;
  for (std::size_t v = 0; v < drawn.size(); ++v) {
    const double along = (body.skin.positions[v] - elbow).dot(down);
    if (drawn[v] == body.skin.positions[v]) {
      left += along > 0;
    } else {
      EXPECT_LT((drawn[v] - elbow).dot(down), covered + 0.03);
      EXPECT_GT(along, covered + 0.019);
      ++away;
    }
  }
  EXPECT_GT(left, 0);
  EXPECT_GT(away, 0);
}

TEST(UnderArms, a_wide_skirt_is_sewn_inside_of_a_hanging_arm) {
  const body::Body body = pillar_with_arm();
  Garment skirt = make_skirt(0.74, 0.4, 0.03, 1.02, 0.25, 3);
  for (pattern::PanelInfo& p : skirt.panels.panels)
    p.part = "lower_body";
  const DrapeReport report = drape(skirt, &body, {}, silent_reporter());
  EXPECT_TRUE(report.converged) << stop_text(report);
  const collision::BodyCollider collider(body.skin);
  EXPECT_TRUE(audit(skirt, &collider).clean());
  const auto names_arms = [](const std::string& r) {
    return r.find("forearms or hands") != std::string::npos;
  };
  EXPECT_TRUE(std::any_of(report.repairs.begin(), report.repairs.end(), names_arms));
  std::vector<Vec3> x = skirt.position;
  EXPECT_EQ(bring_under_arms(x, std::vector<char>(x.size(), 0), body, 0), 0U)
      << "nothing of it is beyond the arm";
}

TEST(UnderArms, without_contact_no_arm_is_held_up) {
  const body::Body body = pillar_with_arm();
  Garment skirt = make_skirt(0.74, 0.4, 0.05, 1.02, 0.25, 3);
  for (pattern::PanelInfo& p : skirt.panels.panels)
    p.part = "lower_body";
  DrapeSettings settings;
  settings.effects = "auto,-body_contact";
  settings.max_steps = 260; // it falls
  const DrapeReport report = drape(skirt, &body, settings, silent_reporter());
  EXPECT_FALSE(report.converged);
  for (const std::string& r : report.repairs)
    EXPECT_EQ(r.find("forearms"), std::string::npos) << r;
}

TEST(UnderArms, a_run_that_goes_on_while_the_arms_are_up_ends_in_the_same_bytes) {
  const body::Body body = pillar_with_arm();
  const std::string file = std::string(SLOPER_BINARY_DIR) + "/arms.checkpoint.json";
  const auto skirt = [] {
    Garment g = make_skirt(0.74, 0.4, 0.05, 1.02, 0.25, 3);
    for (pattern::PanelInfo& p : g.panels.panels)
      p.part = "lower_body";
    return g;
  };
  Checkpoints checkpoints;
  checkpoints.file = file;
  checkpoints.every_steps = 10;
  Garment whole = skirt(), stopped = skirt(), resumed;
  ASSERT_TRUE(drape(whole, &body, {}, silent_reporter(), {.checkpoints = checkpoints}).converged);
  DrapeSettings settings;
  for (int steps : {25, 120, 150, 180, 200}) { // sewing, and the way to where the arms come down
    settings.max_steps = steps;
    stopped = skirt();
    drape(stopped, &body, settings, silent_reporter(), {.checkpoints = checkpoints});
    DrapeCheckpoint c = read_checkpoint(file);
    c.report.settings.max_steps = DrapeSettings{}.max_steps;
    resume_drape(c, resumed, &body, silent_reporter(), checkpoints);
    EXPECT_EQ(strict_hash(resumed), strict_hash(whole)) << steps;
  }
}
