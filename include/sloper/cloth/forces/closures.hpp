#pragma once
/// Closures: points of cloth that a button, a snap or a zip's teeth hold together. Each pulls and
/// never pushes, E = k/2 (|d| - l0)^2 beyond l0 and up to l0 + reach, and with a constant force
/// beyond, so that edges that start apart come gently. l0 is the distance that contact keeps.
#include <sloper/cloth/effect.hpp>

namespace sloper::cloth {

/// Two particles that are held together.
struct Closure {
  int i, j;                    ///< particles, not the same
  double rest_length = 0;      ///< l0, m
  double stiffness_n_m = 2000; ///< k
};

/// The effect of all closures.
class ClosuresEffect : public Effect {
public:
  static constexpr double REACH = 0.01; ///< m beyond l0 up to which the force grows
  /// @param closures  particles within the cloth
  explicit ClosuresEffect(std::vector<Closure> closures) : m_closures(std::move(closures)) {}
  const char* name() const override { return "closures"; }
  void declare(Couplings& couplings) const override;
  void bind(const BlockMatrix& matrix) override;
  void add(StepContext& c) override;
  /// Potential at x, J.
  double energy(const std::vector<Vec3>& x) const override;

private:
  std::vector<Closure> m_closures;
  std::vector<int> m_slots;
};

} // namespace sloper::cloth
