#pragma once
/// Generalized winding number (Jacobson et al. 2013) of a triangle mesh, with the far field of each
/// tree node replaced by a series in its moments (Barill et al. 2018, second order). 1 inside, 0
/// outside, between in holes; needs no closed mesh.
#include <sloper/collision/triangle_tree.hpp>
namespace sloper::collision {

/// Solid angle of triangle abc seen from p over 4 pi (Van Oosterom and Strackee 1983), positive
/// where abc turns away from p.
double solid_angle_fraction(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c);

/// The far fields of one tree's nodes; at() needs the same tree.
class WindingNumber {
public:
  WindingNumber() = default;
  /// @param reach a node is taken as a whole from this many of its radii away; the error falls with
  /// the cube of it. Cost O(#F)
  explicit WindingNumber(const TriangleTree& tree, double reach = 2);
  /// Winding number about p; within about 0.005 of the exact sum (tested). O(log #F).
  double at(const TriangleTree& tree, const Vec3& p) const;

private:
  /// The far fields of a node's four subtrees, lane by lane: sum of n . d / |d|^3 expanded to
  /// second order in the offsets from its centre. Triangles have none: they are few once their node
  /// is near, and exact.
  struct alignas(16) FarField {
    float center[3][4], normal[3][4]; ///< area-weighted centre, m; sum of area times normal, m2
    float first[6][4];  ///< sum of n offset^T as a quadratic form: xx, yy, zz, xy, xz, yz, m3
    float linear[3][4]; ///< contracted second moments, m4
    /// Symmetrised second moments: coefficients of xxx yyy zzz xxy xxz yyx yyz zzx zzy
    /// xyz.
    float cubic[10][4];
    /// Squared distance from which the expansion serves; infinite where there is none.
    float reach2[4];
  };
  std::vector<FarField> m_far;
  std::vector<int> m_far_of_node; ///< -1 where all children are triangles
};

} // namespace sloper::collision
