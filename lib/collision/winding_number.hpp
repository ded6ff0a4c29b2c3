#pragma once
/// Generalized winding number (Jacobson et al. 2013) of a triangle mesh, with the far field of each tree node replaced by a
/// dipole (Barill et al. 2018, first order). 1 inside, 0 outside, between in holes; needs no closed mesh.
#include <collision/triangle_tree.hpp>
namespace sloper::collision {

/// Solid angle of triangle abc seen from p over 4 pi (Van Oosterom and Strackee 1983), positive where abc turns away from p.
double solid_angle_fraction(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c);

class WindingNumber {
public:
  WindingNumber() = default;
  /// @param flipped  #F, true for triangles that count with their orientation turned; may be empty
  /// @param reach a node is taken as a dipole from this many of its radii away; the error falls with its square or faster
  explicit WindingNumber(const TriangleTree& tree, const std::vector<char>& flipped = {}, double reach = 3);
  /// Winding number about p; within about 0.01 of the exact sum (tested). O(log #F).
  double at(const TriangleTree& tree, const Vec3& p) const;

private:
  struct Dipole {
    Vec3 center, area_normal; ///< area-weighted centre, m; sum of area times normal, m2
    double reach2 = 0;        ///< squared distance from which the dipole serves
  };
  std::vector<std::array<Dipole, 4>> m_dipoles; ///< per node and lane
  std::vector<char> m_flipped_slot;
};

} // namespace sloper::collision
