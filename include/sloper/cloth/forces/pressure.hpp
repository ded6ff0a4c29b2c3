#pragma once
/// Pressure on the inner side of the cloth, Pa: every triangle is pushed along its outer normal,
/// f_k = p/6 (x1 - x0) x (x2 - x0).
///
/// On a closed cloth this is the gradient of p V. The derivative of the force is left out of the
/// matrix: it turns with the surface and is not definite; Newton's direction stays one of descent.
/// Test: tests/cloth/forces/test_jacobians.cpp
#include <sloper/cloth/effect.hpp>

namespace sloper::cloth {

/// Pressure on all given triangles.
class PressureEffect : public Effect {
public:
  /// @param triangles  counter-clockwise seen from outside
  /// @param pressure_pa  positive pushes outwards
  PressureEffect(std::vector<Triangle> triangles, double pressure_pa)
      : m_triangles(std::move(triangles)), m_pressure(pressure_pa) {}
  const char* name() const override { return "pressure"; }
  void add(StepContext& c) override;
  /// -p V, V = 1/6 sum x0 . (x1 x x2), the potential of a closed cloth; an open one has none, and
  /// its rim adds the work that makes the gradient minus the force where add() was called last. J
  double energy(const std::vector<Vec3>& x) const override;

private:
  std::vector<Triangle> m_triangles;
  double m_pressure;
  std::vector<Vec3> m_rim; ///< #P, N: gradient of pV minus the force, at the last add
};

} // namespace sloper::cloth
