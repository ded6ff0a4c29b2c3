#pragma once
/// Shear by the triangle condition of Baraff and Witkin 1998, section 4.3: C = sqrt(a) w_u . w_v, E
/// = k/2 C^2.
///
/// w_u, w_v are the images of weft and warp; a the rest area. (The source writes C = a w_u . w_v,
/// whose stiffness depends on the mesh; with sqrt(a) k is the shear force per width at unit angle,
/// N/m.) The stiffness keeps k dC dC^T, the definite part.
/// Test: tests/cloth/forces/test_jacobians.cpp
#include <sloper/cloth/cloth_mesh.hpp>
#include <sloper/cloth/effect.hpp>
#include <sloper/cloth/linear/block_matrix.hpp>

namespace sloper::cloth {

/// The affine map of one triangle: w_u = sum_k du_k x_k, w_v = sum_k dv_k x_k.
struct ShearTriangle {
  Triangle particle;            ///< corners
  std::array<double, 3> du, dv; ///< 1/m
  double stiffness;             ///< k a, N m
  double damping_s;             ///< stiffness-proportional damping time
  std::array<int, 3> slots;     ///< blocks (0,1), (1,2), (2,0)
};

/// The maps of all triangles, without slots; #F.
std::vector<ShearTriangle> make_shear(const ClothMesh& mesh);
/// Fills the slots from a matrix that has the pairs of all triangles.
void find_slots(std::vector<ShearTriangle>& shear, const BlockMatrix& matrix);
/// Sum of E over all triangles, J.
double shear_energy(const std::vector<ShearTriangle>& shear, const std::vector<Vec3>& x);
/// Adds force, stiffness and damping of all triangles.
/// @param x  #P by 3, m
/// @param h  time step, s
/// @param force  #P by 3, N, added to
void add_shear(const std::vector<ShearTriangle>& shear, const std::vector<Vec3>& x, double h,
               std::vector<Vec3>& force, BlockMatrix& stiffness);

/// The shear effect of a cloth.
class ShearEffect : public Effect {
public:
  /// @param mesh  read at construction and by set_rest()
  explicit ShearEffect(const ClothMesh& mesh) : m_shear(make_shear(mesh)) {}
  const char* name() const override { return "shear"; }
  bool set_rest(const ClothMesh& mesh) override {
    std::vector<ShearTriangle> fresh = make_shear(mesh);
    if (fresh.size() != m_shear.size())
      return false;
    for (std::size_t k = 0; k < fresh.size(); ++k)
      fresh[k].slots = m_shear[k].slots;
    m_shear = std::move(fresh);
    return true;
  }
  void declare(Couplings& couplings) const override;
  void bind(const BlockMatrix& matrix) override { find_slots(m_shear, matrix); }
  /// Potential at x, J.
  double energy(const std::vector<Vec3>& x) const override { return shear_energy(m_shear, x); }
  void add_indefinite_part(const std::vector<Vec3>& x, BlockMatrix& stiffness) const override;
  void add(StepContext& c) override { add_shear(m_shear, c.x, c.h, c.force, c.stiffness); }

private:
  std::vector<ShearTriangle> m_shear;
};

} // namespace sloper::cloth
