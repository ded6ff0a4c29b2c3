#include <Eigen/Geometry>
#include <body/measure/narrowest_neck.hpp>
#include <gtest/gtest.h>
#include <sloper/base/units.hpp>
#include <support/shapes.hpp>

using namespace sloper;
using namespace sloper::body;

namespace {

constexpr double NECK_STATURE = 1.7, RADIUS = 0.055; // m

/// A tube that widens from its waist at the origin to both ends, leaning forward and to the left.
TriangleMesh leaning_neck(double pitch_deg, double roll_deg) {
  constexpr double HALF_HEIGHT = 0.08, WIDER = 10; // m, 1/m
  TriangleMesh mesh = shapes::cylinder(RADIUS, -HALF_HEIGHT, HALF_HEIGHT, 128, 64);
  const Eigen::Matrix3d turn = (Eigen::AngleAxisd(units::radians(-roll_deg), Vec3::UnitZ()) *
                                Eigen::AngleAxisd(units::radians(pitch_deg), Vec3::UnitX()))
                                   .toRotationMatrix();
  for (Vec3& p : mesh.positions) {
    const double wider = 1 + WIDER * p.y() * p.y() / RADIUS;
    p = turn * Vec3(wider * p.x(), p.y(), wider * p.z());
  }
  return mesh;
}

} // namespace

TEST(NarrowestNeck, a_head_that_leans_does_not_lengthen_the_girth) {
  const Vec3 base = -0.04 * NECK_STATURE * Vec3(0, std::cos(0.6), std::sin(0.6));
  for (const double pitch : {0.0, 20.0, 45.0})
    for (const double roll : {-15.0, 0.0, 10.0}) {
      const auto neck =
          narrowest_neck(leaning_neck(pitch, roll), base, Vec3::UnitY(), NECK_STATURE);
      ASSERT_TRUE(neck) << pitch << ", " << roll;
      EXPECT_NEAR(neck->girth_m, 2 * units::PI * RADIUS, 0.006) << pitch << ", " << roll;
    }
}

TEST(NarrowestNeck, there_is_none_where_no_section_goes_around_the_axis) {
  const Vec3 far(0, 1, 0);
  EXPECT_FALSE(narrowest_neck(leaning_neck(0, 0), far, Vec3::UnitY(), NECK_STATURE));
}
