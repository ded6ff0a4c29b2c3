#pragma once
/// A sparse symmetric positive definite system, factorised once and solved often. Eigen's
/// factorisation, dear to compile, stays behind this.
#include <Eigen/SparseCore>
#include <memory>

namespace sloper {

class SparseSolver {
public:
  SparseSolver();
  explicit SparseSolver(const Eigen::SparseMatrix<double>& matrix); ///< analyses and factorises
  ~SparseSolver();
  SparseSolver(SparseSolver&&) noexcept;
  SparseSolver& operator=(SparseSolver&&) noexcept;

  void compute(const Eigen::SparseMatrix<double>& matrix); ///< analyses and factorises
  void analyse(const Eigen::SparseMatrix<double>&
                   pattern); ///< the order of elimination, for matrices of this pattern
  void factorise(const Eigen::SparseMatrix<double>& matrix); ///< after analyse()
  /// @param right  n by any number of columns, each solved for by itself
  Eigen::MatrixXd solve(const Eigen::Ref<const Eigen::MatrixXd>& right) const;

private:
  struct Impl;
  std::unique_ptr<Impl> m_impl;
};

} // namespace sloper
