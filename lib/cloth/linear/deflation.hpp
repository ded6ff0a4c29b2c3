#pragma once
/// Deflated conjugate gradients: recycles the last solutions as a basis W, so that recurring soft
/// modes are not resolved again (Nicolaides 1987; from one system to the next: Saad, Yeung, Erhel
/// and Guyomarc'h 2000, "A deflated version of the conjugate gradient algorithm").
///
/// Steps to rest solve systems that change little from step to step, and the same few soft modes
/// take the iterations: folds that open, cloth that slides. With W A-orthonormal, a solve of A x =
/// b starts from the best x in W, x = W W' b. Its directions are kept A-orthogonal to W: z - W (A
/// W)' z in place of z = P^-1 r. Rounding brings W back into r; W W' r takes it out again (A-DEF2
/// of Tang, Nabben, Vuik and Erlangga 2009, "Comparison of two-level preconditioners"). Cost: a
/// multiplication by A for each basis vector and solve, and three passes over each and iteration.
/// Test: tests/cloth/linear/test_deflation.cpp
#include <cloth/linear/float_vectors.hpp>

#include <array>

namespace sloper::cloth {

/// The basis W of one sequence of systems.
class Deflation {
public:
  /// Vectors of the basis. More save nothing: docs/decisions/linear-solver.md
  static constexpr std::size_t MAX_BASIS = 4;

  /// Keeps a solution as the newest basis vector, in place of the oldest.
  /// @param x  #rows, any scale; zero and non-finite vectors are ignored by prepare()
  void keep(const std::vector<Float4>& x);
  void forget() { m_n_kept = m_n_basis = 0; }
  /// Makes W of what is kept, newest first, for a matrix of so many rows. Left out are vectors that
  /// others have already, and those along which A is not definite. @param multiply  multiply(x, y)
  /// sets y = A x
  template<class Multiply> void prepare(std::size_t rows, const Multiply& multiply) {
    m_n_basis = 0;
    if (m_n_kept > 0 && m_kept[0].size() != rows)
      forget();
    for (std::size_t k = 0; k < m_n_kept; ++k) {
      m_basis[m_n_basis] = m_kept[k];
      m_image[m_n_basis].resize(rows);
      multiply(m_basis[m_n_basis], m_image[m_n_basis]);
      if (orthonormalise())
        ++m_n_basis;
    }
  }
  /// W is nothing for this system.
  void leave_out() { m_n_basis = 0; }
  std::size_t size() const { return m_n_basis; }
  /// From x = 0 with residual r to the best x in W. @param x, r  #rows
  void start(std::vector<Float4>& x, std::vector<Float4>& r);
  /// z += W (W' r - (A W)' z). @param r, z  #rows, the residual and P^-1 r
  void project(const std::vector<Float4>& r, std::vector<Float4>& z);

private:
  using Vectors = std::array<std::vector<Float4>, MAX_BASIS>;
  using Shares = std::array<double, MAX_BASIS>;
  bool orthonormalise();
  Shares shares(const Vectors& of, const std::vector<Float4>& v);
  void take(const Vectors& from, const Shares& shares, std::vector<Float4>& v) const;

  Vectors m_kept, m_basis, m_image; // newest first; W and A W
  std::size_t m_n_kept = 0, m_n_basis = 0;
  std::vector<Shares> m_part; // work, by chunk
  std::vector<double> m_sum;  // work
};

} // namespace sloper::cloth
