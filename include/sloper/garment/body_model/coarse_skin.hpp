#pragma once
/// A dense scan's skin with as few triangles as its shape needs, for cloth to collide
/// with until it is at rest. The time of contact grows with the number of skin triangles
/// near the cloth, and a scan of 300,000 has ten times as many as a drape at 12 mm can
/// resolve.
///
/// Edges are collapsed by quadric error (Garland and Heckbert 1997; meshoptimizer). Its
/// vertices are some of the skin's, so it moves with the skin. Test:
/// tests/garment/body_model/test_coarse_skin.cpp
#include <sloper/geometry/triangle_mesh.hpp>

namespace sloper::garment {

/// The simplified skin, and which vertices of the full one it kept.
class CoarseSkin {
public:
  /// @param tolerance  m, root mean square distance of a triangle to the planes of those
  /// that it replaces. At 0.3 mm, of two scans of 280,000 and 360,000 triangles 99 % lies
  /// within 0.5 mm and all within 1.2 mm of a skin of a fifth of the triangles. About a
  /// second for 10^6 triangles.
  CoarseSkin(const TriangleMesh& skin, double tolerance);
  /// Some of the skin's vertices, in their order, and the triangles that are left.
  const TriangleMesh& mesh() const { return m_mesh; }
  /// Whether it has so few triangles that it is worth having: less than half of the skin's.
  bool pays() const { return 2 * m_mesh.triangles.size() < m_all; }
  /// Positions of mesh() for moved skin. @param skin as many as the skin has, m
  std::vector<Vec3> positions(const std::vector<Vec3>& skin) const;

private:
  TriangleMesh m_mesh;
  std::vector<int> m_source; // of the vertices, in the skin
  std::size_t m_all;         // triangles of the skin
};

} // namespace sloper::garment
