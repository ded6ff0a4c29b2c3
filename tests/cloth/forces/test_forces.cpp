/// Every force against finite differences of its energy, every stiffness against finite differences
/// of its force.
#include <support/force_checks.hpp>

#include <sloper/cloth/forces/bending.hpp>
#include <sloper/cloth/forces/edge_spring.hpp>
#include <sloper/cloth/forces/gravity.hpp>
#include <sloper/cloth/forces/sewing_spring.hpp>
#include <sloper/cloth/forces/shear.hpp>

using namespace sloper;
using namespace sloper::cloth;

TEST(EdgeSpring, force_is_minus_energy_gradient) {
  const Grid g = make_grid(5, 0.1);
  EdgeSpringEffect effect(g.mesh);
  expect_gradient(effect, g.mesh, jittered(g.x, 0.004, 1));
}

TEST(EdgeSpring, stiffness_is_minus_force_gradient_when_stretched) {
  Grid g = make_grid(5, 0.1);
  for (Vec3& p : g.x)
    p *= 1.3; // all springs are longer than at rest, so nothing is clamped
  EdgeSpringEffect effect(g.mesh);
  expect_jacobian(effect, g.mesh, jittered(g.x, 0.0005, 2), 1e-5);
}

TEST(EdgeSpring, stiffness_with_what_is_left_out_of_it_is_minus_force_gradient) {
  const Grid g = make_grid(5, 0.1);
  EdgeSpringEffect effect(g.mesh);
  expect_jacobian(effect, g.mesh, jittered(g.x, 0.004, 2), 1e-5, true);
}

TEST(EdgeSpring, one_percent_compression_makes_the_unclamped_matrix_indefinite) {
  // The paper says that the left side of eq. (1) is always positive definite. It is not.
  const Vec3 a(0, 0, 0), b(0.0099, 0, 0);
  const double k = 1000, l0 = 0.01;
  Eigen::SelfAdjointEigenSolver<Mat3> exact(edge_spring_stiffness(a, b, l0, k, false)),
      clamped(edge_spring_stiffness(a, b, l0, k, true));
  EXPECT_LT(exact.eigenvalues()[0], -1.0);
  EXPECT_GE(clamped.eigenvalues()[0], -1e-9);
}

TEST(EdgeSpring, assembled_matrix_is_definite_at_any_compression) {
  for (double scale : {0.99, 0.9, 0.5, 0.1}) {
    Grid g = make_grid(5, 0.1);
    for (Vec3& p : g.x)
      p *= scale;
    EdgeSpringEffect effect(g.mesh);
    Couplings couplings;
    effect.declare(couplings);
    BlockMatrix matrix(g.mesh.n_particles, couplings);
    effect.bind(matrix);
    force_of(effect, g.mesh.n_particles, jittered(g.x, 0.0003, 3), matrix);
    Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(dense(matrix));
    EXPECT_GT(eigen.eigenvalues()[0], -1e-7) << "scale " << scale;
  }
}

TEST(EdgeSpring, coincident_ends_give_no_force_and_no_nan) {
  const Vec3 a(1, 2, 3);
  EXPECT_EQ(edge_spring_force(a, a, 0.01, 1e9).norm(), 0);
  EXPECT_TRUE(edge_spring_stiffness(a, a, 0.01, 1e9).allFinite());
}

TEST(Shear, force_is_minus_energy_gradient) {
  const Grid g = make_grid(5, 0.1);
  ShearEffect effect(g.mesh);
  expect_gradient(effect, g.mesh, jittered(g.x, 0.004, 4));
}

TEST(Shear, pure_shear_costs_half_k_angle_squared_per_area) {
  Fabric fabric;
  const Grid g = make_grid(6, 0.2, fabric);
  auto x = g.x;
  const double angle = 0.01;
  for (Vec3& p : x)
    p.x() += angle * p.z();
  EXPECT_NEAR(shear_energy(make_shear(g.mesh), x), 0.5 * fabric.shear_n_m * angle * angle * 0.04,
              1e-3 * fabric.shear_n_m * angle * angle * 0.04);
}

