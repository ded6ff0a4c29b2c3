/// A quadratic energy by pairs of particles is that of its matrix.
#include <support/force_checks.hpp>

#include <sloper/cloth/forces/pair_weights.hpp>

using namespace sloper;
using namespace sloper::cloth;

namespace {

constexpr int N = 6;

/// A symmetric matrix whose rows sum to 0, with entries of both signs.
Eigen::MatrixXd without_translations(int n, std::uint64_t seed) {
  Random random(seed);
  Eigen::MatrixXd k = Eigen::MatrixXd::Zero(n, n);
  for (int a = 0; a < n; ++a)
    for (int b = 0; b < a; ++b)
      k(a, b) = k(b, a) = random.uniform(-1, 1);
  k.diagonal() = -k.rowwise().sum();
  return k;
}

} // namespace

TEST(PairWeights, energy_force_and_stiffness_are_those_of_the_sum_of_what_was_added) {
  const std::vector<int> first{4, 0, 3}, second{3, 5, 0, 1}; // particle 2 is in none
  Eigen::MatrixXd all = Eigen::MatrixXd::Zero(N, N);
  PairWeights weights(N);
  for (const std::vector<int>& particle : {first, second}) {
    const auto n = static_cast<int>(particle.size());
    const Eigen::MatrixXd k = without_translations(n, static_cast<std::uint64_t>(n));
    weights.add(particle, k);
    for (int a = 0; a < n; ++a)
      for (int b = 0; b < n; ++b)
        all(particle[a], particle[b]) += k(a, b);
  }
  weights.pack();
  Couplings couplings;
  weights.declare(couplings.isotropic);
  EXPECT_EQ(couplings.isotropic.size(), 8U) << "each pair once";
  BlockMatrix matrix(N, couplings);
  weights.bind(matrix);
  const auto x = jittered(std::vector<Vec3>(N, Vec3(1, 2, 3)), 1, 7);
  Eigen::MatrixXd at(N, 3);
  for (int i = 0; i < N; ++i)
    at.row(i) = x[i].transpose();
  EXPECT_NEAR(weights.energy(x), 0.5 * (at.transpose() * all * at).trace(), 1e-13);
  std::vector<Vec3> force(N, Vec3(1, 1, 1)); // added to
  weights.add_force(x, 3, force);
  weights.add_stiffness(2, matrix);
  const Eigen::MatrixXd upper = dense(matrix);
  for (int i = 0; i < N; ++i) {
    EXPECT_NEAR((force[i] - Vec3(1, 1, 1) + 3 * (all.row(i) * at).transpose()).norm(), 0, 1e-13);
    for (int j = i; j < N; ++j)
      EXPECT_NEAR(upper(3 * i, 3 * j), 2 * all(i, j), 1e-14);
  }
}

TEST(PairWeights, nothing_added_is_nothing) {
  PairWeights weights(2);
  weights.pack();
  const std::vector<Vec3> x{Vec3(1, 0, 0), Vec3(0, 1, 0)};
  std::vector<Vec3> force(2, Vec3::Zero());
  weights.add_force(x, 1, force);
  EXPECT_EQ(weights.energy(x), 0);
  EXPECT_EQ(force[0], Vec3::Zero());
  EXPECT_EQ(PairWeights().energy({}), 0);
}
