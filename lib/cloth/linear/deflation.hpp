#pragma once
/// Ways that conjugate gradients need not find again (deflation: Nicolaides 1987; from one system
/// to the next: Saad, Yeung, Erhel and Guyomarc'h 2000, "A deflated version of the conjugate
/// gradient algorithm").
///
/// Steps to rest solve systems that change little from step to step, and what takes their
/// iterations are the same few soft ways: folds that open, cloth that slides. The last solutions
/// are mostly made of those. With W them, A-orthonormal, a solve of A x = b starts from the best x
/// in W, x = W W' b, and its directions are kept A-orthogonal to W: z - W (A W)' z in place of z =
/// P^-1 r, and what rounding brings back into r of W is taken out again with W W' r (A-DEF2 of
/// Tang, Nabben, Vuik and Erlangga 2009, "Comparison of two-level preconditioners"). Cost: a
/// multiplication by A for each way and solve, and three passes over each way and iteration. Test:
/// tests/cloth/linear/test_deflation.cpp
#include <cloth/linear/float_vectors.hpp>

#include <array>

namespace sloper::cloth {

class Deflation {
public:
  static constexpr std::size_t MOST = 4; ///< ways; with 2 a skirt took a fifth longer to rest, with
                                         ///< 6, 8 and 12 as long (means over 18 starts)

  /// Takes x, where a solve led, for the newest way, in place of the oldest.
  /// @param x  #rows, of any unit and length; 0 and what is no number are no ways, and left out by
  /// prepare()
  void keep(const std::vector<Float4>& x);
  void forget() { m_n_kept = m_n_ways = 0; }
  /// Makes W of what is kept, newest first, for a matrix of so many rows. Left out are ways that
  /// others have already, and those along which A is not definite. @param multiply  multiply(x, y)
  /// sets y = A x
  template<class Multiply> void prepare(std::size_t rows, const Multiply& multiply) {
    m_n_ways = 0;
    if (m_n_kept > 0 && m_kept[0].size() != rows) forget();
    for (std::size_t k = 0; k < m_n_kept; ++k) {
      m_way[m_n_ways] = m_kept[k];
      m_image[m_n_ways].resize(rows);
      multiply(m_way[m_n_ways], m_image[m_n_ways]);
      if (orthonormalise()) ++m_n_ways;
    }
  }
  /// W is nothing for this system.
  void leave_out() { m_n_ways = 0; }
  std::size_t n_ways() const { return m_n_ways; }
  /// From x = 0 with residual r to the best x in W. @param x, r  #rows
  void start(std::vector<Float4>& x, std::vector<Float4>& r);
  /// z += W (W' r - (A W)' z). @param r, z  #rows, the residual and P^-1 r
  void project(const std::vector<Float4>& r, std::vector<Float4>& z);

private:
  using Vectors = std::array<std::vector<Float4>, MOST>;
  using Shares = std::array<double, MOST>;
  bool orthonormalise();
  Shares shares(const Vectors& of, const std::vector<Float4>& v);
  void take(const Vectors& from, const Shares& shares, std::vector<Float4>& v) const;

  Vectors m_kept, m_way, m_image; // newest first; W and A W
  std::size_t m_n_kept = 0, m_n_ways = 0;
  std::vector<Shares> m_part; // work, by chunk
  std::vector<double> m_sum;  // work
};

} // namespace sloper::cloth
