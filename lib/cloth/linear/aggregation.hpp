#pragma once
/// Smoothed aggregation as a CG preconditioner (Vanek, Mandel, Brezina 1996) for blocks of 3x3.
///
/// Near-null space: the three translations. Greedy aggregation over strong couplings, prolongator
/// smoothed by one step of block Jacobi, Chebyshev smoother of degree 2, coarsest level factorised.
/// There is no geometric coarsening, so narrow straps are no special case. The hierarchy lags: it
/// is rebuilt, within a solve too, only where the iterations that it costs have grown by what a new
/// one costs; the finest level always sees the current matrix. It is built in double and applied in
/// single precision, and the conjugate gradients run on the finest level in single precision too:
/// refinement in double has the last word. Of systems that recur, solves begin with the basis of
/// the last ones (Deflation).
#include <Eigen/Dense>
#include <cloth/linear/deflation.hpp>
#include <cloth/linear/float_rows.hpp>
#include <sloper/cloth/linear/conjugate_gradient.hpp>

namespace sloper::cloth {

/// The hierarchy of one system that changes from step to step.
class Aggregation : public Preconditioner {
public:
  void update(const LinearSystem& system) override;
  void apply(const std::vector<Vec3>& r, std::vector<Vec3>& z) override;
  bool renew(const LinearSystem& system, int iterations) override;
  bool estimates_energy_error() const override { return true; }
  bool solve_in_single(const LinearSystem& system, const std::vector<Vec3>& r,
                       const CgLimits& limits, std::vector<Vec3>& x, CgResult& result) override;
  void report_iterations(int iterations) override;
  void reset() override {
    m_levels.clear();
    m_whole = {};
    m_deflation.forget();
  }
  long rebuilds = 0;
  /// Blocks of all levels' matrices over those of the finest: what a cycle costs in multiplications
  /// by the matrix. 1 without levels.
  double complexity() const;

private:
  struct Level {
    FloatRows a, p, pt; // matrix, prolongator to this level from the next, its transpose
    std::vector<FloatBlock> d_inverse;
    float lambda = 2; // largest eigenvalue of D^-1 A, bounded from above
    std::vector<Float4> r, z, t, d, eigenvector;
  };
  /// The vectors of conjugate gradients on the finest level; its r and z are theirs.
  struct SingleSpace;
  /// A contact as the finest level sees it.
  struct FloatContact {
    std::array<int, 4> particle;
    std::array<float, 4> weight; // 0 for those not in use
    Float4 normal;
    float normal_stiffness, tangent_stiffness;
  };
  void build(const LinearSystem& system);
  void copy_finest(const LinearSystem& system);
  void pull_contacts(const std::vector<Float4>& x);
  template<class Put>
  void multiply(std::size_t level, const std::vector<Float4>& x, const Put& put);
  template<class Put>
  void multiply_finest(const FloatRows& rows, const std::vector<Float4>& x, const Put& put);
  void multiply_system(const std::vector<Float4>& x, std::vector<Float4>& y);
  void deflate(const LinearSystem& system, const std::vector<Vec3>& r, double radius);
  void estimate_lambda(std::size_t level, int iterations);
  void smooth(std::size_t level, bool zero_start);
  void cycle(std::size_t level);
  void precondition_finest();
  double take_in(const std::vector<Vec3>& r);

  BlockJacobi m_jacobi;
  struct {
    BlockRows a, p, pt, ap;
  } m_build; // its work: kept for its memory
  std::vector<Float4> m_x, m_p, m_q;
  Deflation m_deflation;
  std::vector<double> m_part;
  FloatRows m_whole; // of the system's `whole`
  bool m_has_whole = false;
  std::vector<FloatContact> m_contacts;
  std::vector<Float4> m_contact_pull;
  const ContactIndex* m_index = nullptr; // of the system that the finest level is a copy of
  std::vector<Level> m_levels;
  bool m_coarsened = false; // whether the last build reached a coarsest level
  Eigen::LLT<Eigen::MatrixXd> m_coarsest;
  Eigen::VectorXd m_coarse_vector;
  int m_iterations_when_fresh = 0, m_last_iterations = 0, m_age = 0;
};

} // namespace sloper::cloth
