#pragma once
/// Pins: particles held at points in space by stiff springs, E = k/2 |x_i - p|^2.
///
/// A pin is a spring and not a constraint, so that the force that it carries is known
/// (force()), and a pin may yield. Under a load F the particle is F/k off its point.
/// Test: tests/cloth/forces/test_jacobians.cpp
#include <sloper/cloth/effect.hpp>

namespace sloper::cloth {

/// One pin.
struct Pin {
  int particle;               ///< that is held
  Vec3 target;                ///< m
  double stiffness_n_m = 1e4; ///< N/m
  /// Unit: the particle may slide along it; zero holds all directions.
  Vec3 free_axis = Vec3::Zero();
};

/// The effect of all pins.
class PinsEffect : public Effect {
public:
  /// @param pins  particles within the cloth
  explicit PinsEffect(std::vector<Pin> pins) : m_pins(std::move(pins)) {}
  const char* name() const override { return "pins"; }
  void add(StepContext& c) override;
  /// Potential at x, J.
  double energy(const std::vector<Vec3>& x) const override;
  /// Force that pin k puts on its particle at x, N.
  Vec3 force(std::size_t k, const std::vector<Vec3>& x) const;
  /// Moves pin k.
  /// @param target  m
  void set_target(std::size_t k, const Vec3& target) { m_pins[k].target = target; }
  /// With their present targets.
  const std::vector<Pin>& pins() const { return m_pins; }

private:
  std::vector<Pin> m_pins;
};

} // namespace sloper::cloth
