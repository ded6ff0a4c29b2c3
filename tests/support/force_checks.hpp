#pragma once
/// What every force must pass: minus the gradient of its energy, momentum kept, the matrix minus
/// the gradient of the force.
#include <support/grid.hpp>

#include <Eigen/Eigenvalues>
#include <gtest/gtest.h>
#include <sloper/base/random.hpp>
#include <sloper/cloth/effect.hpp>

namespace sloper::cloth {

inline std::vector<Vec3> jittered(std::vector<Vec3> x, double by, std::uint64_t seed) {
  Random random(seed);
  for (Vec3& p : x)
    for (int k = 0; k < 3; ++k)
      p[k] += random.uniform(-by, by);
  return x;
}

/// Force of one effect at x.
inline std::vector<Vec3> force_of(Effect& effect, int n, const std::vector<Vec3>& x,
                                  BlockMatrix& matrix) {
  std::vector<Vec3> force(n, Vec3::Zero());
  std::vector<ContactElement> elements;
  StepContext c{x, 1e30, force, matrix, elements}; // an endless step has no damping
  effect.add(c);
  return force;
}

/// -dE/dx of the effect's own energy() against the force that it adds.
template<class SomeEffect>
void expect_gradient(SomeEffect& effect, const ClothMesh& mesh, const std::vector<Vec3>& x,
                     bool keeps_momentum = true) {
  Couplings couplings;
  effect.declare(couplings);
  BlockMatrix matrix(mesh.n_particles, couplings);
  effect.bind(matrix);
  const auto force = force_of(effect, mesh.n_particles, x, matrix);
  const double step = 1e-6;
  double scale = 0;
  for (const Vec3& f : force)
    scale = std::max(scale, f.norm());
  Vec3 total = Vec3::Zero();
  for (int i = 0; i < mesh.n_particles; ++i) {
    total += force[i];
    for (int k = 0; k < 3; ++k) {
      auto plus = x, minus = x;
      plus[i][k] += step;
      minus[i][k] -= step;
      EXPECT_NEAR(force[i][k], -(effect.energy(plus) - effect.energy(minus)) / (2 * step),
                  1e-5 * scale);
    }
  }
  if (keeps_momentum) {
    EXPECT_LT(total.norm(), 1e-10 * scale) << "momentum is not kept";
  }
}

/// What is declared symmetric is, but for rounding.
inline void expect_blocks_as_declared(const BlockMatrix& matrix) {
  if (!matrix.all_symmetric())
    return;
  for (const Mat3& block : matrix.value())
    EXPECT_LE((block - block.transpose()).norm(), 1e-14 * block.norm());
}

/// -df/dx along a random direction against the assembled matrix: all of it, or for states in which
/// nothing is left out what add() gives.
inline void expect_jacobian(Effect& effect, const ClothMesh& mesh, const std::vector<Vec3>& x,
                            double tolerance, bool whole = false) {
  Couplings couplings;
  effect.declare(couplings);
  BlockMatrix matrix(mesh.n_particles, couplings), unused(mesh.n_particles, couplings);
  effect.bind(matrix);
  force_of(effect, mesh.n_particles, x, matrix);
  if (whole)
    effect.add_indefinite_part(x, matrix);
  expect_blocks_as_declared(matrix);
  const auto direction = jittered(std::vector<Vec3>(x.size(), Vec3::Zero()), 1, 5);
  const double step = 1e-7;
  auto plus = x, minus = x;
  for (std::size_t i = 0; i < x.size(); ++i) {
    plus[i] += step * direction[i];
    minus[i] -= step * direction[i];
  }
  const auto fp = force_of(effect, mesh.n_particles, plus, unused),
             fm = force_of(effect, mesh.n_particles, minus, unused);
  std::vector<Vec3> product(x.size());
  matrix.multiply(direction, product);
  double error = 0, scale = 0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    error = std::max(error, (product[i] + (fp[i] - fm[i]) / (2 * step)).norm());
    scale = std::max(scale, product[i].norm());
  }
  EXPECT_LT(error, tolerance * scale);
}

/// Turned and moved as a whole, cloth has the same energy and its forces turn with it; forces at
/// rest make no moment.
template<class SomeEffect>
void expect_rigid_motion_invariance(SomeEffect& effect, const ClothMesh& mesh,
                                    const std::vector<Vec3>& x) {
  Couplings couplings;
  effect.declare(couplings);
  BlockMatrix matrix(mesh.n_particles, couplings);
  effect.bind(matrix);
  const Mat3 turn = Eigen::AngleAxisd(0.8, Vec3(1, -2, 0.5).normalized()).toRotationMatrix();
  auto moved = x;
  for (Vec3& p : moved)
    p = turn * p + Vec3(0.3, -1, 2);
  const auto force = force_of(effect, mesh.n_particles, x, matrix),
             turned = force_of(effect, mesh.n_particles, moved, matrix);
  const double energy = effect.energy(x);
  EXPECT_NEAR(effect.energy(moved), energy, 1e-9 * std::abs(energy));
  double scale = 0;
  Vec3 moment = Vec3::Zero();
  for (std::size_t i = 0; i < x.size(); ++i)
    scale = std::max(scale, force[i].norm());
  for (std::size_t i = 0; i < x.size(); ++i) {
    EXPECT_LT((turned[i] - turn * force[i]).norm(), 1e-9 * scale);
    moment += x[i].cross(force[i]);
  }
  EXPECT_LT(moment.norm(), 1e-9 * scale) << "angular momentum is not kept";
}

inline Eigen::MatrixXd dense(const BlockMatrix& m) {
  Eigen::MatrixXd a = Eigen::MatrixXd::Zero(3 * m.size(), 3 * m.size());
  for (int i = 0; i < m.size(); ++i) {
    a.block<3, 3>(3 * i, 3 * i) = m.diagonal(i);
    for (int k = m.row_start()[i]; k < m.row_start()[i + 1]; ++k) {
      a.block<3, 3>(3 * i, 3 * m.column()[k]) = m.value()[k];
      a.block<3, 3>(3 * m.column()[k], 3 * i) = m.value()[k].transpose();
    }
    for (int k = m.isotropic_start()[i]; k < m.isotropic_start()[i + 1]; ++k)
      a.block<3, 3>(3 * i, 3 * m.isotropic()[k].column) =
          m.isotropic_value()[m.isotropic()[k].slot] * Mat3::Identity();
  }
  return a;
}
} // namespace sloper::cloth
