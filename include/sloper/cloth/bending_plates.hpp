#pragma once
/// Bending by direction: the curvature of each triangle of cloth in its material axes, from the
/// hinges around it.
///
/// A hinge's vector q = sum_k c_k x_k vanishes for positions that are linear in the pattern, so for
/// quadratic ones it is linear in the second derivatives: q = r . (x_uu, x_vv, x_uv). The three
/// hinges of a triangle give three such equations; solved, they are the quadratic through its six
/// particles (as the control patch of the rotation-free shell triangle of Oñate and Flores 2005),
/// so that a cylinder curved along any direction of the pattern has the energy
///   E = 1/2 A (Bu |x_uu|^2 + Bv |x_vv|^2 + 2 Bc x_uu . x_vv + 4 Bt |x_uv|^2)
/// of the orthotropic plate (Timoshenko and Woinowsky-Krieger 1959, section 85), whatever the mesh.
/// Triangles at an edge, with fewer hinges, take those of their neighbours too, by least squares,
/// and what is left of these has an energy of its own.
#include <Eigen/Dense>
#include <sloper/cloth/cloth_mesh.hpp>

namespace sloper::cloth {

/// Rigidities of an orthotropic plate, N m. Bending along a direction at the angle a from warp:
/// warp cos^4 a + weft sin^4 a + (2 coupling + 4 twist) sin^2 a cos^2 a.
struct PlateRigidity {
  /// Bu, Bv, Bc and Bt of the energy in the file comment, N m.
  double warp = 0, weft = 0, coupling = 0, twist = 0;
};

/// Whether rigidities by direction were measured, or softening.
bool bends_by_direction(const Fabric& fabric);

/// Smallest rigidity at 45 degrees that a stable plate can have, N m: (sqrt(warp) - sqrt(weft))^2 /
/// 4.
double least_bias_rigidity(double warp, double weft);

/// The plate with the fabric's rigidities along warp, weft and bias. One that was not measured:
/// warp and weft are bend_n_m, the bias that of Huber 1923, (warp + weft) / 4 + sqrt(warp weft)
/// / 2. The coupling is 0, as yarns hardly have one, unless the bias is softer than that allows. A
/// bias below least_bias_rigidity() is taken as that.
PlateRigidity plate_rigidity(const Fabric& fabric);

/// Rigidity of a cylinder curved along the bias, N m, from that of a narrow strip cut there, as a
/// cantilever has it: such a strip twists, so that its compliance is 4 / strip = 1 / warp + 1 /
/// weft + 1 / twist (Timoshenko and Woinowsky-Krieger 1959). At most a quarter more than the
/// strip's: real strips are not narrow, and their clamp keeps them from twisting.
double bias_of_strip(double warp, double weft, double strip);

/// Rigidity of a cylinder curved along the direction at `angle` from warp, N m.
double rigidity_along(const PlateRigidity& plate, double angle_rad);

/// Bending of one triangle: S = q^T stiffness q, of the hinges' q; E = S / 2 of a linear fabric.
/// One that softens has E = (1 - s) S / 2 + s S0 (sqrt(1 + S / S0) - 1).
struct BendingPlate {
  std::vector<int> hinge;    ///< of the mesh, m of them
  Eigen::MatrixXd stiffness; ///< m by m, N m times a weight
  double soft_share = 0;     ///< s
  double soft_energy = 1;    ///< S0, J: S at the radius of curvature bend_soft_radius_m

  /// Energy from S, J. @param s J
  double energy(double s) const;
  /// 2 dE/dS: the share of the rigidity that is left.
  double secant(double s) const;
};

/// One for each triangle that has hinges, in the order of the triangles. O(triangles).
std::vector<BendingPlate> make_bending_plates(const ClothMesh& mesh);

} // namespace sloper::cloth
