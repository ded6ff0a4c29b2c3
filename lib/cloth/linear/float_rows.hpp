#pragma once
/// Sparse matrices of 3x3 blocks, in double to build a preconditioner and in single precision to
/// apply it.
#include <sloper/base/parallel.hpp>
#include <sloper/base/simd4.hpp>
#include <sloper/cloth/linear/block_matrix.hpp>

#include <algorithm>

namespace sloper::cloth {

/// Compressed rows of 3x3 blocks, both halves.
struct BlockRows {
  int rows = 0, columns = 0;
  std::vector<int> start, column;
  std::vector<Mat3> value;
};

/// A block by columns; the fourth lane of each is 0. Vectors are one Float4 a particle, the fourth
/// lane unused.
struct FloatBlock {
  Float4 column[3];
};
inline Float4 operator*(const FloatBlock& a, Float4 x) {
  return a.column[0] * lane<0>(x) + a.column[1] * lane<1>(x) + a.column[2] * lane<2>(x);
}

/// Numbers of eight rows, one each; aligned for the widest registers in use.
struct alignas(32) Float8 {
  float lane[8] = {};
};

/// Rows of 3x3 blocks, eight to a group, so that one instruction multiplies for eight rows (four,
/// where registers are narrower) and no lane idles. Each group has as many slots as its longest row
/// has blocks; a slot is one block of each row, 0 where a row has no more. Multiples of the
/// identity may be kept apart, as BlockMatrix does, and of blocks that are all symmetric one half
/// is kept. Sums go along each row in the order of its blocks, the isotropic ones last: the same
/// bytes whatever the registers.
class FloatRows {
public:
  static constexpr int GROUP = 8;
  struct Slot {
    int column[GROUP] = {};
  };
  FloatRows() = default;
  /// A pattern, all 0. Row i has blocks at `column`, from start[i] to start[i + 1] - 1, and
  /// isotropic ones in the same order (none if empty).
  /// @param symmetric  every block will be
  FloatRows(const std::vector<int>& start, const std::vector<int>& column,
            const std::vector<int>& isotropic_start, const std::vector<int>& isotropic_column,
            bool symmetric);
  /// Sets the k-th block of row i; of a symmetric one what is below the diagonal counts.
  void put(int i, int k, const Mat3& block) {
    float* lane = m_value[m_numbers * (m_start[i / GROUP] + k)].lane + i % GROUP;
    for (int c = 0; c < 3; ++c)
      for (int r = m_numbers == 9 ? 0 : c; r < 3; ++r, lane += GROUP)
        *lane = static_cast<float>(block(r, c));
  }
  /// Sets the k-th isotropic block of row i to value times the identity.
  void put_isotropic(int i, int k, double value) {
    m_isotropic_value[m_isotropic_start[i / GROUP] + k].lane[i % GROUP] = static_cast<float>(value);
  }
  int rows() const { return m_rows; }
  /// Blocks, isotropic ones and padding not counted.
  std::size_t blocks() const { return m_blocks; }
  /// put(i, row i of A x) for all rows, on all threads. The fourth lane of a row is 0.
  template<class Put> void multiply(const std::vector<Float4>& x, const Put& put) const {
    parallel_for(m_start.size() - 1, ROW_GRAIN / GROUP, [&](std::size_t begin, std::size_t end) {
      Float4 row[GROUP];
      for (std::size_t g = begin; g < end; ++g) {
        times(g, x.data(), row);
        const int first = static_cast<int>(g) * GROUP, last = std::min(first + GROUP, m_rows);
        for (int i = first; i < last; ++i)
          put(static_cast<std::size_t>(i), row[i - first]);
      }
    });
  }
  /// Turns the wide registers off, or on again where the processor has them: for tests. Not while
  /// another thread multiplies.
  static void allow_wide(bool allowed);

private:
  void times(std::size_t group, const Float4* x, Float4* row) const;

  int m_rows = 0;
  std::size_t m_blocks = 0, m_numbers = 9; // the latter of a block: nine, or six of a symmetric one
  std::vector<int> m_start = {0}, m_isotropic_start = {0}; // slots of each group
  std::vector<Slot> m_column, m_isotropic_column;
  std::vector<Float8> m_value,
      m_isotropic_value; // of each slot the block's columns, one after the other; one a slot
};

Float4 to_float(const Vec3& v);
FloatBlock to_float(const Mat3& m);
Vec3 to_double(Float4 v);
FloatRows to_float(const BlockRows& rows);

/// Whether m is a multiple of the identity.
inline bool is_isotropic(const Mat3& m) {
  const double* v = m.data();
  return v[0] == v[4] && v[0] == v[8] && v[1] == 0 && v[2] == 0 && v[3] == 0 && v[5] == 0 &&
         v[6] == 0 && v[7] == 0;
}

/// The whole matrix of a symmetric one that keeps its upper triangle; isotropic blocks come last in
/// a row.
void expand(const BlockMatrix& m, BlockRows& out);
/// The same in single precision, isotropic blocks apart.
FloatRows to_float(const BlockMatrix& m);
/// Writes the numbers of m into rows that to_float() made of the same pattern.
void refill(const BlockMatrix& m, FloatRows& rows);
/// The results' memory is used again; they are neither a nor b.
void transpose(const BlockRows& a, BlockRows& t);
void product(const BlockRows& a, const BlockRows& b, BlockRows& c);
std::vector<Mat3> block_diagonal(const BlockRows& a);

} // namespace sloper::cloth
