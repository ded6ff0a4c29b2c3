#pragma once
/// The whole system factorised anew for every solve (Eigen's SimplicialLDLT): what an approximate
/// preconditioner is measured against. Conjugate gradients then end after one or two iterations.
/// Cost: that of a factorisation a step, O(#P^1.5) for cloth. Test:
/// tests/cloth/linear/test_linear_solver.cpp
#include <sloper/cloth/linear/conjugate_gradient.hpp>
#include <sloper/geometry/sparse_solver.hpp>

namespace sloper::cloth {

/// An exact preconditioner.
class Factorisation : public Preconditioner {
public:
  void update(const LinearSystem& system) override; ///< contact elements too
  void apply(const std::vector<Vec3>& r, std::vector<Vec3>& z) override;

private:
  SparseSolver m_solver;
};

} // namespace sloper::cloth
