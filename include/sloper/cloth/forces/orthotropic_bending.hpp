#pragma once
/// Bending with rigidities by direction, and softening with curvature (cloth/bending_plates.hpp).
///
/// Without rest angles q of a hinge is its curvature vector sum_k c_k x_k, as in the isometric
/// model; forces are linear where the fabric does not soften. The stiffness given to the solver is
/// then one of hinges alone: that of a plate couples the far corners of its neighbours as well,
/// which makes the matrix half as large again and a step two fifths slower. No mode is stiffer than
/// 1.5 times it, so that steps of Newton's kind contract, and on equilateral meshes cylinders have
/// it exactly. With rest angles q is |e| (theta - theta0), as in the dihedral model, and the
/// stiffness J^T K J. Both keep the secant of the softening and are definite.
/// Test: tests/cloth/forces/test_orthotropic_bending.cpp
#include <sloper/cloth/bending_plates.hpp>
#include <sloper/cloth/effect.hpp>
#include <sloper/cloth/forces/dihedral_bending.hpp>

#include <optional>

namespace sloper::cloth {

/// Bending by direction of a cloth.
class OrthotropicBendingEffect : public Effect {
public:
  /// @param rest_angle  none: flat, by curvature vectors; else #hinges, rad, in the sign of
  /// hinge_angle()
  explicit OrthotropicBendingEffect(const ClothMesh& mesh,
                                    std::optional<std::vector<double>> rest_angle = {});
  const char* name() const override { return "orthotropic_bending"; }
  void declare(Couplings& couplings) const override;
  void bind(const BlockMatrix& matrix) override;
  bool set_rest(const ClothMesh& /*mesh*/) override { return false; } ///< its plates are of before
  void add(StepContext& c) override;
  /// Potential at x, J.
  double energy(const std::vector<Vec3>& x) const override;

private:
  /// Particles of a plate and what its hinges make of them.
  struct Stencil {
    std::vector<int> particle;   // n
    Eigen::MatrixXd coefficient; // m by n: q from the positions
    Eigen::MatrixXd stiffness;   // n by n: of one coordinate
    Eigen::MatrixXd of_hinges;   // n by n: what the solver gets for it without rest angles
    std::vector<int> slot;       // of pairs a < b, row by row; with a plate of its own alone;
                                 // -1 where no hinge has both
  };
  struct Pair {
    int i, j; // i < j, or the same
    double stiffness;
  };
  /// q of a hinge with a rest angle, m.
  double turning(std::size_t hinge, const HingeAngle& angle) const {
    return angle.defined ? m_signed_length[hinge] * (angle.value - (*m_rest_angle)[hinge]) : 0;
  }
  Stencil stencil_of(const BendingPlate& plate) const;
  static void add_pairs(const Stencil& stencil, const Eigen::MatrixXd& of, std::vector<Pair>& to);
  static std::vector<Pair> sums(std::vector<Pair> pairs);
  void add_sums(StepContext& c, double damping) const;
  void sign_lengths();
  double energy_of_angles(const std::vector<Vec3>& x) const;
  void add_plate(StepContext& c, std::size_t plate, double damping);
  void add_angles(StepContext& c, double damping);
  void add_angles_of_plate(StepContext& c, std::size_t plate_index,
                           const std::vector<HingeAngle>& angle, double damping);
  void add_firmness(StepContext& c, std::size_t hinge, const HingeAngle& angle, double damping);
  /// Whether the matrix has an entry for these two of a plate's particles.
  bool couples(const Stencil& s, Eigen::Index a, Eigen::Index b) const {
    return m_rest_angle || s.of_hinges(a, b) != 0;
  }
  bool is_constant(std::size_t plate) const { return m_plates[plate].soft_share <= 0; }

  const ClothMesh& m_mesh;
  std::vector<BendingPlate> m_plates;
  std::vector<Stencil> m_stencils;
  // Sums of all plates whose stiffness is constant: for forces, and for the solver.
  std::vector<Pair> m_pairs, m_hinge_pairs;
  std::vector<int> m_pair_slots;         // of m_hinge_pairs
  std::vector<HingeSlots> m_hinge_slots; // with rest angles
  std::optional<std::vector<double>> m_rest_angle;
  std::vector<double>
      m_signed_length; // by hinge: |e|, negative where 0 -> 1 runs against triangle 0
};

} // namespace sloper::cloth
