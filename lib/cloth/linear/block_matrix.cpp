#include <sloper/base/error.hpp>
#include <sloper/base/parallel.hpp>
#include <sloper/cloth/linear/block_matrix.hpp>

#include <algorithm>

namespace sloper::cloth {

/// Sorted, each once, the smaller index first; none of a particle with itself.
static void tidy(std::vector<std::array<int, 2>>& pairs) {
  for (auto& p : pairs)
    if (p[0] > p[1])
      std::swap(p[0], p[1]);
  std::sort(pairs.begin(), pairs.end());
  pairs.erase(std::unique(pairs.begin(), pairs.end()), pairs.end());
  pairs.erase(
      std::remove_if(pairs.begin(), pairs.end(), [](const auto& p) { return p[0] == p[1]; }),
      pairs.end());
}

/// Turns counts, each one place after its own, into where each row begins.
static void sum_up(std::vector<int>& start) {
  for (std::size_t i = 1; i < start.size(); ++i)
    start[i] += start[i - 1];
}

BlockMatrix::BlockMatrix(int n, Couplings couplings)
    : m_n(n), m_all_symmetric(couplings.full.empty()) {
  couplings.full.insert(couplings.full.end(), couplings.symmetric.begin(),
                        couplings.symmetric.end());
  tidy(couplings.full);
  tidy(couplings.isotropic);
  std::vector<std::array<int, 2>> isotropic; // those that no full block holds
  std::set_difference(couplings.isotropic.begin(), couplings.isotropic.end(),
                      couplings.full.begin(), couplings.full.end(), std::back_inserter(isotropic));
  lay_out_full(couplings.full);
  lay_out_isotropic(isotropic);
  m_diagonal.assign(static_cast<std::size_t>(n), Mat3::Zero());
}

/// Rows of the upper triangle, and for each row where its transposed blocks are.
void BlockMatrix::lay_out_full(const std::vector<std::array<int, 2>>& pairs) {
  m_row_start.assign(static_cast<std::size_t>(m_n) + 1, 0);
  for (const auto& p : pairs) {
    ++m_row_start[p[0] + 1];
    m_column.push_back(p[1]);
  }
  sum_up(m_row_start);
  m_lower_start.assign(static_cast<std::size_t>(m_n) + 1, 0);
  for (int j : m_column)
    ++m_lower_start[j + 1];
  sum_up(m_lower_start);
  m_lower.resize(m_column.size());
  std::vector<int> next(m_lower_start.begin(), m_lower_start.end() - 1);
  for (int i = 0; i < m_n; ++i)
    for (int k = m_row_start[i]; k < m_row_start[i + 1]; ++k) {
      const int at = next[m_column[k]]++;
      m_lower[at] = {k, i};
    }
  m_value.assign(m_column.size(), Mat3::Zero());
}

/// Each row has all its columns. Pairs are sorted by their first particle: going over their second
/// ones first gives a row its lower columns in rising order, and then its upper ones.
void BlockMatrix::lay_out_isotropic(const std::vector<std::array<int, 2>>& pairs) {
  m_isotropic_start.assign(static_cast<std::size_t>(m_n) + 1, 0);
  for (const auto& p : pairs)
    for (int i : p)
      ++m_isotropic_start[i + 1];
  sum_up(m_isotropic_start);
  m_isotropic.resize(2 * pairs.size());
  std::vector<int> next(m_isotropic_start.begin(), m_isotropic_start.end() - 1);
  for (int side : {1, 0})
    for (std::size_t k = 0; k < pairs.size(); ++k) {
      const int at = next[pairs[k][side]]++;
      m_isotropic[at] = {static_cast<int>(k), pairs[k][1 - side]};
    }
  m_isotropic_value.assign(pairs.size(), 0);
}

int BlockMatrix::slot(int i, int j) const {
  if (i > j)
    std::swap(i, j);
  const auto first = m_column.begin() + m_row_start[i],
             last = m_column.begin() + m_row_start[i + 1];
  const auto found = std::lower_bound(first, last, j);
  if (found != last && *found == j)
    return static_cast<int>(found - m_column.begin());
  const auto begin = m_isotropic.begin() + m_isotropic_start[i],
             end = m_isotropic.begin() + m_isotropic_start[i + 1];
  const auto entry =
      std::lower_bound(begin, end, j, [](const Entry& e, int column) { return e.column < column; });
  if (entry == end || entry->column != j)
    throw Error(ErrorKind::INTERNAL, "general.internal"_id, "", "",
                "a block outside of the matrix's pattern");
  return static_cast<int>(m_value.size()) + entry->slot;
}

void BlockMatrix::set_zero() {
  std::fill(m_value.begin(), m_value.end(), Mat3::Zero());
  std::fill(m_diagonal.begin(), m_diagonal.end(), Mat3::Zero());
  std::fill(m_isotropic_value.begin(), m_isotropic_value.end(), 0);
}

void BlockMatrix::multiply(const std::vector<Vec3>& x, std::vector<Vec3>& y) const {
  parallel_for(x.size(), ROW_GRAIN, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i)
      y[i] = row_times(static_cast<int>(i), x);
  });
}

} // namespace sloper::cloth
