#pragma once
/// Bending by the angle between two triangles, with a rest angle per hinge: pressed creases, and
/// folds too sharp for the quadratic model. E = 1/2 B |e|^2 / (A0 + A1) (theta - theta0)^2, which
/// agrees with the isometric model for small angles; gradient after Bridson et al. 2003, section 4.
///
/// The stiffness keeps k dtheta dtheta^T, the definite part, which is exact at the rest angle.
/// Test: tests/cloth/forces/test_jacobians.cpp
#include <sloper/cloth/forces/bending.hpp>

namespace sloper::cloth {

/// Signed angle of a hinge at x, rad in (-pi, pi]; 0 flat. It turns sign with the order of the
/// particles 0, 1.
double hinge_angle(const Hinge& hinge, const std::vector<Vec3>& x);

/// The angle of a hinge, and its gradient with respect to the hinge's particles.
struct HingeAngle {
  double value = 0; ///< rad, as hinge_angle()
  /// 1/m.
  std::array<Vec3, 4> gradient{Vec3::Zero(), Vec3::Zero(), Vec3::Zero(), Vec3::Zero()};
  bool defined = false; ///< false where a triangle has collapsed: all is 0 then
};
/// Measures a hinge at x.
/// @param with_gradient  false: the gradient stays 0
HingeAngle measure_hinge(const Hinge& hinge, const std::vector<Vec3>& x, bool with_gradient);

/// Adds force and stiffness of a hinge with the energy E(theta).
/// @param angle  with gradient
/// @param moment  dE/dtheta, N m
/// @param k  d2E/dtheta2 with its damping, N m: the stiffness gets k dtheta dtheta^T
void add_hinge(StepContext& c, const Hinge& hinge, const HingeSlots& slots, const HingeAngle& angle,
               double moment, double k);

/// The dihedral bending effect.
class DihedralBendingEffect : public Effect {
public:
  /// @param rest_angle  #hinges or empty (all flat), rad, in the sign of hinge_angle()
  explicit DihedralBendingEffect(const ClothMesh& mesh, std::vector<double> rest_angle = {});
  const char* name() const override { return "dihedral_bending"; }
  /// From now on hinges are `times` (0 or more) as stiff as the mesh said when this was made.
  void set_scale(double times) { m_scale = times; }
  /// False: it is made with settings of the scene.
  bool set_rest(const ClothMesh& /*mesh*/) override { return false; }
  void declare(Couplings& couplings) const override;
  void bind(const BlockMatrix& matrix) override { m_slots = find_hinge_slots(m_mesh, matrix); }
  void add(StepContext& c) override;
  /// Potential at x, J.
  double energy(const std::vector<Vec3>& x) const override;

private:
  const ClothMesh& m_mesh;
  std::vector<double> m_rest_angle, m_stiffness; ///< by hinge; stiffness N m
  double m_scale = 1;                            ///< of all stiffness
  std::vector<HingeSlots> m_slots;
};

} // namespace sloper::cloth
