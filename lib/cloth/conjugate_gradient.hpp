#pragma once
/// Preconditioned conjugate gradients on block matrix plus contact elements.
#include <cloth/block_matrix.hpp>
#include <cloth/contact_element.hpp>

namespace sloper::cloth {

struct LinearSystem {
  const BlockMatrix& matrix;
  const std::vector<ContactElement>& elements;
  const ContactIndex& index; ///< of the elements
  /// y = A x; returns x . y. pull, part: work
  double multiply(const std::vector<Vec3>& x, std::vector<Vec3>& y, std::vector<Vec3>& pull, std::vector<double>& part) const;
};

/// z = P^-1 r for a symmetric positive definite P near the system.
class Preconditioner {
public:
  virtual ~Preconditioner() = default;
  virtual void update(const LinearSystem& system) = 0;
  virtual void apply(const std::vector<Vec3>& r, std::vector<Vec3>& z) = 0;
  /// The sparsity pattern has changed.
  virtual void reset() {}
  /// Asked within a solve that is not done after so many iterations: a preconditioner that lags may bring itself up to date, and returns
  /// true where it did.
  virtual bool renew(const LinearSystem&, int /*iterations*/) { return false; }
  /// How many iterations the last solve took since the preconditioner was last changed.
  virtual void report_iterations(int) {}
};

/// The inverted 3x3 diagonal blocks, contact elements included.
class BlockJacobi : public Preconditioner {
public:
  void update(const LinearSystem& system) override;
  void apply(const std::vector<Vec3>& r, std::vector<Vec3>& z) override;
  const std::vector<Mat3>& inverse() const { return m_inverse; }

private:
  std::vector<Mat3> m_inverse;
};

struct CgResult {
  int iterations = 0;
  int since_renewal = 0; ///< iterations with the preconditioner as it is now
  double residual = 1;   ///< |b - A x| / |b|
  bool converged = false;
  bool indefinite = false; ///< p'Ap <= 0 was met; x is the best iterate before
};

/// Work vectors, kept so that a step allocates nothing.
struct CgWork {
  std::vector<Vec3> r, z, p, q, pull;
  std::vector<double> part;
};

/// Solves A x = b from x = 0. Stops when |r| <= tolerance |b|, after max_iterations, or where the matrix is not definite.
CgResult conjugate_gradient(const LinearSystem& system, Preconditioner& preconditioner, const std::vector<Vec3>& b, double tolerance, int max_iterations,
                            std::vector<Vec3>& x, CgWork& work);

} // namespace sloper::cloth
