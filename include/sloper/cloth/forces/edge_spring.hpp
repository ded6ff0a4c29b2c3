#pragma once
/// Stretch by edge springs, Sul et al. 2010 eq. (6): f_i = k (|x_ij| - l0) u, u = x_ij/|x_ij|, x_ij
/// = x_j - x_i.
///
/// Stiffness block K = k [s (I - u u^T) + u u^T] with s = 1 - l0/|x_ij|. For a compressed spring s
/// < 0 and the system is indefinite, against the paper's claim; s is clamped at 0 (Choi and Ko
/// 2002).
/// Test: tests/cloth/forces/test_jacobians.cpp
#include <sloper/cloth/cloth_mesh.hpp>
#include <sloper/cloth/effect.hpp>
#include <sloper/cloth/linear/block_matrix.hpp>

namespace sloper::cloth {

/// Energy k/2 (|x_ij| - l0)^2 of one spring, J.
/// @param xi, xj  ends, m
/// @param rest_length  l0, m
/// @param stiffness  k, N/m
double edge_spring_energy(const Vec3& xi, const Vec3& xj, double rest_length, double stiffness);
/// Force on end i, N; on j its negative. Zero for coincident ends. Arguments as above.
Vec3 edge_spring_force(const Vec3& xi, const Vec3& xj, double rest_length, double stiffness);
/// -df_i/dx_i, N/m. Arguments as above.
/// @param clamp  leave out the negative part (false only in tests and for the exact
/// Newton matrix)
Mat3 edge_spring_stiffness(const Vec3& xi, const Vec3& xj, double rest_length, double stiffness,
                           bool clamp = true);

/// Adds force, stiffness and damping of all springs of the mesh.
/// @param x  #P by 3, m
/// @param h  time step, s; the damping block is damping_s/h times the stiffness along u
/// @param slots  #springs, from BlockMatrix::slot
/// @param force  #P by 3, N, added to
void add_edge_springs(const ClothMesh& mesh, const std::vector<Vec3>& x, double h,
                      const std::vector<int>& slots, std::vector<Vec3>& force,
                      BlockMatrix& stiffness);
/// Sum of the energies of all springs, J.
double edge_springs_energy(const ClothMesh& mesh, const std::vector<Vec3>& x);

/// The edge spring effect; reads rest lengths from the mesh in every step.
class EdgeSpringEffect : public Effect {
public:
  /// @param mesh  outlives the effect
  explicit EdgeSpringEffect(const ClothMesh& mesh) : m_mesh(mesh) {}
  const char* name() const override { return "edge_springs"; }
  void declare(Couplings& couplings) const override;
  void bind(const BlockMatrix& matrix) override;
  /// Potential at x, J.
  double energy(const std::vector<Vec3>& x) const override {
    return edge_springs_energy(m_mesh, x);
  }
  void add_indefinite_part(const std::vector<Vec3>& x, BlockMatrix& stiffness) const override;
  void add(StepContext& c) override {
    add_edge_springs(m_mesh, c.x, c.h, m_slots, c.force, c.stiffness);
  }

private:
  const ClothMesh& m_mesh;
  std::vector<int> m_slots;
};

} // namespace sloper::cloth
