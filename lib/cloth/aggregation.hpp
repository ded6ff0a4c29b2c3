#pragma once
/// Smoothed aggregation as a CG preconditioner (Vanek, Mandel, Brezina 1996) for blocks of 3x3.
///
/// Near-null space: the three translations. Greedy aggregation over strong couplings, prolongator smoothed by one step of
/// block Jacobi, Chebyshev smoother of degree 2, coarsest level factorised. There is no geometric coarsening, so narrow
/// straps are no special case. The hierarchy lags: it is rebuilt only where the iterations that it costs have grown; the
/// finest level always sees the current matrix.
#include <Eigen/Dense>
#include <cloth/conjugate_gradient.hpp>

namespace sloper::cloth {

/// Compressed rows of 3x3 blocks, both halves.
struct BlockRows {
  int rows = 0, columns = 0;
  std::vector<int> start, column;
  std::vector<Mat3> value;
};

class Aggregation : public Preconditioner {
public:
  void update(const LinearSystem& system) override;
  void apply(const std::vector<Vec3>& r, std::vector<Vec3>& z) override;
  void report_iterations(int iterations) override;
  void reset() override { m_levels.clear(); }
  long rebuilds = 0;

private:
  struct Level {
    BlockRows a, p, pt; // matrix (empty on level 0), prolongator to this level from the next, its transpose
    std::vector<Mat3> d_inverse;
    double lambda = 2; // largest eigenvalue of D^-1 A, bounded from above
    std::vector<Vec3> r, z, t, d, eigenvector;
  };
  void build(const LinearSystem& system);
  void multiply(std::size_t level, const std::vector<Vec3>& x, std::vector<Vec3>& y) const;
  void estimate_lambda(std::size_t level, int iterations);
  void smooth(std::size_t level, const std::vector<Vec3>& r, std::vector<Vec3>& z, bool zero_start);
  void cycle(std::size_t level);

  const LinearSystem* m_system = nullptr;
  BlockJacobi m_jacobi;
  std::vector<Level> m_levels;
  Eigen::LLT<Eigen::MatrixXd> m_coarsest;
  Eigen::VectorXd m_coarse_vector;
  int m_iterations_when_fresh = 0, m_last_iterations = 0, m_age = 0;
};

} // namespace sloper::cloth
