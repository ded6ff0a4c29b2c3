#pragma once
/// Pins: particles held at points in space by stiff springs, E = k/2 |x_i - p|^2.
///
/// A spring and not a constraint, so that the force that a pin carries is known (force()), and a
/// pin may be given way. Under a load F the particle stands F/k off its point.
#include <sloper/cloth/effect.hpp>

namespace sloper::cloth {

struct Pin {
  int particle;
  Vec3 target;                ///< m
  double stiffness_n_m = 1e4; ///< N/m
  Vec3 free_axis =
      Vec3::Zero(); ///< unit: the particle may slide along it; zero holds all directions
};

class PinsEffect : public Effect {
public:
  explicit PinsEffect(std::vector<Pin> pins) : m_pins(std::move(pins)) {}
  const char* name() const override { return "pins"; }
  void add(StepContext& c) override;
  /// Potential at x, J.
  double energy(const std::vector<Vec3>& x) const override;
  /// Force that pin k puts on its particle at x, N.
  Vec3 force(std::size_t k, const std::vector<Vec3>& x) const;
  /// For a moving pin.
  void set_target(std::size_t k, const Vec3& target) { m_pins[k].target = target; }
  const std::vector<Pin>& pins() const { return m_pins; }

private:
  std::vector<Pin> m_pins;
};

} // namespace sloper::cloth
