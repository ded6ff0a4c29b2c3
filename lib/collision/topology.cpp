#include <sloper/collision/topology.hpp>

#include <algorithm>

namespace sloper::collision {

namespace {

/// A side of a triangle, kept with its lower vertex.
struct HalfEdge {
  int high; ///< its other vertex
  int triangle;
  int corner; ///< where it begins in the triangle
};

/// Turns counts, each one place after its own, into where each run begins.
void sum_up(std::vector<int>& begin) {
  for (std::size_t k = 1; k < begin.size(); ++k)
    begin[k] += begin[k - 1];
}

/// All half-edges, by their lower vertex. @param begin  #V + 1, out: where those of a vertex begin
std::vector<HalfEdge> half_edges_by_low_vertex(std::size_t n_vertices,
                                               const std::vector<Triangle>& triangles,
                                               std::vector<int>& begin) {
  begin.assign(n_vertices + 1, 0);
  for (const Triangle& t : triangles)
    for (int k = 0; k < 3; ++k) {
      const int low = std::min(t[k], t[(k + 1) % 3]);
      ++begin[low + 1];
    }
  sum_up(begin);
  std::vector<HalfEdge> half_edges(3 * triangles.size());
  std::vector<int> next(begin.begin(), begin.end() - 1);
  for (int f = 0; f < std::ssize(triangles); ++f)
    for (int k = 0; k < 3; ++k) {
      const int a = triangles[f][k], b = triangles[f][(k + 1) % 3];
      const int at = next[std::min(a, b)]++;
      half_edges[at] = {std::max(a, b), f, k};
    }
  return half_edges;
}

void add_edges(Topology& topology, std::size_t n_vertices, const std::vector<Triangle>& triangles) {
  std::vector<int> begin;
  std::vector<HalfEdge> half_edges = half_edges_by_low_vertex(n_vertices, triangles, begin);
  topology.triangle_edges.resize(triangles.size());
  topology.edges.reserve(half_edges.size() / 2 + 1);
  topology.edge_begin.push_back(0);
  topology.edge_triangle.reserve(half_edges.size());
  for (std::size_t v = 0; v < n_vertices; ++v) {
    const auto first = half_edges.begin() + begin[v], last = half_edges.begin() + begin[v + 1];
    std::stable_sort(first, last,
                     [](const HalfEdge& a, const HalfEdge& b) { return a.high < b.high; });
    for (auto h = first; h != last; ++h) {
      const bool is_new = h == first || h->high != (h - 1)->high;
      if (is_new) {
        if (!topology.edges.empty())
          topology.edge_begin.push_back(std::ssize(topology.edge_triangle));
        topology.edges.push_back({static_cast<int>(v), h->high});
      }
      const int edge = static_cast<int>(topology.edges.size()) - 1;
      topology.triangle_edges[h->triangle][h->corner] = edge;
      topology.edge_triangle.push_back(h->triangle);
    }
  }
  if (!topology.edges.empty())
    topology.edge_begin.push_back(std::ssize(topology.edge_triangle));
}

void add_triangles_of_vertices(Topology& topology, std::size_t n_vertices,
                               const std::vector<Triangle>& triangles) {
  std::vector<int>& begin = topology.vertex_begin;
  begin.assign(n_vertices + 1, 0);
  for (const Triangle& t : triangles)
    for (int v : t)
      ++begin[v + 1];
  sum_up(begin);
  topology.vertex_triangle.resize(3 * triangles.size());
  std::vector<int> next(begin.begin(), begin.end() - 1);
  for (int f = 0; f < std::ssize(triangles); ++f)
    for (int v : triangles[f]) {
      const int at = next[v]++;
      topology.vertex_triangle[at] = f;
    }
}

} // namespace

Topology make_topology(std::size_t n_vertices, const std::vector<Triangle>& triangles) {
  Topology topology;
  add_edges(topology, n_vertices, triangles);
  add_triangles_of_vertices(topology, n_vertices, triangles);
  return topology;
}

} // namespace sloper::collision
