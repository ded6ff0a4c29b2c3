/// Sleeve ends stay at the wrists while the body is inflated under a garment, and are let go then.
#include <support/drape_scene.hpp>

#include <algorithm>
#include <garment/simulate/sleeve_ends.hpp>
#include <gtest/gtest.h>
#include <sloper/garment/drape/drape.hpp>

using namespace sloper;
using namespace sloper::garment;

namespace {

/// Hung on a pillar, from y = 1.02 to about 0.77 m.
Garment hung(body::Body& pillar) {
  pillar.landmarks["hip_center"].p = Vec3(0, 0.2, 0);
  pillar.landmarks["neck_center"].p = Vec3(0, 1.2, 0);
  Garment garment = make_skirt(0.75, 0.25, 0.04);
  EXPECT_TRUE(drape(garment, &pillar, {}, silent_reporter()).converged);
  return garment;
}

double lowest(const Garment& garment) {
  return std::min_element(garment.position.begin(), garment.position.end(),
                          [](const Vec3& a, const Vec3& b) { return a.y() < b.y(); })
      ->y();
}

const EffectReport& pins(const DrapeReport& report) {
  return *std::find_if(report.effects.begin(), report.effects.end(),
                       [](const EffectReport& e) { return e.name == "pins"; });
}

} // namespace

TEST(SleeveEnds, only_what_ends_near_the_wrist_is_held_and_of_that_the_last_3_cm) {
  body::Body pillar = make_pillar();
  Garment garment = hung(pillar);
  EXPECT_TRUE(hold_ends(garment, LimbEnds::SLEEVES).empty()) << "it is not bound";
  for (const double past_wrist : {-0.1, 0.0, 0.07}) {
    garment.bind = bind_as_sleeve(garment, lowest(garment) + past_wrist);
    const std::vector<cloth::Pin> held = hold_ends(garment, LimbEnds::SLEEVES);
    const auto low = std::count_if(garment.position.begin(), garment.position.end(),
                                   [&](const Vec3& p) { return p.y() < lowest(garment) + 0.03; });
    EXPECT_GT(low, 5);
    EXPECT_EQ(held.size(), static_cast<std::size_t>(low));
    for (const cloth::Pin& pin : held)
      EXPECT_EQ(pin.target, garment.position[pin.particle]);
  }
  garment.bind = bind_as_sleeve(garment, lowest(garment) + 0.09);
  EXPECT_TRUE(hold_ends(garment, LimbEnds::SLEEVES).empty()) << "it covers the hand";
  garment.bind = bind_as_sleeve(garment, lowest(garment));
  garment.bind.frames = {"upper_arm_l"};
  EXPECT_TRUE(hold_ends(garment, LimbEnds::SLEEVES).empty()) << "it ends above the elbow";
}

TEST(SleeveEnds, that_slid_onto_a_hand_and_are_held_open_by_it_are_told) {
  body::Body pillar = make_pillar();
  Garment garment = hung(pillar);
  garment.bind = bind_as_sleeve(garment, lowest(garment));
  const std::size_t n_held = hold_ends(garment, LimbEnds::SLEEVES).size();
  const std::vector<Vec3> placed = garment.position;
  const double end = lowest(garment) + 0.03;
  const auto moved = [&](double down, double wider) {
    Garment there = garment;
    for (Vec3& p : there.position)
      if (p.y() < end)
        p = Vec3(wider * p.x(), p.y() - down, wider * p.z());
    return ends_pushed_on_hands(there, placed, placed);
  };
  EXPECT_EQ(moved(0.02, 1.05).size(), n_held);
  EXPECT_TRUE(moved(0.02, 1).empty()) << "it is wider than the hand";
  EXPECT_TRUE(moved(0.005, 1.05).empty()) << "it is where it was placed";
  EXPECT_TRUE(moved(-0.02, 1.05).empty()) << "it is nearer to the elbow";
}

TEST(SleeveEnds, are_held_on_a_shorter_arm_until_there_are_folds_above) {
  body::Body pillar = make_pillar();
  Garment garment = hung(pillar);
  garment.bind = bind_as_sleeve(garment, lowest(garment));
  const double top = lowest(garment) + 0.25;
  for (Vec3& p : garment.position)
    p.y() = top + 0.85 * (p.y() - top);
  const DrapeReport report =
      drape(garment, &pillar, {}, silent_reporter(), {.start = {.hold_ends = LimbEnds::SLEEVES}});
  EXPECT_TRUE(report.converged) << stop_text(report);
  EXPECT_GE(pins(report).calls, 40) << "steps without weight and friction";
  EXPECT_LT(pins(report).calls, report.steps);
}

TEST(SleeveEnds, are_held_while_the_body_is_inflated_unless_that_is_switched_off) {
  body::Body pillar = make_pillar();
  Garment garment = hung(pillar);
  garment.bind = bind_as_sleeve(garment, lowest(garment));
  for (Vec3& p : pillar.skin.positions) {
    p.x() *= 1.05;
    p.z() *= 1.05;
  }
  DrapeSettings settings;
  for (const char* effects : {"auto", "auto,-pins"}) {
    settings.effects = effects;
    Garment again = garment;
    const DrapeReport report = drape(again, &pillar, settings, silent_reporter());
    EXPECT_TRUE(report.converged) << stop_text(report);
    EXPECT_EQ(pins(report).active, settings.effects == "auto");
    EXPECT_EQ(pins(report).calls > 0, settings.effects == "auto");
    EXPECT_LT(pins(report).calls, report.steps) << "and then let go";
  }
}
