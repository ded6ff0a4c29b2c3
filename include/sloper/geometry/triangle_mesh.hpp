#pragma once
/// An indexed triangle mesh, and the queries that every module has of one.
/// Test: tests/geometry/test_triangle_mesh.cpp
#include <sloper/geometry/types.hpp>
namespace sloper {

/// Vertices and triangles.
struct TriangleMesh {
  std::vector<Vec3> positions;     ///< #V by 3, m
  std::vector<Triangle> triangles; ///< #F by 3, indices into positions; empty for a point cloud
};

/// An axis-aligned box, m.
struct Box3 {
  /// Opposite corners; low > high in an empty box.
  Vec3 low = Vec3::Constant(1e300), high = Vec3::Constant(-1e300);
  /// Extends the box to p.
  void add(const Vec3& p) {
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  }
  /// Whether no point was added; extents and middle, m, of a box that is not empty.
  bool empty() const { return low.x() > high.x(); }
  Vec3 size() const { return high - low; }
  Vec3 center() const { return 0.5 * (low + high); }
};

/// The box around points; empty for none.
Box3 bounding_box(const std::vector<Vec3>& points);

/// Twice the area times the unit normal, by the right-hand rule.
inline Vec3 area_normal(const Vec3& a, const Vec3& b, const Vec3& c) {
  return (b - a).cross(c - a);
}

/// Unit vertex normals weighted by the angle at the vertex (Thuermer and Wuethrich 1998). #V by 3;
/// zero where no triangle meets.
std::vector<Vec3> vertex_normals(const TriangleMesh& mesh);
/// The same normals, bit by bit, of the vertices with wanted[v] != 0 alone; others are no unit
/// vectors. @param wanted #V
std::vector<Vec3> vertex_normals(const TriangleMesh& mesh, const std::vector<char>& wanted);

/// Undirected edges, each once, as sorted pairs in lexicographic order.
std::vector<std::array<int, 2>> edges_of(const std::vector<Triangle>& triangles);
/// Edges that only one triangle has, in the same order.
std::vector<std::array<int, 2>> free_edges_of(const std::vector<Triangle>& triangles);

/// Component number of every vertex (0 is the component of the lowest vertex index); isolated
/// vertices have their own.
std::vector<int> connected_components(std::size_t n_vertices,
                                      const std::vector<Triangle>& triangles);

} // namespace sloper
