#pragma once
/// Springs of zero rest length between the two sides of every open seam. They pull a seam
/// shut until it is welded.
/// Test: tests/cloth/forces/test_jacobians.cpp
#include <sloper/cloth/effect.hpp>

namespace sloper::cloth {

/// The effect of all open stitches.
class SewingSpringEffect : public Effect {
public:
  /// @param stitches  #S by 2 particles
  /// @param stiffness_n_m  of each stitch, N/m
  /// @param reach_m  the pull grows with the gap up to here and stays constant beyond, so
  /// that far panels are drawn gently
  SewingSpringEffect(std::vector<std::array<int, 2>> stitches, double stiffness_n_m, double reach_m)
      : m_stitches(std::move(stitches)), m_stiffness(stiffness_n_m), m_reach(reach_m) {}
  const char* name() const override { return "sewing"; }
  void declare(Couplings& couplings) const override {
    couplings.isotropic.insert(couplings.isotropic.end(), m_stitches.begin(), m_stitches.end());
  }
  void bind(const BlockMatrix& matrix) override;
  /// Potential at x, J: k/2 gap^2 within reach, growing linearly beyond.
  double energy(const std::vector<Vec3>& x) const override;
  void add(StepContext& c) override;
  /// Stiffness of each stitch from the next step on, N/m.
  void set_stiffness(double stiffness_n_m) { m_stiffness = stiffness_n_m; }
  /// How far a stitch is open.
  struct Gap {
    double length = 0;          ///< m
    Vec3 middle = Vec3::Zero(); ///< of its two particles, m
  };
  /// The stitch that is farthest from closed at x.
  Gap widest(const std::vector<Vec3>& x) const;
  /// As given.
  const std::vector<std::array<int, 2>>& stitches() const { return m_stitches; }

private:
  std::vector<std::array<int, 2>> m_stitches;
  std::vector<int> m_slots;
  double m_stiffness, m_reach;
};

} // namespace sloper::cloth
