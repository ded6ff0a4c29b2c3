#pragma once
/// A sparse symmetric positive definite system, factorised once and solved often. The source holds
/// Eigen's part, slow to compile. Of a singular matrix solve() returns numbers without meaning.
#include <Eigen/SparseCore>
#include <memory>

namespace sloper {

/// The factorisation of one matrix; only the lower triangle is read.
class SparseSolver {
public:
  /// Empty; compute() or factorise() before solve().
  SparseSolver();
  explicit SparseSolver(const Eigen::SparseMatrix<double>& matrix); ///< analyses and factorises
  ~SparseSolver();
  SparseSolver(SparseSolver&&) noexcept;
  SparseSolver& operator=(SparseSolver&&) noexcept;

  void compute(const Eigen::SparseMatrix<double>& matrix); ///< analyses and factorises
  /// The order of elimination, for matrices of this pattern.
  void analyse(const Eigen::SparseMatrix<double>& pattern);
  void factorise(const Eigen::SparseMatrix<double>& matrix); ///< after analyse()
  /// @param right  n by any number of columns, each solved for by itself
  Eigen::MatrixXd solve(const Eigen::Ref<const Eigen::MatrixXd>& right) const;

private:
  struct Impl;
  std::unique_ptr<Impl> m_impl;
};

} // namespace sloper
