#include <pattern/seams/open_rims.hpp>

namespace sloper::pattern {

OpenRims::OpenRims(const Pattern& pattern, const std::vector<SeamSide>& sides)
    : m_n(sides.size()), m_next(sides.size(), -1), m_last(sides.size(), -1),
      m_parts(pattern.panels.size()) {
  std::vector<std::vector<int>> node_of; // by panel and edge
  for (const Panel& panel : pattern.panels)
    node_of.emplace_back(static_cast<std::size_t>(panel.n_edges()), -1);
  for (std::size_t k = 0; k < sides.size(); ++k) {
    const SeamSide& s = sides[k];
    m_panel.push_back(s.panel);
    for (int e = 0; e < s.count; ++e)
      node_of[s.panel][s.loop_begin + (s.first - s.loop_begin + e) % s.loop_size] =
          static_cast<int>(k);
  }
  for (std::size_t p = 0; p < pattern.panels.size(); ++p) {
    int begin = 0;
    for (const auto& loop : pattern.panels[p].loops) {
      std::vector<int> nodes;
      for (int e = 0; e < std::ssize(loop); ++e) {
        int node = node_of[p][begin + e];
        if (node < 0) {
          node = std::ssize(m_next);
          m_next.push_back(-1);
          m_last.push_back(-1);
        }
        if (nodes.empty() || nodes.back() != node)
          nodes.push_back(node);
      }
      if (nodes.size() > 1 && nodes.front() == nodes.back())
        nodes.pop_back();
      for (std::size_t k = 0; k < nodes.size(); ++k) {
        const int next = nodes[(k + 1) % nodes.size()];
        m_next[nodes[k]] = next;
        m_last[next] = nodes[k];
      }
      begin += static_cast<int>(loop.size());
    }
  }
  m_sewn.assign(m_next.size(), 0);
}

bool OpenRims::same_rim(int i, int j) const {
  for (int k = m_next[i]; k != i; k = m_next[k])
    if (k == j)
      return true;
  return i == j;
}

void OpenRims::sew(int i, int j) {
  const auto link = [&](int from, int to) {
    m_next[from] = to;
    m_last[to] = from;
  };
  const int before_i = m_last[i], after_i = m_next[i], before_j = m_last[j], after_j = m_next[j];
  m_sewn[i] = m_sewn[j] = 1;
  if (after_i != j && before_j != i)
    link(before_j, after_i);
  if (after_j != i && before_i != j)
    link(before_i, after_j);
  m_parts.unite(m_panel[i], m_panel[j]);
}

std::vector<std::vector<int>> OpenRims::rims() const {
  std::vector<std::vector<int>> out;
  std::vector<char> seen = m_sewn;
  for (int k = 0; k < std::ssize(m_next); ++k) {
    if (seen[k])
      continue;
    std::vector<int>& rim = out.emplace_back();
    for (int node = k; !seen[node]; node = m_next[node]) {
      seen[node] = 1;
      if (node < static_cast<int>(m_n))
        rim.push_back(node);
    }
  }
  return out;
}

} // namespace sloper::pattern
