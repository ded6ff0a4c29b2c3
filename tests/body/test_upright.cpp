/// What stands is left as it stands; what lies is set on its soles.
#include "figures.hpp"

#include <body/upright.hpp>
#include <gtest/gtest.h>

using namespace sloper;
using namespace sloper::body;

TEST(RestingPlane, is_that_of_three_feet_under_the_place) {
  // feet on y = 0.1 x - 0.2 z + 1, others above it
  std::vector<Vec3> points;
  for (const auto& [x, z] : {std::pair{-1.0, -1.0}, {1.0, -1.0}, {0.0, 1.0}}) points.emplace_back(x, 0.1 * x - 0.2 * z + 1, z);
  for (int k = 0; k < 50; ++k) points.emplace_back(std::cos(k), 1.6 + 0.1 * std::sin(3 * k), std::sin(k));
  const auto plane = resting_plane(points, Vec2::Zero());
  ASSERT_TRUE(plane);
  EXPECT_NEAR((*plane - Vec3(0.1, -0.2, 1)).norm(), 0, 1e-9);
  EXPECT_FALSE(resting_plane({Vec3::Zero(), Vec3::UnitX()}, Vec2::Zero()));
}

TEST(Upright, who_stands_or_leans_a_little_is_left_so) {
  const TriangleMesh& mesh = test::mannequin("f-165-a").mesh;
  EXPECT_FALSE(upright_turn(mesh, sort_scan(mesh, "auto")));
  const TriangleMesh leaning = test::moved(mesh, Eigen::AngleAxisd(0.035, Vec3::UnitX()).toRotationMatrix(), Vec3::Zero());
  EXPECT_FALSE(upright_turn(leaning, sort_scan(leaning, "auto")));
}

TEST(Upright, who_lies_askew_is_set_on_both_soles) {
  const TriangleMesh& mesh = test::mannequin("f-165-a").mesh;
  const Eigen::Matrix3d turn = (Eigen::AngleAxisd(2.0, Vec3::UnitZ()) * Eigen::AngleAxisd(0.7, Vec3::UnitX())).toRotationMatrix();
  const TriangleMesh lying = test::moved(mesh, turn, Vec3(5, 5, 5));
  const auto upright = upright_turn(lying, sort_scan(lying, "auto"));
  ASSERT_TRUE(upright);
  EXPECT_LT(std::acos((*upright * turn * Vec3::UnitY()).y()), 0.02);
}
