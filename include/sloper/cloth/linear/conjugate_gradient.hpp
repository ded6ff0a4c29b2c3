#pragma once
/// Preconditioned conjugate gradients on block matrix plus contact elements.
#include <sloper/cloth/contact/contact_element.hpp>
#include <sloper/cloth/linear/block_matrix.hpp>

#include <limits>

namespace sloper::cloth {

/// A x = b of one step, without b.
struct LinearSystem {
  const BlockMatrix& matrix;                   ///< definite; what preconditioners stand on
  const std::vector<ContactElement>& elements; ///< added to the matrix
  const ContactIndex& index;                   ///< of the elements
  /// Where not null, the full Hessian that is solved in place of `matrix`, of the same
  /// pattern; may be indefinite.
  const BlockMatrix* whole = nullptr;
  /// One of many systems that differ little, with similar solutions: the recycling basis
  /// of the last solves serves this one.
  bool recurs = false;
  /// y = A x.
  /// @param pull, part  work vectors
  /// @return x . y
  double multiply(const std::vector<Vec3>& x, std::vector<Vec3>& y, std::vector<Vec3>& pull,
                  std::vector<double>& part) const;
};

/// How a solve ended.
struct CgResult {
  int iterations = 0;     ///< so far
  int since_renewal = 0;  ///< iterations with the preconditioner as it is now
  double residual = 1;    ///< |b - A x| / |b|
  bool converged = false; ///< within the tolerance
  /// p'Ap <= 0 was met; x is the best iterate before, and with a radius, a step from
  /// there along p.
  bool indefinite = false;
  bool bounded = false; ///< x was stopped by the radius
  bool near = false;    ///< the energy tolerance ended it
};

/// When a solve of A x = b, from x = 0, is done: where either holds.
struct CgTolerance {
  /// Both relative; 0: that criterion never holds.
  CgTolerance(double of_residual, double of_energy = 0)
      : residual(of_residual), energy(of_energy) {}
  double residual; ///< |b - A x| over |b|
  /// sqrt(r' P^-1 r) over sqrt(b' P^-1 b), r = b - A x. With a preconditioner P that
  /// estimates_energy_error() A this is the error of x in the energy norm over that of 0, or of the
  /// start where the system recurs (Arioli 2004); with others it does not count. For stiff and soft
  /// modes together the energy error converges long before the residual, which stiff modes
  /// dominate.
  double energy;
};

/// Where a solve of A x = b, from x = 0, ends.
struct CgLimits {
  CgTolerance tolerance;  ///< of residual or energy
  int max_iterations = 0; ///< of all rounds together
  /// m, of the longest vector of three of x (Steihaug 1983).
  double radius = std::numeric_limits<double>::infinity();
};

/// z = P^-1 r for a symmetric positive definite P near the system.
class Preconditioner {
public:
  virtual ~Preconditioner() = default;
  /// Takes the values of the system of a new step; the pattern is that of before unless
  /// reset() came.
  virtual void update(const LinearSystem& system) = 0;
  /// z = P^-1 r. Sizes #P.
  virtual void apply(const std::vector<Vec3>& r, std::vector<Vec3>& z) = 0;
  /// True if P is spectrally equivalent to A, so that sqrt(r . z) estimates the error of a solve in
  /// the energy norm.
  virtual bool estimates_energy_error() const { return false; }
  /// The sparsity pattern has changed.
  virtual void reset() {}
  /// Asked within a solve that has made so many iterations: a preconditioner that lags
  /// may update itself, and returns true where it did.
  virtual bool renew(const LinearSystem&, int /*iterations*/) { return false; }
  /// An approximate solve of A x = r from x = 0 by a copy of the system in single
  /// precision: conjugate_gradient_loop(), until its recursive residual is within the
  /// tolerance, relative to r, or x at the radius. Adds to the result's iterations.
  /// @return false, with nothing done, for a preconditioner without such a copy
  virtual bool solve_in_single(const LinearSystem&, const std::vector<Vec3>& /*r*/, const CgLimits&,
                               std::vector<Vec3>& /*x*/, CgResult&) {
    return false;
  }
  /// Receives the number of iterations of the last solve since the preconditioner
  /// changed.
  virtual void report_iterations(int) {}
};

/// The inverted 3x3 diagonal blocks, contact elements included.
class BlockJacobi : public Preconditioner {
public:
  void update(const LinearSystem& system) override;
  void apply(const std::vector<Vec3>& r, std::vector<Vec3>& z) override;
  /// The inverted blocks, #P.
  const std::vector<Mat3>& inverse() const { return m_inverse; }

private:
  std::vector<Mat3> m_inverse;
};

/// The loop of preconditioned conjugate gradients, for vectors of any precision. It ends
/// where |r|^2 <= target2, where r . z <= energy^2 times its initial value or is not
/// above 0, at max_iterations of the result, which counts on, at an indefinite matrix, or
/// where x would get longer than the radius.
/// @param space  holds the vectors; r is the residual of x, on entry and later.
/// precondition() sets z = P^-1 r and returns r . z; turn(beta) sets p = z + beta p;
/// multiply() sets q = A p and returns p . q; advance(alpha) adds alpha p to x and takes
/// alpha q from r and returns |r|^2; longest_x() and longest_p() are the lengths of their
/// longest vectors of three; renew(iterations) as in Preconditioner
/// @param r_norm2  |r|^2 on entry
/// @param limits  its tolerance of the residual is not used
/// @return |r|^2
template<class Space>
double conjugate_gradient_loop(Space&& space, double r_norm2, double target2,
                               const CgLimits& limits, CgResult& result) {
  const double energy = limits.tolerance.energy;
  const bool bounded = limits.radius < std::numeric_limits<double>::infinity();
  result.indefinite = result.bounded = result.near = false;
  if (!(result.iterations < limits.max_iterations && r_norm2 > target2))
    return r_norm2;
  double rz = space.precondition();
  const double rz_end = energy * energy * rz;
  space.turn(0);
  for (;;) {
    const double curvature = space.multiply();
    result.indefinite = !(curvature > 0);
    if (result.indefinite && !bounded)
      break;
    ++result.iterations;
    ++result.since_renewal;
    const double room = bounded ? (limits.radius - space.longest_x()) / space.longest_p() : 0;
    result.bounded = bounded && !(curvature * room > rz);
    r_norm2 = space.advance(result.bounded ? room : rz / curvature);
    if (result.bounded || r_norm2 <= target2 || result.iterations >= limits.max_iterations)
      break;
    const bool renewed = space.renew(result.since_renewal);
    if (renewed)
      result.since_renewal = 0;
    const double rz_next = space.precondition();
    result.near = rz_next > 0 && rz_next <= rz_end;
    if (result.near || !(rz_next > 0))
      break;                                // the latter where rounding has the last word
    space.turn(renewed ? 0 : rz_next / rz); // with another preconditioner the directions start anew
    rz = rz_next;
  }
  return r_norm2;
}

/// Work vectors, kept so that a step allocates nothing.
struct CgWork {
  /// Residual, preconditioned residual, direction, A p, and work of the product; #P.
  std::vector<Vec3> r, z, p, q, pull;
  /// Partial sums.
  std::vector<double> part;
};

/// Solves A x = b from x = 0, until a limit is met or the matrix is not definite. Preconditioners
/// that solve in single precision do so in rounds whose residual is taken in double (iterative
/// refinement, Wilkinson 1963), as long as a round halves it; the rest is done in double. Does not
/// throw.
/// @param preconditioner  updated to the system by the caller
/// @param b  #P by 3
/// @param x  out, #P by 3
/// @param work  kept between calls
CgResult conjugate_gradient(const LinearSystem& system, Preconditioner& preconditioner,
                            const std::vector<Vec3>& b, const CgLimits& limits,
                            std::vector<Vec3>& x, CgWork& work);

} // namespace sloper::cloth
