#pragma once
/// Plane cuts of a closed skin. A section is a set of loops. A loop keeps its oriented
/// segments unchained: they suffice for area, centroid, extent and taut girth, and a
/// small gap does no harm.
/// Test: tests/body/measure/test_section.cpp
#include <optional>
#include <sloper/geometry/triangle_mesh.hpp>
#include <string>
#include <vector>
namespace sloper::body {

/// A plane with 2D coordinates (along u, along v); u, v, n = u x v are unit and
/// right-handed.
struct Plane {
  Vec3 origin = Vec3::Zero(), u = Vec3::UnitX(), v = Vec3::UnitY(); ///< origin in m
  /// Unit normal u x v.
  Vec3 normal() const { return u.cross(v); }
  /// Coordinates (u, v) of the foot of p on the plane, m.
  Vec2 flat(const Vec3& p) const { return {(p - origin).dot(u), (p - origin).dot(v)}; }
  /// The point with coordinates q, m: the inverse of flat().
  Vec3 point(const Vec2& q) const { return origin + q.x() * u + q.y() * v; }
};

/// The plane y = height with 2D coordinates (x, z).
Plane level_plane(double height);
/// A plane through `origin` square to `axis`; u is chosen as level as it can be.
Plane cross_plane(const Vec3& origin, const Vec3& axis);

/// One closed outline of a section, or an open one where the skin ends.
struct Loop {
  /// m, in the plane; walking along one has the body on the left
  std::vector<std::array<Vec2, 2>> segments;
  bool closed = true;           ///< false where the skin, or the subset that was cut, ends
  double area = 0;              ///< m2, positive for an outer loop
  Vec2 centroid = Vec2::Zero(); ///< of the area
  /// Corners of the bounding box, m; low > high for an empty loop.
  Vec2 low = Vec2::Constant(1e300), high = Vec2::Constant(-1e300);
  /// Middle of the bounding box and its extents, m.
  Vec2 center() const { return 0.5 * (low + high); }
  Vec2 size() const { return high - low; }
};

/// Fills area, centroid and extent from the segments.
void measure_loop(Loop& loop);

/// Loops of the cut of a mesh by a plane, the one with the largest |area| first; ties
/// keep mesh order. Loops of less than 1e-6 m2 are left out. O(triangles looked at).
/// @param subset  triangle numbers to look at; all when null
std::vector<Loop> cut(const TriangleMesh& mesh, const Plane& plane,
                      const std::vector<int>* subset = nullptr);

/// Spheres around triangles: many planes through the same few of them are cut without looking at
/// each corner.
class TriangleSpheres {
public:
  /// @param subset  triangle numbers of the mesh; only their spheres are kept
  TriangleSpheres(const TriangleMesh& mesh, const std::vector<int>& subset);
  /// The triangles of the subset that the plane may meet, in its order; valid until the next call.
  const std::vector<int>& near(const Plane& plane);

private:
  struct Sphere {
    Vec3 center;
    double radius;
    int triangle;
  };
  std::vector<Sphere> m_spheres;
  std::vector<int> m_near;
};

/// A mesh sorted by height, so that level cuts of a large one read little memory and in order.
class LevelledMesh {
public:
  /// @param y0 height of the middle of the lowest of `count` bands that are `dy` apart, m
  LevelledMesh(const TriangleMesh& mesh, double y0, double dy, int count);
  /// The loops of sloper::body::cut() at the level `y`, m, which is within `dy` of the middle of
  /// `band`.
  std::vector<Loop> cut(int band, double y) const;

private:
  struct Vertex {
    Vec3 position;
    int number; ///< in the mesh
  };
  struct Reach {
    float low, high; ///< m, rounded outwards
    Triangle vertices;
  };
  std::vector<Vertex> m_vertices;   ///< by height
  std::vector<Reach> m_reaches;     ///< band by band what it may meet, in mesh order
  std::vector<std::size_t> m_first; ///< of each band in m_reaches, and their number
};

/// Convex hull, counter-clockwise, without its collinear points.
std::vector<Vec2> convex_hull(std::vector<Vec2> points);
/// Length of the closed polygon.
double closed_length(const std::vector<Vec2>& polygon);
/// Taut (convex) girth of a loop.
double taut_girth(const Loop& loop);
/// The piece of a segment whose x (axis 0) or y (axis 1) lies within low .. high; empty
/// where there is none. Measures of a band of an outline then do not depend on the places
/// of mesh vertices.
std::optional<std::array<Vec2, 2>> clipped(const std::array<Vec2, 2>& segment, int axis, double low,
                                           double high);
/// The outermost place of a loop along the unit `direction`: of an outline that is nearly
/// square to it, the middle of the part within `flat`, m, of the extreme.
Vec2 outermost(const Loop& loop, const Vec2& direction, double flat);
/// True when the loop's outline winds around q.
bool encloses(const Loop& loop, const Vec2& q);

} // namespace sloper::body
