#pragma once
/// Plane sections of the mannequin: tape lengths from the field (for fitting) and from the mesh
/// (for the truth).
#include "polygonise.hpp"
namespace sloper::samples {

struct Section2 {
  double girth_m = 0; ///< taut: perimeter of the convex hull
  double area = 0;    ///< of the hull, m2
  Vec3 low, high;     ///< extent along the axes, m
  Vec3 center;        ///< area centroid of the hull, m
  bool empty = true;
};

/// Hull of points that lie in the plane spanned by u and v (unit, square to each other).
Section2 hull_section(const std::vector<Vec3>& points, const Vec3& u, const Vec3& v);

/// Section of f by 90 rays from `center` in the plane (u, v): along each ray the first crossing
/// outward.
Section2 field_section(const Field& f, const Vec3& center, const Vec3& u, const Vec3& v,
                       double reach);

/// Section of a mesh by the plane through `point` square to `normal`, of triangles for which
/// keep(triangle) holds.
Section2 mesh_section(const TriangleMesh& mesh, const Vec3& point, const Vec3& normal,
                      const std::function<bool(const Triangle&)>& keep);

} // namespace sloper::samples
