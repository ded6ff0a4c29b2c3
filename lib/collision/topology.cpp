#include <sloper/collision/topology.hpp>

#include <algorithm>

namespace sloper::collision {

Topology make_topology(std::size_t n_vertices, const std::vector<Triangle>& triangles) {
  Topology topology;
  const auto n_triangles = static_cast<int>(triangles.size());

  // half-edges in buckets by their lower vertex, each bucket sorted by the higher one
  struct HalfEdge {
    int high, triangle, corner;
  };
  std::vector<int> begin(n_vertices + 1, 0);
  for (const Triangle& t : triangles)
    for (int k = 0; k < 3; ++k)
      ++begin[static_cast<std::size_t>(std::min(t[k], t[(k + 1) % 3])) + 1];
  for (std::size_t v = 0; v < n_vertices; ++v) begin[v + 1] += begin[v];
  std::vector<HalfEdge> half_edges(3 * triangles.size());
  std::vector<int> next(begin.begin(), begin.end() - 1);
  for (int f = 0; f < n_triangles; ++f)
    for (int k = 0; k < 3; ++k) {
      const int a = triangles[f][k], b = triangles[f][(k + 1) % 3];
      half_edges[next[std::min(a, b)]++] = {std::max(a, b), f, k};
    }
  topology.triangle_edges.resize(triangles.size());
  topology.edges.reserve(half_edges.size() / 2 + 1);
  topology.edge_begin.push_back(0);
  topology.edge_triangle.reserve(half_edges.size());
  for (std::size_t v = 0; v < n_vertices; ++v) {
    const auto first = half_edges.begin() + begin[v], last = half_edges.begin() + begin[v + 1];
    std::stable_sort(first, last,
                     [](const HalfEdge& a, const HalfEdge& b) { return a.high < b.high; });
    for (auto h = first; h != last; ++h) {
      if (h == first || h->high != (h - 1)->high) {
        if (!topology.edges.empty())
          topology.edge_begin.push_back(static_cast<int>(topology.edge_triangle.size()));
        topology.edges.push_back({static_cast<int>(v), h->high});
      }
      topology.triangle_edges[h->triangle][h->corner] = static_cast<int>(topology.edges.size()) - 1;
      topology.edge_triangle.push_back(h->triangle);
    }
  }
  if (!topology.edges.empty())
    topology.edge_begin.push_back(static_cast<int>(topology.edge_triangle.size()));

  topology.vertex_begin.assign(n_vertices + 1, 0);
  for (const Triangle& t : triangles)
    for (int v : t) ++topology.vertex_begin[static_cast<std::size_t>(v) + 1];
  for (std::size_t v = 0; v < n_vertices; ++v)
    topology.vertex_begin[v + 1] += topology.vertex_begin[v];
  topology.vertex_triangle.resize(3 * triangles.size());
  next.assign(topology.vertex_begin.begin(), topology.vertex_begin.end() - 1);
  for (int f = 0; f < n_triangles; ++f)
    for (int v : triangles[f]) topology.vertex_triangle[next[v]++] = f;
  return topology;
}

} // namespace sloper::collision
