#pragma once
/// Bending with rigidities by direction, and softening with curvature (cloth/bending_plates.hpp).
///
/// Without rest angles q of a hinge is its curvature vector sum_k c_k x_k, as in the isometric
/// model. The energy of plates that do not soften is then quadratic in each coordinate, and kept as
/// one number for each pair of particles (PairWeights), which takes a fifth of the time that hinges
/// and plates do. The stiffness given to the solver is one of hinges alone: that of a plate couples
/// the far corners of its neighbours as well, which makes the matrix half as large again and a step
/// two fifths slower. No mode is stiffer than 1.5 times it, so that steps of Newton's kind
/// contract, and on equilateral meshes cylinders have it exactly. With rest angles q is |e| (theta
/// - theta0), as in the dihedral model, and the stiffness J^T K J. Both keep the secant of the
/// softening and are definite. Test: tests/cloth/forces/test_orthotropic_bending.cpp
#include <sloper/cloth/bending_plates.hpp>
#include <sloper/cloth/effect.hpp>
#include <sloper/cloth/forces/dihedral_bending.hpp>
#include <sloper/cloth/forces/pair_weights.hpp>

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
  /// With rest angles: the particles of a plate and their places in the matrix.
  struct Stencil {
    std::vector<int> particle; // n
    std::vector<int> slot;     // of pairs a < b, row by row
  };
  /// q of a hinge with a rest angle, m.
  double turning(std::size_t hinge, const HingeAngle& angle) const {
    return angle.defined ? m_signed_length[hinge] * (angle.value - (*m_rest_angle)[hinge]) : 0;
  }
  void join_plates();
  Stencil stencil_of(const BendingPlate& plate) const;
  Eigen::MatrixXd coefficients(const BendingPlate& plate, const std::vector<int>& particle) const;
  void sign_lengths();
  std::vector<Vec3> curvature_vectors(const std::vector<Vec3>& x) const;
  void add_moments(const BendingPlate& plate, const Eigen::VectorXd& given,
                   const std::vector<Vec3>& q);
  void add_vectors(StepContext& c, double damping);
  double energy_of_angles(const std::vector<Vec3>& x) const;
  void add_angles(StepContext& c, double damping);
  void add_angles_of_plate(StepContext& c, std::size_t plate_index,
                           const std::vector<HingeAngle>& angle, double damping);
  void add_firmness(StepContext& c, std::size_t hinge, const HingeAngle& angle, double damping);

  const ClothMesh& m_mesh;
  std::vector<BendingPlate> m_plates; // without rest angles: those that soften
  std::vector<HingeSlots> m_hinge_slots;
  // Without rest angles: plates that do not soften, and what the solver gets of them.
  PairWeights m_exact, m_given;
  std::vector<Eigen::VectorXd> m_given_of; // by plate of m_plates: what the solver gets, by hinges
  std::vector<Vec3> m_moment;              // by hinge, of plates that soften, of a step
  std::vector<double> m_stiffness;         // in the same order: what the solver gets
  // With rest angles.
  std::vector<Stencil> m_stencils;
  std::optional<std::vector<double>> m_rest_angle;
  std::vector<double>
      m_signed_length; // by hinge: |e|, negative where 0 -> 1 runs against triangle 0
};

} // namespace sloper::cloth
