#pragma once
/// Stretch by the triangle condition, Sul et al. 2010 eq. (3)-(5) after Baraff and Witkin 1998,
/// section 4.2: C = sqrt(a) (|w_u| - b_u, |w_v| - b_v), E = 1/2 C^T diag(k_u, k_v) C, f_i =
/// -dC/dx_i^T k C.
///
/// b_u, b_v < 1 shrink weft or warp: the elastic bands of training wear, on the whole cloth or on a
/// region. (The source has C = a (...), whose stiffness depends on the mesh; with sqrt(a), k is the
/// tension per width at unit strain, N/m.) The stiffness is k a [du_i du_j (s (I - u u^T) + u u^T)]
/// with s = 1 - b/|w| clamped at 0: below rest the exact matrix is indefinite, as it is for edge
/// springs.
/// Test: tests/cloth/forces/test_jacobians.cpp
#include <sloper/cloth/effect.hpp>
#include <sloper/cloth/forces/triangle_map.hpp>

namespace sloper::cloth {

/// Rest lengths of a triangle relative to its rest shape.
struct Shrink {
  double weft = 1, warp = 1; ///< b_u, b_v > 0
};

/// The triangle stretch effect of a cloth.
class TriangleStretchEffect : public Effect {
public:
  /// @param shrink  #F or empty (no triangle shrinks)
  explicit TriangleStretchEffect(const ClothMesh& mesh, std::vector<Shrink> shrink = {});
  const char* name() const override { return "triangle_stretch"; }
  /// False: it is made with settings of the scene.
  bool set_rest(const ClothMesh& /*mesh*/) override { return false; }
  void declare(Couplings& couplings) const override { declare_pairs(m_maps, couplings.symmetric); }
  void bind(const BlockMatrix& matrix) override { find_slots(m_maps, matrix); }
  void add(StepContext& c) override;
  /// Potential at x, J.
  double energy(const std::vector<Vec3>& x) const override;
  void add_indefinite_part(const std::vector<Vec3>& x, BlockMatrix& stiffness) const override;

private:
  const ClothMesh& m_mesh;
  std::vector<TriangleMap> m_maps;
  std::vector<Shrink> m_shrink;
};

} // namespace sloper::cloth
