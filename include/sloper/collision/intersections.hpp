#pragma once
/// Exact intersection audits of triangle meshes: which triangles cross each other, which edges pass
/// through which faces. Touching counts as crossing; pairs that share a vertex are not reported;
/// zero-area triangles meet nothing. Results are sorted, whatever the thread count. Test:
/// tests/collision/test_intersections.cpp
#include <sloper/collision/topology.hpp>
#include <sloper/collision/triangle_tree.hpp>
namespace sloper::collision {

/// All pairs (lower, higher) of triangles of one mesh that share no vertex and intersect.
/// @param x    #V by 3, m   @param tree built over `triangles` and refitted to x
std::vector<std::array<int, 2>> self_intersections(const std::vector<Vec3>& x,
                                                   const std::vector<Triangle>& triangles,
                                                   const TriangleTree& tree);

/// An edge that passes through a triangle.
struct EdgeFaceIntersection {
  int edge, triangle; ///< of the topology; of the triangles
  double t;           ///< [0, 1], point = (1 - t) x[edge[0]] + t x[edge[1]]
  Vec3 barycentric;   ///< of the point in the triangle
  Vec3 point;         ///< m
};
/// All edges that pass through a triangle with which they share no vertex, sorted by (edge,
/// triangle). An edge lying in the plane of the triangle is not listed.
std::vector<EdgeFaceIntersection> edge_face_intersections(const std::vector<Vec3>& x,
                                                          const std::vector<Triangle>& triangles,
                                                          const Topology& topology,
                                                          const TriangleTree& tree);

/// Indices, ascending, of those `triangles` over `positions` that intersect any triangle of `tree`.
std::vector<int> triangles_through(const std::vector<Vec3>& positions,
                                   const std::vector<Triangle>& triangles,
                                   const TriangleTree& tree);

} // namespace sloper::collision
