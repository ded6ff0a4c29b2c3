#include <sloper/geometry/sparse_solver.hpp>

#include <Eigen/SparseCholesky>

namespace sloper {

struct SparseSolver::Impl {
  Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> ldlt;
};

SparseSolver::SparseSolver() : m_impl(std::make_unique<Impl>()) {}
SparseSolver::SparseSolver(const Eigen::SparseMatrix<double>& matrix) : SparseSolver() {
  compute(matrix);
}
SparseSolver::~SparseSolver() = default;
SparseSolver::SparseSolver(SparseSolver&&) noexcept = default;
SparseSolver& SparseSolver::operator=(SparseSolver&&) noexcept = default;

void SparseSolver::compute(const Eigen::SparseMatrix<double>& matrix) {
  m_impl->ldlt.compute(matrix);
}
void SparseSolver::analyse(const Eigen::SparseMatrix<double>& pattern) {
  m_impl->ldlt.analyzePattern(pattern);
}
void SparseSolver::factorise(const Eigen::SparseMatrix<double>& matrix) {
  m_impl->ldlt.factorize(matrix);
}
Eigen::MatrixXd SparseSolver::solve(const Eigen::Ref<const Eigen::MatrixXd>& right) const {
  return m_impl->ldlt.solve(right);
}

} // namespace sloper
