#pragma once
/// Generalized winding number (Jacobson et al. 2013) of a triangle mesh, with the far field of each tree node replaced by a
/// series in its moments (Barill et al. 2018, second order). 1 inside, 0 outside, between in holes; needs no closed mesh.
#include <collision/triangle_tree.hpp>
namespace sloper::collision {

/// Solid angle of triangle abc seen from p over 4 pi (Van Oosterom and Strackee 1983), positive where abc turns away from p.
double solid_angle_fraction(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c);

class WindingNumber {
public:
  WindingNumber() = default;
  /// @param flipped  #F, true for triangles that count with their orientation turned; may be empty
  /// @param reach a node is taken as a whole from this many of its radii away; the error falls with the cube of it
  explicit WindingNumber(const TriangleTree& tree, const std::vector<char>& flipped = {}, double reach = 2);
  /// Winding number about p; within about 0.005 of the exact sum (tested). O(log #F).
  double at(const TriangleTree& tree, const Vec3& p) const;

private:
  /// The far field of one subtree: sum of n . d / |d|^3 expanded to second order in the offsets from its centre.
  struct Expansion {
    Vec3 center, area_normal;     ///< area-weighted centre, m; sum of area times normal, m2
    std::array<double, 6> first;  ///< sum of n offset^T as a quadratic form: xx, yy, zz, xy, xz, yz, m3
    Vec3 second_linear;           ///< contracted second moments, m4
    std::array<double, 10> cubic; ///< symmetrised second moments: coefficients of xxx yyy zzz xxy xxz yyx yyz zzx zzy xyz
    double reach2 = 0;            ///< squared distance from which the expansion serves
  };
  std::vector<std::array<Expansion, 4>> m_far; ///< per node and lane
  std::vector<char> m_flipped_slot;
};

} // namespace sloper::collision
