#pragma once
/// Symmetric sparse matrix of 3x3 blocks; only the diagonal and the upper triangle are stored, the pattern is fixed.
#include <geometry/types.hpp>
#include <vector>

namespace sloper::cloth {

/// Rows of blocks that one thread takes at a time.
inline constexpr std::size_t ROW_GRAIN = 512;

class BlockMatrix {
public:
  BlockMatrix() = default;
  /// @param n      block rows
  /// @param pairs  the off-diagonal blocks that may be filled, (i, j) in any order and any number of times
  BlockMatrix(int n, std::vector<std::array<int, 2>> pairs);

  int size() const { return m_n; }
  /// Index of block (min(i,j), max(i,j)) for add_off_diagonal; the pair must be in the pattern. O(log row).
  int slot(int i, int j) const;
  void set_zero();
  void add_diagonal(int i, const Mat3& block) { m_diagonal[i] += block; }
  /// Adds to block (i, j) with i < j in the order in which slot() was asked; pass the transpose otherwise.
  void add_off_diagonal(int slot, const Mat3& block) { m_value[slot] += block; }
  const Mat3& diagonal(int i) const { return m_diagonal[i]; }
  /// y = A x. Sizes n. Row by row, on all threads.
  void multiply(const std::vector<Vec3>& x, std::vector<Vec3>& y) const;
  /// Row i of it.
  Vec3 row_times(int i, const std::vector<Vec3>& x) const {
    Vec3 sum = m_diagonal[i] * x[i];
    for (int k = m_lower_start[i]; k < m_lower_start[i + 1]; ++k) sum.noalias() += m_value[m_lower[k].slot].transpose() * x[m_lower[k].column];
    for (int k = m_row_start[i]; k < m_row_start[i + 1]; ++k) sum.noalias() += m_value[k] * x[m_column[k]];
    return sum;
  }

  const std::vector<int>& row_start() const { return m_row_start; } ///< n + 1
  const std::vector<int>& column() const { return m_column; }
  const std::vector<Mat3>& value() const { return m_value; }
  /// The lower triangle, which is not stored: row i has the transposes of the blocks value()[lower()[k].slot], at column lower()[k].column,
  /// for k from lower_start()[i] to lower_start()[i + 1] - 1, by rising column.
  struct Mirrored {
    int slot, column;
  };
  const std::vector<int>& lower_start() const { return m_lower_start; } ///< n + 1
  const std::vector<Mirrored>& lower() const { return m_lower; }

private:
  int m_n = 0;
  std::vector<int> m_row_start, m_column, m_lower_start;
  std::vector<Mirrored> m_lower;
  std::vector<Mat3> m_value, m_diagonal;
};

} // namespace sloper::cloth
