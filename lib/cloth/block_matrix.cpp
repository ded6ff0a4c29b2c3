#include <base/parallel.hpp>
#include <cloth/block_matrix.hpp>

#include <algorithm>

namespace sloper::cloth {

BlockMatrix::BlockMatrix(int n, std::vector<std::array<int, 2>> pairs) : m_n(n) {
  for (auto& p : pairs)
    if (p[0] > p[1]) std::swap(p[0], p[1]);
  std::sort(pairs.begin(), pairs.end());
  pairs.erase(std::unique(pairs.begin(), pairs.end()), pairs.end());
  m_row_start.assign(static_cast<std::size_t>(n) + 1, 0);
  for (const auto& p : pairs) {
    if (p[0] == p[1]) continue;
    ++m_row_start[p[0] + 1];
    m_column.push_back(p[1]);
  }
  for (int i = 0; i < n; ++i) m_row_start[i + 1] += m_row_start[i];
  m_lower_start.assign(static_cast<std::size_t>(n) + 1, 0);
  for (int j : m_column) ++m_lower_start[j + 1];
  for (int i = 0; i < n; ++i) m_lower_start[i + 1] += m_lower_start[i];
  m_lower.resize(m_column.size());
  std::vector<int> at(m_lower_start.begin(), m_lower_start.end() - 1);
  for (int i = 0; i < n; ++i)
    for (int k = m_row_start[i]; k < m_row_start[i + 1]; ++k) m_lower[at[m_column[k]]++] = {k, i};
  m_value.assign(m_column.size(), Mat3::Zero());
  m_diagonal.assign(static_cast<std::size_t>(n), Mat3::Zero());
}

int BlockMatrix::slot(int i, int j) const {
  if (i > j) std::swap(i, j);
  const auto first = m_column.begin() + m_row_start[i], last = m_column.begin() + m_row_start[i + 1];
  return static_cast<int>(std::lower_bound(first, last, j) - m_column.begin());
}

void BlockMatrix::set_zero() {
  std::fill(m_value.begin(), m_value.end(), Mat3::Zero());
  std::fill(m_diagonal.begin(), m_diagonal.end(), Mat3::Zero());
}

void BlockMatrix::multiply(const std::vector<Vec3>& x, std::vector<Vec3>& y) const {
  parallel_for(x.size(), ROW_GRAIN, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) y[i] = row_times(static_cast<int>(i), x);
  });
}

} // namespace sloper::cloth