TEST(Shear, stiffness_with_what_is_left_out_of_it_is_minus_force_gradient) {
  const Grid g = make_grid(5, 0.1);
  ShearEffect effect(g.mesh);
  expect_jacobian(effect, g.mesh, jittered(g.x, 0.004, 5), 1e-5, true);
}

TEST(Bending, force_is_minus_energy_gradient) {
  const Grid g = make_grid(5, 0.1);
  BendingEffect effect(g.mesh);
  expect_gradient(effect, g.mesh, jittered(g.x, 0.004, 6));
}

TEST(Bending, stiffness_is_minus_force_gradient) {
  const Grid g = make_grid(5, 0.1);
  BendingEffect effect(g.mesh);
  expect_jacobian(effect, g.mesh, jittered(g.x, 0.004, 7), 1e-5);
}

TEST(Bending, flat_cloth_in_any_pose_has_no_bending_force) {
  const Grid g = make_grid(6, 0.1);
  const Eigen::AngleAxisd turn(0.7, Vec3(1, 2, 3).normalized());
  auto x = g.x;
  for (Vec3& p : x)
    p = turn * p + Vec3(1, 2, 3);
  EXPECT_LT(bending_energy(g.mesh, x), 1e-18);
}

TEST(Forces, of_cloth_turned_and_moved_turn_with_it) {
  const Grid g = make_grid(5, 0.1);
  const auto x = jittered(g.x, 0.004, 10);
  EdgeSpringEffect springs(g.mesh);
  ShearEffect shear(g.mesh);
  BendingEffect bending(g.mesh);
  SewingSpringEffect sewing({{0, 7}, {3, 20}}, 50, 0.02);
  expect_rigid_motion_invariance(springs, g.mesh, x);
  expect_rigid_motion_invariance(shear, g.mesh, x);
  expect_rigid_motion_invariance(bending, g.mesh, x);
  expect_rigid_motion_invariance(sewing, g.mesh, x);
}

TEST(Gravity, force_is_minus_energy_gradient) {
  const Grid g = make_grid(4, 0.1);
  GravityEffect effect(g.mesh, Vec3(0.3, -9.80665, 0.1));
  expect_gradient(effect, g.mesh, jittered(g.x, 0.004, 8), false);
}

TEST(SewingSpring, force_is_minus_energy_gradient_within_reach_and_beyond) {
  const Grid g = make_grid(4, 0.1);
  for (double reach : {0.01, 0.05, 1.0}) {
    SewingSpringEffect effect({{0, 1}, {2, 9}, {0, 15}}, 50, reach);
    expect_gradient(effect, g.mesh, jittered(g.x, 0.004, 9));
  }
}

TEST(ClothMesh, masses_add_up_to_area_density_times_area) {
  Fabric fabric;
  const Grid g = make_grid(9, 0.3, fabric);
  double mass = 0;
  for (double m : g.mesh.mass)
    mass += m;
  EXPECT_NEAR(mass, fabric.density_kg_m2 * 0.09, 1e-12);
}

TEST(ClothMesh, tension_of_a_stretched_strip_is_the_stretch_stiffness) {
  Fabric fabric;
  fabric.stretch_warp_n_m = fabric.stretch_weft_n_m = 1000;
  const Grid g = make_grid(21, 0.2, fabric);
  auto x = g.x;
  const double strain = 1e-3;
  for (Vec3& p : x)
    p *=
        1 +
        strain; // all-round stretch: energy per area is Y strain^2 / (1 - nu), nu = 1/3 for springs
  const double energy = edge_springs_energy(g.mesh, x) / 0.04;
  EXPECT_NEAR(energy, 1000 * strain * strain / (1 - 1.0 / 3), 0.12 * energy);
}
