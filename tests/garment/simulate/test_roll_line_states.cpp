/// Roll lines are measured where cloth hangs.
#include <cmath>
#include <gtest/gtest.h>
#include <sloper/base/units.hpp>
#include <sloper/garment/sewing.hpp>
#include <sloper/garment/simulate/roll_line_states.hpp>
#include <sloper/io/json.hpp>
#include <sloper/pattern/mesh/mesh_pattern.hpp>
#include <sloper/pattern/read/read_pattern.hpp>

using namespace sloper;
using namespace sloper::garment;

namespace {

/// A strip of 30 x 6 cm with a roll line in its middle, in the plane z = 0 with its outside towards
/// +z; left of `bent_to` (m) what lies beyond the line is turned by `degrees`.
Garment strip(double degrees, double bent_to = 1) {
  const std::string text =
      R"({"format": "pattern", "version": 1, "length_unit": "cm", "name": "strip", "panels": [
    {"name": "collar", "outline": [{"edge": "low", "path": [["M", 0, 0], ["L", 30, 0]]}, {"edge": "right", "path": [["L", 30, 6]]},
      {"edge": "free", "path": [["L", 0, 6]]}, {"edge": "left", "path": [["L", 0, 0]]}],
      "lines": [{"name": "roll", "kind": "roll", "path": [["M", 0, 3], ["L", 30, 3]]}]}]})";
  const pattern::Pattern source =
      pattern::read_pattern_json(io::parse_json(text, "strip"), "strip");
  Garment garment;
  garment.panels = pattern::mesh_pattern(source, 0.01, "strip");
  garment.panels.placed.assign(garment.panels.pattern.size(), Vec3::Zero());
  unsew(garment);
  for (std::size_t v = 0; v < garment.panels.pattern.size(); ++v) {
    const Vec2& p = garment.panels.pattern[v];
    const double beyond = p.y() - 0.03;
    const double angle = beyond > 0 && p.x() < bent_to ? units::radians(degrees) : 0;
    garment.position[garment.particle_of[v]] =
        Vec3(p.x(), 0.03 + beyond * std::cos(angle), beyond * std::sin(angle));
  }
  return garment;
}

RollLineState only(const Garment& garment) {
  const std::vector<RollLineState> states = roll_line_states(garment);
  EXPECT_EQ(states.size(), 1U);
  return states.empty() ? RollLineState{} : states.front();
}

} // namespace

TEST(RollLineStates, the_turn_is_that_of_the_cloth) {
  for (const double degrees : {0.0, 40.0, 120.0, 175.0}) {
    const RollLineState state = only(strip(degrees));
    EXPECT_EQ(state.panel, "collar");
    EXPECT_EQ(state.line, "roll");
    EXPECT_NEAR(units::degrees(state.turn), degrees, 1);
    EXPECT_EQ(state.is_turned(), degrees > 90) << degrees;
  }
}

TEST(RollLineStates, a_leaf_that_is_turned_inwards_is_not_turned_over) {
  for (const double degrees : {-80.0, -120.0, -175.0}) {
    const RollLineState state = only(strip(degrees));
    EXPECT_NEAR(units::degrees(state.turn), degrees, 1);
    EXPECT_FALSE(state.is_turned()) << degrees;
    EXPECT_TRUE(state.stands()) << degrees;
    EXPECT_NEAR(state.inwards_share, 1, 1e-9);
    EXPECT_NE(turned_text(state).find("100 % inwards"), std::string::npos) << turned_text(state);
  }
  EXPECT_EQ(only(strip(120)).inwards_share, 0);
}

TEST(RollLineStates, a_leaf_that_hangs_over_its_own_edge_is_outside_of_the_cloth_that_it_lies_on) {
  // Folded by 186 degrees about an edge that stands off, as a collar's leaf that follows the slope
  // of the shoulders: by its direction it goes inwards.
  Garment garment = strip(0);
  for (std::size_t v = 0; v < garment.panels.pattern.size(); ++v) {
    const Vec2& p = garment.panels.pattern[v];
    const double beyond = p.y() - 0.03, slope = units::radians(6);
    if (beyond > 0)
      garment.position[garment.particle_of[v]] =
          Vec3(p.x(), 0.03 - beyond * std::cos(slope), 0.006 - beyond * std::sin(slope));
  }
  EXPECT_GT(only(garment).turned_share, 0.9);
}

TEST(RollLineStates, a_line_that_is_turned_over_in_part_is_not_turned) {
  const Garment half = strip(170, 0.12);
  EXPECT_NEAR(only(half).turned_share, 0.4, 0.1);
  EXPECT_FALSE(only(half).is_turned());
  EXPECT_NE(turned_text(only(half)).find("roll line roll of panel collar"), std::string::npos);
  EXPECT_EQ(standing_text(roll_line_states(half)), "");
  EXPECT_NE(standing_text(roll_line_states(strip(0))), "");
}

TEST(RollLineStates, of_a_mesh_made_over_are_those_of_the_lines_as_drawn) {
  Garment garment = strip(120);
  for (Vec2& p : garment.panels.pattern) // as keep-fit grades it; the pattern stays
    p = Vec2(1.15 * p.x() + 0.01, 1.3 * p.y() + 0.2 * p.x() * p.x());
  EXPECT_NEAR(units::degrees(only(garment).turn), 120, 1);
  EXPECT_TRUE(only(garment).is_turned());
}

TEST(RollLineStates, a_garment_without_its_pattern_has_none) {
  Garment garment = strip(170);
  garment.panels.source.reset();
  EXPECT_TRUE(roll_line_states(garment).empty());
}
