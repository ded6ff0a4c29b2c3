#pragma once
/// Bending by the isometric model of Bergou et al. 2006 ("A quadratic bending model for
/// inextensible surfaces"): E = 1/2 B / (A0 + A1) |sum_k c_k x_k|^2 per hinge, rest state flat. Its
/// stiffness is constant and definite.
/// Test: tests/cloth/forces/test_jacobians.cpp
#include <sloper/cloth/cloth_mesh.hpp>
#include <sloper/cloth/effect.hpp>
#include <sloper/cloth/linear/block_matrix.hpp>

namespace sloper::cloth {

using HingeSlots = std::array<int, 6>; ///< blocks (0,1) (0,2) (0,3) (1,2) (1,3) (2,3)
/// Slots of all hinges in a matrix that has their pairs. #hinges
std::vector<HingeSlots> find_hinge_slots(const ClothMesh& mesh, const BlockMatrix& matrix);
/// Adds force and stiffness of one hinge whose energy depends on q = sum_k c_k x_k alone.
/// @param moment  dE/dq, N
/// @param k  d2E/dq2 of each coordinate, with its damping, N m times a weight
void add_hinge_vector(const Hinge& hinge, const HingeSlots& slots, const Vec3& moment, double k,
                      std::vector<Vec3>& force, BlockMatrix& stiffness);
/// Sum of E over all hinges, J.
double bending_energy(const ClothMesh& mesh, const std::vector<Vec3>& x);
/// Adds force, stiffness and damping of all hinges. The damping time is that of the first
/// fabric.
/// @param x  #P by 3, m
/// @param h  time step, s
/// @param slots  of find_hinge_slots()
/// @param force  #P by 3, N, added to
void add_bending(const ClothMesh& mesh, const std::vector<Vec3>& x, double h,
                 const std::vector<HingeSlots>& slots, std::vector<Vec3>& force,
                 BlockMatrix& stiffness);

/// The isometric bending effect; reads hinges from the mesh in every step.
class BendingEffect : public Effect {
public:
  /// @param mesh  outlives the effect
  explicit BendingEffect(const ClothMesh& mesh) : m_mesh(mesh) {}
  const char* name() const override { return "bending"; }
  void declare(Couplings& couplings) const override;
  void bind(const BlockMatrix& matrix) override { m_slots = find_hinge_slots(m_mesh, matrix); }
  /// Potential at x, J.
  double energy(const std::vector<Vec3>& x) const override { return bending_energy(m_mesh, x); }
  void add(StepContext& c) override {
    add_bending(m_mesh, c.x, c.h, m_slots, c.force, c.stiffness);
  }

private:
  const ClothMesh& m_mesh;
  std::vector<HingeSlots> m_slots;
};

} // namespace sloper::cloth
