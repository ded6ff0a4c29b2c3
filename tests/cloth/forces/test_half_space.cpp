/// Particles that are kept on their side of a plane.
#include <gtest/gtest.h>
#include <sloper/cloth/forces/half_space.hpp>
#include <support/force_checks.hpp>

using namespace sloper;
using namespace sloper::cloth;

TEST(HalfSpace, pulls_back_what_is_beyond_the_plane_and_nothing_else) {
  const Grid grid = make_grid(3, 0.1);
  const double middle = grid.x[4].x();
  HalfSpaceEffect effect({0, 1, 2, 3, 5, 6, 7, 8}, Vec3(middle + 0.01, 0, 0), Vec3::UnitX(), 50);
  const std::vector<Vec3> x = jittered(grid.x, 0.002, 3);
  expect_gradient(effect, grid.mesh, x, false);
  expect_jacobian(effect, grid.mesh, x, 1e-6);
  BlockMatrix matrix(grid.mesh.n_particles, {});
  const std::vector<Vec3> force = force_of(effect, grid.mesh.n_particles, x, matrix);
  EXPECT_GT(force[0].x(), 0);
  EXPECT_EQ(force[2].norm(), 0);
  EXPECT_EQ(force[4].norm(), 0) << "it is not asked to stay";
}
