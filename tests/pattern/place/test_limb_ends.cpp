/// Cuffs and flounces of which shape tells the wrong limb.
#include <support/straight_patterns.hpp>

#include <gtest/gtest.h>
#include <pattern/roles/limb_ends.hpp>
#include <sloper/pattern/mesh/mesh_pattern.hpp>

namespace sloper::pattern::test {
namespace {

constexpr std::size_t TORSO = 0, ARM = 1, LOWER_BODY = 3, LEG = 4; // SHAPE_PART_NAMES

std::vector<DrawnEdge> limb_piece(double width, double height) {
  return {{"low", width, 0}, {"right", width, height}, {"top", 0, height}, {"left", 0, 0}};
}

std::vector<bool> followed(const Pattern& pattern, std::vector<ShapeRole>& roles) {
  const PanelMesh mesh = mesh_pattern(pattern, 0.03, "t");
  return follow_limbs(mesh, SeamGraph(mesh), roles);
}

TEST(LimbEnds, CuffsAndTheirFlouncesAreOfTheLegThatTheyAreSewnTo) {
  DrawnPattern drawn;
  drawn.panel("band",
              {{"low_b", 30, 0}, {"low_a", 60, 0}, {"end", 60, 5}, {"top", 0, 5}, {"start", 0, 0}});
  drawn.panel("leg_a", limb_piece(30, 90));
  drawn.panel("leg_b", limb_piece(30, 90));
  for (const std::string side : {"a", "b"}) {
    drawn.panel("cuff_" + side, limb_piece(30, 8));
    drawn.panel("flounce_" + side, limb_piece(30, 12));
    drawn.seam("leg_" + side, "top", "band", "low_" + side);
    drawn.seam("cuff_" + side, "top", "leg_" + side, "low");
    drawn.seam("flounce_" + side, "top", "cuff_" + side, "low");
  }
  drawn.seam("leg_a", "right", "leg_b", "left");
  std::vector<ShapeRole> roles = {
      {LOWER_BODY, 1, false, 0}, {LEG, 1, true, 1}, {LEG, 1, false, -1}, {LEG, 1, false, -1},
      {ARM, 1, false, -1},       {LEG, 1, true, 1}, {ARM, 1, true, 1}};
  const std::vector<bool> ends = followed(drawn.pattern(), roles);
  EXPECT_EQ(ends, (std::vector<bool>{false, false, false, true, true, true, true}));
  for (const std::size_t k : {3, 4, 5, 6}) {
    const ShapeRole& leg = roles[k < 5 ? 1 : 2];
    EXPECT_EQ(roles[k].part, LEG) << k;
    EXPECT_EQ(roles[k].hand, leg.hand) << k;
    EXPECT_EQ(roles[k].back, leg.back) << k;
  }
}

TEST(LimbEnds, ASleeveIsOnTheSideOfTheHalfThatItIsSewnTo) {
  DrawnPattern drawn;
  drawn.panel("half_a", limb_piece(24, 60));
  drawn.panel("half_b", limb_piece(24, 60));
  drawn.panel("sleeve", limb_piece(40, 50));
  drawn.panel("cuff", limb_piece(40, 8));
  drawn.seam("half_a", "right", "half_b", "left");
  drawn.seam("half_b", "right", "sleeve", "left");
  drawn.seam("sleeve", "low", "cuff", "top");
  std::vector<ShapeRole> roles = {
      {TORSO, 1, true, -1}, {TORSO, 1, true, 1}, {ARM, 1, false, -1}, {LOWER_BODY, 1, false, 0}};
  EXPECT_EQ(followed(drawn.pattern(), roles), std::vector<bool>(4, false));
  for (const std::size_t k : {2, 3}) {
    EXPECT_EQ(roles[k].part, ARM);
    EXPECT_EQ(roles[k].hand, 1);
    EXPECT_TRUE(roles[k].back);
  }
}

} // namespace
} // namespace sloper::pattern::test
