#include <sloper/base/random.hpp>
#include <sloper/base/units.hpp>
#include <sloper/geometry/part_frame.hpp>

#include <gtest/gtest.h>

#include <cmath>

using namespace sloper;

static Vec3 random_point(Random& random, double size) {
  const double x = random.uniform(-size, size), y = random.uniform(-size, size),
               z = random.uniform(-size, size);
  return {x, y, z};
}

TEST(PartFrame, measures_z_as_a_fraction_from_lower_to_upper_centre) {
  const PartFrame frame = make_part_frame({0, 1, 0}, {0, 1.5, 0}, {0, 0, 1}, false);
  EXPECT_NEAR(frame.coordinates({0.1, 1, 0}).z, 0, 1e-15);
  EXPECT_NEAR(frame.coordinates({0.1, 1.5, 0}).z, 1, 1e-15);
  EXPECT_NEAR(frame.coordinates({0, 0.75, 0.3}).z, -0.5, 1e-15);
  EXPECT_NEAR(frame.coordinates({0, 0.75, 0.3}).r, 0.3, 1e-15);
}

TEST(PartFrame, measures_theta_from_the_front_towards_the_left_of_the_body) {
  const PartFrame torso = make_part_frame({0, 1, 0}, {0, 1.5, 0}, {0, 0, 1}, false);
  EXPECT_NEAR(torso.coordinates({0, 1.2, 0.2}).theta, 0, 1e-15);
  EXPECT_NEAR(torso.coordinates({0.2, 1.2, 0}).theta, units::PI / 2,
              1e-15); // +x is the body's left; right-handed about +y
  EXPECT_NEAR(std::abs(torso.coordinates({0, 1.2, -0.2}).theta), units::PI, 1e-15);
}

TEST(PartFrame, gives_left_and_right_parts_the_same_coordinates) {
  const Vec3 lower(0.7, 0.9, 0.05), upper(0.18, 1.4, 0);
  const auto mirror = [](const Vec3& p) { return Vec3(-p.x(), p.y(), p.z()); };
  const PartFrame left = make_part_frame(lower, upper, {0, 0, 1}, false);
  const PartFrame right = make_part_frame(mirror(lower), mirror(upper), {0, 0, 1}, true);
  Random random(7);
  for (int i = 0; i < 200; ++i) {
    const Vec3 p = random_point(random, 2);
    const PartCoordinates a = left.coordinates(p), b = right.coordinates(mirror(p));
    EXPECT_NEAR(a.r, b.r, 1e-12);
    EXPECT_NEAR(a.z, b.z, 1e-12);
    EXPECT_NEAR(std::remainder(a.theta - b.theta, 2 * units::PI), 0, 1e-9);
  }
}

TEST(PartFrame, point_undoes_coordinates_for_any_axis) {
  Random random(3);
  for (int i = 0; i < 500; ++i) {
    const Vec3 lower = random_point(random, 2), upper = lower + random_point(random, 1);
    if ((upper - lower).norm() < 0.01)
      continue;
    const PartFrame frame = make_part_frame(lower, upper, {0, 0, 1}, i % 2 == 1);
    const Vec3 p = random_point(random, 2);
    EXPECT_LT((frame.point(frame.coordinates(p)) - p).norm(), 1e-12);
  }
}

TEST(PartFrame, has_a_unit_zero_direction_square_to_its_axis_even_where_forward_is_along_it) {
  for (const Vec3& forward : {Vec3(0, 0, 1), Vec3(1, 0, 0), Vec3(0, 0, -3)}) {
    const PartFrame frame = make_part_frame({0, 0, 0}, {0, 0, 0.5}, forward, false);
    EXPECT_NEAR(frame.theta_zero.norm(), 1, 1e-12);
    EXPECT_NEAR(frame.theta_zero.dot(frame.axis()), 0, 1e-12);
  }
}
