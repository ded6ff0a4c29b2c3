#include <support/shapes.hpp>

#include <gtest/gtest.h>
#include <sloper/collision/displacement_bounds.hpp>
#include <sloper/collision/distance.hpp>

namespace sloper::collision {
namespace {

/// A ball of 0.3 m radius that turns about y, with displacements of 0 to 6 cm.
struct Turning {
  TriangleMesh skin = shapes::sphere(3, 0.3);
  std::vector<Vec3> displacement;
  Turning() {
    for (const Vec3& p : skin.positions)
      displacement.push_back(0.2 * Vec3::UnitY().cross(p) + Vec3(0, 0.01 * p.x(), 0));
  }
};

Box3 around_origin(double half) {
  return {Vec3::Constant(-half), Vec3::Constant(half)};
}

} // namespace

TEST(DisplacementBounds, bounds_the_displacements_of_all_skin_within_the_radius) {
  const Turning ball;
  DisplacementBounds bounds;
  bounds.build(ball.skin, ball.displacement, around_origin(0.4), 0.05);
  Random random(3);
  for (int k = 0; k < 300; ++k) {
    const Vec3 place = shapes::random_point(random, 0.45),
               own = shapes::random_point(random, 0.05); // some outside of the region
    const double radius = random.uniform(0.005, 0.1),
                 bound = bounds.max_relative_displacement(own, place, radius);
    for (const Triangle& t : ball.skin.triangles) {
      const auto near = point_triangle(place, ball.skin.positions[t[0]], ball.skin.positions[t[1]],
                                       ball.skin.positions[t[2]]);
      if ((place - near.point).norm() > radius)
        continue;
      for (int v : t)
        ASSERT_LE((ball.displacement[v] - own).norm(), bound * (1 + 1e-12)) << "place " << k;
    }
  }
}

TEST(DisplacementBounds, does_not_count_skin_elsewhere) {
  const Turning ball;
  DisplacementBounds bounds;
  bounds.build(ball.skin, ball.displacement, around_origin(0.4), 0.05);
  const Vec3 place(0, 0, 0.3),
      own = 0.2 * Vec3::UnitY().cross(place); // goes as the skin there: 6 cm along x
  EXPECT_GT(DisplacementBounds::farthest(bounds.all(), own), 0.11);
  EXPECT_LT(bounds.max_relative_displacement(own, place, 0.02), 0.03);
  EXPECT_EQ(bounds.max_relative_displacement(own, Vec3::Zero(), 0.05), 0) << "there is none";
}

TEST(DisplacementBounds, of_a_region_without_skin_are_none_and_wide_regions_keep_their_bounds) {
  const Turning ball;
  DisplacementBounds bounds;
  bounds.build(ball.skin, ball.displacement, {Vec3(1, 1, 1), Vec3(2, 2, 2)}, 0.05);
  EXPECT_TRUE(bounds.all().empty());
  EXPECT_EQ(bounds.max_relative_displacement(Vec3(1, 0, 0), Vec3(1, 1, 1), 0.5), 0);
  bounds.build(ball.skin, ball.displacement, around_origin(500), 0.05);
  EXPECT_GE(bounds.max_relative_displacement(Vec3::Zero(), Vec3(0, 0, 0.3), 0.01),
            0.06 * (1 - 1e-3));
}

} // namespace sloper::collision
