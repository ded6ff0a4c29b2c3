#pragma once
/// A uniform grid of bounds of the skin's displacement: a query near the hip can ignore the large
/// displacement of a moving hand.
///
/// Each cube keeps the bounds of the displacements of all triangles whose bounding boxes meet it.
/// Test: tests/collision/test_displacement_bounds.cpp
#include <sloper/geometry/triangle_mesh.hpp>

namespace sloper::collision {

/// The grid of one displacement of a skin.
class DisplacementBounds {
public:
  /// Builds the grid anew. O(#F) and the cubes of the region, of which there are no more
  /// than 2^17; allocates only to grow.
  /// @param displacement  #V by 3, m: displacement of the skin
  /// @param region  skin that does not meet it is left out
  /// @param radius  m, of later queries, about: cost only
  void build(const TriangleMesh& skin, const std::vector<Vec3>& displacement, const Box3& region,
             double radius);
  /// Bounds of the displacements of all skin in the region, m; empty without any.
  const Box3& all() const { return m_all; }
  /// The largest |displacement - own| over a box of displacements, m; 0 where it is empty.
  static double farthest(const Box3& bounds, const Vec3& own);
  /// An upper bound of |displacement - own| over all skin in the region that begins nearer to
  /// `place` than `radius`, m; 0 without any. O(1) at the radius given to build().
  double max_relative_displacement(const Vec3& own, const Vec3& place, double radius) const;

  /// Edge of a cube, m, or half the radius; more where the region is wide.
  static constexpr double CELL = 0.03;

private:
  std::array<int, 3> cube_of(const Vec3& place) const; ///< the nearest one of the region
  Box3& at(int i, int j, int k) { return m_cube[(i * m_n[1] + j) * m_n[2] + k]; }
  const Box3& at(int i, int j, int k) const { return m_cube[(i * m_n[1] + j) * m_n[2] + k]; }

  Box3 m_all; ///< of displacements, m
  Vec3 m_low = Vec3::Zero();
  double m_cell = CELL;
  std::array<int, 3> m_n{0, 0, 0};
  std::vector<Box3> m_cube; ///< of displacements
};

} // namespace sloper::collision
