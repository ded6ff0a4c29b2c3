#pragma once
/// Stretch and shear by finite elements: constant-strain triangles of an orthotropic membrane, the
/// accuracy reference.
///
/// Green strain e_uu = (w_u.w_u - 1)/2, e_vv = (w_v.w_v - 1)/2, g = w_u.w_v; E = a/2 (C_uu e_uu^2 +
/// 2 C_uv e_uu e_vv + C_vv e_vv^2 + G g^2) (St. Venant-Kirchhoff). C follows from the two tensile
/// stiffnesses Y per width and Poisson's ratio nu of the softer pull: C_uu = Y_u / (1 - nu_uv
/// nu_vu), C_uv = nu_uv C_vv, nu_uv / Y_u = nu_vu / Y_v = nu / max(Y). It takes the place of edge
/// springs and shear. The stiffness keeps the material part and the definite part of the geometric
/// one.
/// Test: tests/cloth/forces/test_jacobians.cpp
#include <sloper/cloth/effect.hpp>
#include <sloper/cloth/forces/triangle_map.hpp>

namespace sloper::cloth {

/// The finite-element membrane of a cloth.
class MembraneEffect : public Effect {
public:
  /// @param mesh  read at construction
  explicit MembraneEffect(const ClothMesh& mesh);
  const char* name() const override { return "membrane"; }
  /// False: it is made with settings of the scene.
  bool set_rest(const ClothMesh& /*mesh*/) override { return false; }
  void declare(Couplings& couplings) const override { declare_pairs(m_maps, couplings.full); }
  void bind(const BlockMatrix& matrix) override { find_slots(m_maps, matrix); }
  void add(StepContext& c) override;
  /// Potential at x, J.
  double energy(const std::vector<Vec3>& x) const override;
  void add_indefinite_part(const std::vector<Vec3>& x, BlockMatrix& stiffness) const override;

private:
  struct Elasticity {
    double uu, uv, vv, shear; ///< N/m
    double damping_s;
  };
  /// By weft and warp, times the area, J.
  Eigen::Matrix2d stress_of(const TriangleMap& map, const Vec3& u, const Vec3& v) const;

  std::vector<TriangleMap> m_maps;
  std::vector<Elasticity> m_elasticity; ///< by fabric
};

} // namespace sloper::cloth
