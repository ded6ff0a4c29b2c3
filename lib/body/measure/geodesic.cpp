#include <sloper/body/measure/geodesic.hpp>

#include <algorithm>

namespace sloper::body {

namespace {

/// The nearest first. Four children to a node: half as many levels as of a binary heap, each in one
/// or two lines of the cache.
class Nearest {
public:
  struct Item {
    double distance;
    int vertex;
  };
  bool empty() const { return m_items.empty(); }
  void push(const Item& item) {
    std::size_t at = m_items.size();
    m_items.push_back(item);
    while (at > 0 && item.distance < m_items[(at - 1) / CHILDREN].distance) {
      m_items[at] = m_items[(at - 1) / CHILDREN];
      at = (at - 1) / CHILDREN;
    }
    m_items[at] = item;
  }
  Item pop() {
    const Item first = m_items.front(), last = m_items.back();
    m_items.pop_back();
    const std::size_t n = m_items.size();
    std::size_t at = 0;
    while (CHILDREN * at + 1 < n) {
      const std::size_t begin = CHILDREN * at + 1, end = std::min(begin + CHILDREN, n);
      std::size_t least = begin;
      for (std::size_t child = begin + 1; child < end; ++child)
        if (m_items[child].distance < m_items[least].distance)
          least = child;
      if (last.distance <= m_items[least].distance)
        break;
      m_items[at] = m_items[least];
      at = least;
    }
    if (n > 0)
      m_items[at] = last;
    return first;
  }

private:
  static constexpr std::size_t CHILDREN = 4;
  std::vector<Item> m_items;
};

} // namespace

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
  Nearest queue; // which of two that are as far comes first changes no distance
  for (int s : sources) {
    distance[s] = 0;
    queue.push({0.0, s});
  }
  while (!queue.empty()) {
    const auto [d, v] = queue.pop();
    if (d > distance[v])
      continue;
    for (int i = m_first[v]; i < m_first[v + 1]; ++i) {
      const int w = m_neighbour[i];
      if (distance[w] <= d || (!blocked.empty() && blocked[w]))
        continue;
      const double next = d + (m_mesh->positions[w] - m_mesh->positions[v]).norm();
      if (next < distance[w] && next <= limit) {
        distance[w] = next;
        queue.push({next, w});
      }
    }
  }
  return distance;
}

} // namespace sloper::body
