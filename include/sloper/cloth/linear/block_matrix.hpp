#pragma once
/// Symmetric sparse matrix of 3x3 blocks; only the diagonal and the upper triangle are stored, the
/// pattern is fixed. Blocks that are multiples of the identity are stored as one number: half of
/// those of cloth, where bending ties particles that no edge joins.
#include <sloper/geometry/types.hpp>
#include <vector>

namespace sloper::cloth {

/// Rows of blocks that one thread takes at a time.
inline constexpr std::size_t ROW_GRAIN = 512;

/// Pairs of particles whose blocks of a matrix may be filled, in any order and any number
/// of times; a pair in several lists is of the kind of the first of them.
struct Couplings {
  /// Pairs (i, j), i != j, with any blocks.
  std::vector<std::array<int, 2>> full;
  std::vector<std::array<int, 2>> symmetric; ///< with symmetric blocks only
  std::vector<std::array<int, 2>> isotropic; ///< with multiples of the identity only
};

/// A symmetric matrix of n by n blocks of 3 by 3.
class BlockMatrix {
public:
  BlockMatrix() = default;
  /// @param n          block rows
  /// @param couplings  the off-diagonal blocks that may be filled
  BlockMatrix(int n, Couplings couplings);

  /// Block rows.
  int size() const { return m_n; }
  /// Whether every block is symmetric by itself, by what was declared.
  bool all_symmetric() const { return m_all_symmetric; }
  /// Index of block (min(i,j), max(i,j)) for add_off_diagonal and add_isotropic. O(log row).
  /// @throws Error  it is not in the pattern
  int slot(int i, int j) const;
  /// Keeps the pattern.
  void set_zero();
  /// Adds to block (i, i).
  void add_diagonal(int i, const Mat3& block) { m_diagonal[i] += block; }
  /// Adds value times the identity to block (i, i).
  void add_isotropic_diagonal(int i, double value) { m_diagonal[i].diagonal().array() += value; }
  /// Adds to a block (i, j) that was declared full, with i < j in the order in which slot() was
  /// asked; pass the transpose otherwise.
  void add_off_diagonal(int slot, const Mat3& block) { m_value[slot] += block; }
  /// Adds value times the identity to any block.
  void add_isotropic(int slot, double value) {
    const std::size_t at = static_cast<std::size_t>(slot);
    if (at < m_value.size())
      m_value[at].diagonal().array() += value;
    else
      m_isotropic_value[at - m_value.size()] += value;
  }
  /// Block (i, i).
  const Mat3& diagonal(int i) const { return m_diagonal[i]; }
  /// y = A x. Sizes n. Row by row, on all threads.
  void multiply(const std::vector<Vec3>& x, std::vector<Vec3>& y) const;
  /// Row i of it.
  Vec3 row_times(int i, const std::vector<Vec3>& x) const {
    Vec3 sum = m_diagonal[i] * x[i];
    for (int k = m_lower_start[i]; k < m_lower_start[i + 1]; ++k)
      sum.noalias() += m_value[m_lower[k].slot].transpose() * x[m_lower[k].column];
    for (int k = m_row_start[i]; k < m_row_start[i + 1]; ++k)
      sum.noalias() += m_value[k] * x[m_column[k]];
    for (int k = m_isotropic_start[i]; k < m_isotropic_start[i + 1]; ++k)
      sum += m_isotropic_value[m_isotropic[k].slot] * x[m_isotropic[k].column];
    return sum;
  }

  /// The stored upper triangle, compressed by rows: row i has the blocks value()[k] at
  /// column()[k] for k from row_start()[i] to row_start()[i + 1] - 1.
  const std::vector<int>& row_start() const { return m_row_start; } ///< n + 1
  /// Columns of the stored blocks, and the blocks.
  const std::vector<int>& column() const { return m_column; }
  /// The stored blocks.
  const std::vector<Mat3>& value() const { return m_value; }
  /// Place of a block and its column.
  struct Entry {
    int slot, column; ///< index into the values; block column
  };
  const std::vector<int>& lower_start() const { return m_lower_start; } ///< n + 1
  const std::vector<Entry>& lower() const { return m_lower; }
  /// Of row i, both triangles: isotropic_value()[isotropic()[k].slot] times the identity at column
  /// isotropic()[k].column, for k from isotropic_start()[i] to isotropic_start()[i + 1] - 1, by
  /// rising column.
  const std::vector<int>& isotropic_start() const { return m_isotropic_start; } ///< n + 1
  const std::vector<Entry>& isotropic() const { return m_isotropic; }
  const std::vector<double>& isotropic_value() const { return m_isotropic_value; }

private:
  void lay_out_full(const std::vector<std::array<int, 2>>& pairs);
  void lay_out_isotropic(const std::vector<std::array<int, 2>>& pairs);

  int m_n = 0;
  bool m_all_symmetric = true;
  std::vector<int> m_row_start, m_column, m_lower_start, m_isotropic_start;
  std::vector<Entry> m_lower, m_isotropic;
  std::vector<Mat3> m_value, m_diagonal;
  std::vector<double> m_isotropic_value;
};

} // namespace sloper::cloth
