#pragma once
/// Closest points between points, segments and triangles (Ericson, Real-Time Collision Detection,
/// 2005, ch. 5), made robust: zero-length edges, slivers, zero-area triangles and parallel edges
/// give a true closest pair, never NaN for finite input. Pure functions, no allocation. Test:
/// tests/collision/test_distance.cpp
#include <sloper/geometry/types.hpp>
namespace sloper::collision {

/// The part of a triangle on which a point lies: 0, 1, 2 corner; 3, 4, 5 edge k-3 from corner k-3
/// to the next; 6 interior.
inline constexpr int FEATURE_EDGE = 3, FEATURE_FACE = 6;

/// Closest point of a segment.
struct PointEdge {
  double squared_distance; ///< m2
  double t;                ///< [0, 1], the closest point is a + t (b - a)
};
/// Point p to segment ab, m; a zero-length segment is its point a.
PointEdge point_edge(const Vec3& p, const Vec3& a, const Vec3& b);

/// Closest point of a triangle.
struct PointTriangle {
  double squared_distance; ///< m2
  Vec3 barycentric;        ///< weights of a, b, c; each in [0, 1], sum 1
  Vec3 point;              ///< closest point, m
  int feature;             ///< 0..6, see above
};
/// Point p to triangle abc, m.
PointTriangle point_triangle(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c);

/// Closest points of two segments.
struct EdgeEdge {
  double squared_distance; ///< m2
  double s, t;             ///< [0, 1], closest points a0 + s (a1 - a0) and b0 + t (b1 - b0)
};
/// Segment a0a1 to segment b0b1. For parallel segments one of the many closest pairs, with an end
/// point in it.
EdgeEdge edge_edge(const Vec3& a0, const Vec3& a1, const Vec3& b0, const Vec3& b1);

} // namespace sloper::collision
