#pragma once
/// A quadratic energy of particles as one number for each pair of them:
///   E = 1/2 sum_(i<j) w_ij |x_i - x_j|^2,
/// which any energy 1/2 sum_ij k_ij x_i . x_j is that no translation changes (rows of k sum to 0),
/// with w_ij = -k_ij. Weights may be negative.
/// Test: tests/cloth/forces/test_pair_weights.cpp
#include <Eigen/Dense>
#include <sloper/cloth/linear/block_matrix.hpp>

#include <span>

namespace sloper::cloth {

/// Filled by add(), used after pack().
class PairWeights {
public:
  PairWeights() = default;
  /// No pairs yet. @param n  particles
  explicit PairWeights(int n) : m_filling(static_cast<std::size_t>(n)) {}
  /// Adds an energy 1/2 sum_ab k_ab x_a . x_b of a few particles.
  /// @param particle  m of them, each once
  /// @param k  m by m, symmetric, rows that sum to 0; N/m
  void add(std::span<const int> particle, const Eigen::MatrixXd& k);
  /// After the last add(). O(pairs)
  void pack();
  /// Of all pairs.
  void declare(std::vector<std::array<int, 2>>& pairs) const;
  /// @param matrix  that has the declared pairs
  void bind(const BlockMatrix& matrix);
  /// E at x, J. @param x  #P by 3, m
  double energy(const std::vector<Vec3>& x) const;
  /// Adds -scale dE/dx. @param force  #P by 3, N
  void add_force(const std::vector<Vec3>& x, double scale, std::vector<Vec3>& force) const;
  /// Adds scale times the second derivatives, multiples of the identity. @param matrix  as bound
  void add_stiffness(double scale, BlockMatrix& matrix) const;

private:
  struct Weight {
    int other; // the particle, above the row's
    double weight;
  };
  std::vector<std::vector<Weight>> m_filling; // rows, until they are packed
  std::vector<int> m_start;                   // #P + 1: rows of m_pair
  std::vector<Weight> m_pair;
  std::vector<double> m_diagonal; // #P: sums of the weights of a particle
  std::vector<int> m_slot;        // of m_pair
};

} // namespace sloper::cloth
