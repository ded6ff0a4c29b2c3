/// Every force against finite differences of its energy, every stiffness against finite differences of its force.
#include "grid.hpp"

#include <Eigen/Eigenvalues>
#include <base/random.hpp>
#include <cloth/bending.hpp>
#include <cloth/edge_spring.hpp>
#include <cloth/gravity.hpp>
#include <cloth/sewing_spring.hpp>
#include <cloth/shear.hpp>
#include <gtest/gtest.h>

using namespace sloper;
using namespace sloper::cloth;

namespace {

std::vector<Vec3> jittered(std::vector<Vec3> x, double by, std::uint64_t seed) {
  Random random(seed);
  for (Vec3& p : x)
    for (int k = 0; k < 3; ++k) p[k] += random.uniform(-by, by);
  return x;
}

/// Force of one effect at x.
std::vector<Vec3> force_of(Effect& effect, int n, const std::vector<Vec3>& x, BlockMatrix& matrix) {
  std::vector<Vec3> force(n, Vec3::Zero());
  std::vector<ContactElement> elements;
  StepContext c{x, 1e30, force, matrix, elements}; // an endless step has no damping
  effect.add(c);
  return force;
}

/// -dE/dx of the effect's own energy() against the force that it adds.
template<class SomeEffect> void expect_gradient(SomeEffect& effect, const ClothMesh& mesh, const std::vector<Vec3>& x, bool keeps_momentum = true) {
  std::vector<std::array<int, 2>> pairs;
  effect.declare(pairs);
  BlockMatrix matrix(mesh.n_particles, pairs);
  effect.bind(matrix);
  const auto force = force_of(effect, mesh.n_particles, x, matrix);
  const double step = 1e-6;
  double scale = 0;
  for (const Vec3& f : force) scale = std::max(scale, f.norm());
  Vec3 total = Vec3::Zero();
  for (int i = 0; i < mesh.n_particles; ++i) {
    total += force[i];
    for (int k = 0; k < 3; ++k) {
      auto plus = x, minus = x;
      plus[i][k] += step;
      minus[i][k] -= step;
      EXPECT_NEAR(force[i][k], -(effect.energy(plus) - effect.energy(minus)) / (2 * step), 1e-5 * scale);
    }
  }
  if (keeps_momentum) {
    EXPECT_LT(total.norm(), 1e-10 * scale) << "momentum is not kept";
  }
}

/// -df/dx along a random direction against the assembled matrix, for states in which nothing is clamped.
void expect_jacobian(Effect& effect, const ClothMesh& mesh, const std::vector<Vec3>& x, double tolerance) {
  std::vector<std::array<int, 2>> pairs;
  effect.declare(pairs);
  BlockMatrix matrix(mesh.n_particles, pairs), unused(mesh.n_particles, pairs);
  effect.bind(matrix);
  force_of(effect, mesh.n_particles, x, matrix);
  const auto direction = jittered(std::vector<Vec3>(x.size(), Vec3::Zero()), 1, 5);
  const double step = 1e-7;
  auto plus = x, minus = x;
  for (std::size_t i = 0; i < x.size(); ++i) {
    plus[i] += step * direction[i];
    minus[i] -= step * direction[i];
  }
  const auto fp = force_of(effect, mesh.n_particles, plus, unused), fm = force_of(effect, mesh.n_particles, minus, unused);
  std::vector<Vec3> product(x.size());
  matrix.multiply(direction, product);
  double error = 0, scale = 0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    error = std::max(error, (product[i] + (fp[i] - fm[i]) / (2 * step)).norm());
    scale = std::max(scale, product[i].norm());
  }
  EXPECT_LT(error, tolerance * scale);
}

Eigen::MatrixXd dense(const BlockMatrix& m) {
  Eigen::MatrixXd a = Eigen::MatrixXd::Zero(3 * m.size(), 3 * m.size());
  for (int i = 0; i < m.size(); ++i) {
    a.block<3, 3>(3 * i, 3 * i) = m.diagonal(i);
    for (int k = m.row_start()[i]; k < m.row_start()[i + 1]; ++k) {
      a.block<3, 3>(3 * i, 3 * m.column()[k]) = m.value()[k];
      a.block<3, 3>(3 * m.column()[k], 3 * i) = m.value()[k].transpose();
    }
  }
  return a;
}

} // namespace

TEST(EdgeSpring, force_is_minus_energy_gradient) {
  const Grid g = make_grid(5, 0.1);
  EdgeSpringEffect effect(g.mesh);
  expect_gradient(effect, g.mesh, jittered(g.x, 0.004, 1));
}

TEST(EdgeSpring, stiffness_is_minus_force_gradient_when_stretched) {
  Grid g = make_grid(5, 0.1);
  for (Vec3& p : g.x) p *= 1.3; // all springs are longer than at rest, so nothing is clamped
  EdgeSpringEffect effect(g.mesh);
  expect_jacobian(effect, g.mesh, jittered(g.x, 0.0005, 2), 1e-5);
}

TEST(EdgeSpring, one_percent_compression_makes_the_unclamped_matrix_indefinite) {
  // The paper says that the left side of eq. (1) is always positive definite. It is not.
  const Vec3 a(0, 0, 0), b(0.0099, 0, 0);
  const double k = 1000, l0 = 0.01;
  Eigen::SelfAdjointEigenSolver<Mat3> exact(edge_spring_stiffness(a, b, l0, k, false)), clamped(edge_spring_stiffness(a, b, l0, k, true));
  EXPECT_LT(exact.eigenvalues()[0], -1.0);
  EXPECT_GE(clamped.eigenvalues()[0], -1e-9);
}

TEST(EdgeSpring, assembled_matrix_is_definite_at_any_compression) {
  for (double scale : {0.99, 0.9, 0.5, 0.1}) {
    Grid g = make_grid(5, 0.1);
    for (Vec3& p : g.x) p *= scale;
    EdgeSpringEffect effect(g.mesh);
    std::vector<std::array<int, 2>> pairs;
    effect.declare(pairs);
    BlockMatrix matrix(g.mesh.n_particles, pairs);
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
  for (Vec3& p : x) p.x() += angle * p.z();
  EXPECT_NEAR(shear_energy(make_shear(g.mesh), x), 0.5 * fabric.shear_n_m * angle * angle * 0.04, 1e-3 * fabric.shear_n_m * angle * angle * 0.04);
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
  for (Vec3& p : x) p = turn * p + Vec3(1, 2, 3);
  EXPECT_LT(bending_energy(g.mesh, x), 1e-18);
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
  for (double m : g.mesh.mass) mass += m;
  EXPECT_NEAR(mass, fabric.density_kg_m2 * 0.09, 1e-12);
}

TEST(ClothMesh, tension_of_a_stretched_strip_is_the_stretch_stiffness) {
  Fabric fabric;
  fabric.stretch_warp_n_m = fabric.stretch_weft_n_m = 1000;
  const Grid g = make_grid(21, 0.2, fabric);
  auto x = g.x;
  const double strain = 1e-3;
  for (Vec3& p : x) p *= 1 + strain; // all-round stretch: energy per area is Y strain^2 / (1 - nu), nu = 1/3 for springs
  const double energy = edge_springs_energy(g.mesh, x) / 0.04;
  EXPECT_NEAR(energy, 1000 * strain * strain / (1 - 1.0 / 3), 0.12 * energy);
}
