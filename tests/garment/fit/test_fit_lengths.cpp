#include <sloper/garment/fit/fit_lines.hpp>

#include <gtest/gtest.h>

namespace sloper::garment {

namespace {

constexpr double FOREARM_M = 0.25, LEG_M = 0.8, CROTCH = 0.9, KNEE = 0.5; // m; z of the marks

/// An edge of two particles, and how it is bound: both at one coordinate of one frame.
struct Edge {
  FitHem hem;
  Bind bind;
};

Edge edge_at(const std::string& name, const std::string& frame, double z) {
  Edge edge;
  edge.hem.name = name;
  edge.hem.edges = {{0, 1}};
  edge.bind.frames = {"forearm_l", "upper_arm_l", "leg_l", "leg_r"};
  edge.bind.lengths_m = {FOREARM_M, 0.3, LEG_M, LEG_M};
  edge.bind.marks = {{}, {}, {{"crotch", CROTCH}, {"knee", KNEE}}, {{"crotch", CROTCH}}};
  int index = 0;
  while (edge.bind.frames[index] != frame)
    ++index;
  for (int particle = 0; particle < 2; ++particle)
    edge.bind.particles.push_back({{index, 1, 0, z, 0.01}});
  return edge;
}

FitLength length_of(const Edge& here, const Bind* source) {
  const std::vector<FitLength> lengths = fit_lengths({here.hem}, here.bind, source, {}, 0);
  EXPECT_EQ(lengths.size(), 1u);
  return lengths.empty() ? FitLength{} : lengths.front();
}

} // namespace

TEST(fit_lengths, a_sleeve_that_ended_at_the_wrist_and_ends_four_centimetres_above_it_is_shorter) {
  const Edge here = edge_at("left sleeve", "forearm_l", 0.04 / FOREARM_M);
  const Edge before = edge_at("left sleeve", "forearm_l", 0);
  const FitLength length = length_of(here, &before.bind);
  EXPECT_EQ(length.name, "sleeve_l");
  EXPECT_EQ(length.place, "wrist");
  EXPECT_NEAR(length.above_m, 0.04, 1e-12);
  EXPECT_NEAR(length.source_above_m.value_or(1), 0, 1e-12);
  EXPECT_EQ(length.verdict, "shorter");
  EXPECT_EQ(length_text(length),
            "ends 4.0 cm above the wrist, 4.0 cm higher than on the body that it comes from");
}

TEST(fit_lengths, a_cuff_on_the_hand_ends_below_the_wrist) {
  const Edge here = edge_at("left sleeve", "forearm_l", -0.05 / FOREARM_M);
  const Edge before = edge_at("left sleeve", "forearm_l", 0);
  const FitLength length = length_of(here, &before.bind);
  EXPECT_NEAR(length.above_m, -0.05, 1e-12);
  EXPECT_EQ(length.verdict, "longer");
}

TEST(fit_lengths, a_short_sleeve_is_measured_from_the_elbow_whichever_frame_holds_it) {
  const FitLength upper = length_of(edge_at("left sleeve", "upper_arm_l", 0.1), nullptr);
  EXPECT_EQ(upper.place, "elbow");
  EXPECT_NEAR(upper.above_m, 0.03, 1e-12);
  EXPECT_EQ(upper.verdict, "");
  const FitLength fore = length_of(edge_at("left sleeve", "forearm_l", 0.9), nullptr);
  EXPECT_EQ(fore.place, "elbow");
  EXPECT_NEAR(fore.above_m, -0.025, 1e-12);
}

TEST(fit_lengths, a_hem_a_centimetre_off_is_as_it_was) {
  const Edge here = edge_at("hem", "leg_l", KNEE + 0.06 / LEG_M);
  const Edge before = edge_at("hem", "leg_l", KNEE + 0.05 / LEG_M);
  const FitLength length = length_of(here, &before.bind);
  EXPECT_EQ(length.place, "knee");
  EXPECT_NEAR(length.above_m, 0.06, 1e-12);
  EXPECT_EQ(length.verdict, "same");
}

TEST(fit_lengths, a_trouser_leg_is_measured_from_its_own_ankle) {
  const FitLength length = length_of(edge_at("right leg", "leg_r", 0.05), nullptr);
  EXPECT_EQ(length.name, "leg_r");
  EXPECT_EQ(length.place, "ankle");
  EXPECT_NEAR(length.above_m, 0.05 * LEG_M, 1e-12);
}

TEST(fit_lengths, an_uncertainty_beyond_the_change_leaves_it_the_same) {
  Edge here = edge_at("left sleeve", "forearm_l", 0.04 / FOREARM_M);
  const Edge before = edge_at("left sleeve", "forearm_l", 0);
  here.hem.uncertainty_m = 0.05;
  EXPECT_EQ(length_of(here, &before.bind).verdict, "same");
}

TEST(fit_lengths, neck_edges_and_edges_on_no_limb_have_no_length) {
  const Edge neck = edge_at("neck", "leg_l", 0.5), off = edge_at("left sleeve", "leg_l", 0.5);
  EXPECT_TRUE(fit_lengths({neck.hem}, neck.bind, nullptr, {}, 0).empty());
  EXPECT_TRUE(fit_lengths({off.hem}, off.bind, nullptr, {}, 0).empty());
}

} // namespace sloper::garment
