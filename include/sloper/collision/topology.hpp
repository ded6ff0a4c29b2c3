#pragma once
/// Adjacency of a triangle mesh: edges, the edges of a triangle, the triangles of an edge
/// and of a vertex.
#include <sloper/geometry/types.hpp>
#include <span>
namespace sloper::collision {

/// The adjacency of one mesh, in flat arrays.
struct Topology {
  /// As geometry edges_of(): sorted pairs, lexicographic order.
  std::vector<std::array<int, 2>> edges;
  std::vector<std::array<int, 3>> triangle_edges; ///< edge k joins corners k and (k + 1) % 3
  /// Triangles of edge e: edge_triangle[edge_begin[e] .. edge_begin[e + 1]), ascending.
  std::vector<int> edge_begin, edge_triangle;
  /// The same of vertex v.
  std::vector<int> vertex_begin, vertex_triangle;

  /// Triangles at edge e, ascending; valid as long as the topology.
  std::span<const int> triangles_of_edge(int e) const {
    return {edge_triangle.data() + edge_begin[e], edge_triangle.data() + edge_begin[e + 1]};
  }
  /// Triangles at vertex v, ascending.
  std::span<const int> triangles_of_vertex(int v) const {
    return {vertex_triangle.data() + vertex_begin[v], vertex_triangle.data() + vertex_begin[v + 1]};
  }
};

/// Builds the adjacency. O(#F log valence).
/// @param n_vertices  greater than every index in `triangles`
Topology make_topology(std::size_t n_vertices, const std::vector<Triangle>& triangles);

} // namespace sloper::collision
