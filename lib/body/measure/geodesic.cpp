#include <sloper/body/measure/geodesic.hpp>

#include <algorithm>
#include <queue>

namespace sloper::body {

EdgeGraph::EdgeGraph(const TriangleMesh& mesh)
    : m_mesh(&mesh), m_first(mesh.positions.size() + 1, 0) {
  // every triangle gives each corner its other two: a neighbour over an inner edge stands twice,
  // which costs less than to look for it
  for (const Triangle& t : mesh.triangles)
    for (int k = 0; k < 3; ++k) {
      ++m_first[t[k] + 1];
      ++m_first[t[(k + 1) % 3] + 1];
    }
  for (std::size_t v = 1; v < m_first.size(); ++v)
    m_first[v] += m_first[v - 1];
  m_neighbour.resize(static_cast<std::size_t>(m_first.back()));
  std::vector<int> at(m_first.begin(), m_first.end() - 1);
  for (const Triangle& t : mesh.triangles)
    for (int k = 0; k < 3; ++k) {
      const int a = t[k], b = t[(k + 1) % 3];
      m_neighbour[at[a]++] = b;
      m_neighbour[at[b]++] = a;
    }
}

std::vector<double> EdgeGraph::distances(const std::vector<int>& sources, double limit,
                                         const std::vector<char>& blocked) const {
  std::vector<double> distance(m_mesh->positions.size(), 1e300);
  using Item = std::pair<double, int>;
  std::priority_queue<Item, std::vector<Item>, std::greater<>> queue;
  for (int s : sources) {
    distance[s] = 0;
    queue.emplace(0.0, s);
  }
  while (!queue.empty()) {
    const auto [d, v] = queue.top();
    queue.pop();
    if (d > distance[v])
      continue;
    for (int i = m_first[v]; i < m_first[v + 1]; ++i) {
      const int w = m_neighbour[i];
      if (distance[w] <= d || (!blocked.empty() && blocked[w]))
        continue;
      const double next = d + (m_mesh->positions[w] - m_mesh->positions[v]).norm();
      if (next < distance[w] && next <= limit) {
        distance[w] = next;
        queue.emplace(next, w);
      }
    }
  }
  return distance;
}

} // namespace sloper::body
