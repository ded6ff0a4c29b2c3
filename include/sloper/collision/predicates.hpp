#pragma once
/// Exact signs of orientation determinants of double coordinates: a floating-point filter
/// (Shewchuk 1997), then exact expansion arithmetic where the filter cannot decide. Exact
/// unless a product under- or overflows (coordinates from 1e-70 to 1e70 are safe). Test:
/// tests/collision/test_intersections.cpp, against CGAL where it is found.
#include <sloper/geometry/types.hpp>
namespace sloper::collision {

/// Sign (-1, 0, 1) of det(a - d, b - d, c - d): positive where d is on the side of plane abc from
/// which abc turns clockwise.
int orientation(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d);
/// Sign of the area of abc projected along axis `drop` (0, 1, 2), in coordinates (drop + 1) % 3,
/// (drop + 2) % 3.
int projected_orientation(const Vec3& a, const Vec3& b, const Vec3& c, int drop);

/// True where the closed triangles share at least one point; exact. A zero-area triangle meets
/// nothing.
bool triangles_intersect(const std::array<Vec3, 3>& a, const std::array<Vec3, 3>& b);
/// True where segment pq and closed triangle t share a point and pq is not in the plane of t;
/// exact.
bool segment_crosses_triangle(const Vec3& p, const Vec3& q, const std::array<Vec3, 3>& t);

} // namespace sloper::collision
