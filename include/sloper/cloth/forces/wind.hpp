#pragma once
/// Air: drag of moving or still air on cloth, per triangle of area A with normal n and velocity v
/// in air of velocity w: F = 1/2 rho A (c_n |q.n| (q.n) n + c_t |q_t| q_t), q = w - v, q_t = q -
/// (q.n) n; a third on each corner.
///
/// The factors |q.n| and |q_t| are those of the last step, so that the force is linear in v and can
/// only take energy from cloth that moves through still air, at any time step. c_n = 1.2 is a flat
/// plate across the stream (Hoerner 1965, p. 3-16), c_t = 0.02 skin friction of rough cloth.
/// Test: tests/cloth/forces/test_jacobians.cpp
#include <sloper/cloth/effect.hpp>

namespace sloper::cloth {

/// Air and its drag.
struct WindOptions {
  Vec3 velocity = Vec3::Zero(); ///< of the air, m/s
  double air_density = 1.2;     ///< rho, kg/m3
  double normal_drag = 1.2;     ///< c_n
  double tangent_drag = 0.02;   ///< c_t
};

/// Drag of the air on all given triangles.
class WindEffect : public Effect {
public:
  /// @param triangles  of the cloth; both sides count alike
  WindEffect(std::vector<Triangle> triangles, const WindOptions& options)
      : m_triangles(std::move(triangles)), m_options(options) {}
  const char* name() const override { return "wind"; }
  void begin_step(const std::vector<Vec3>& x, double h) override;
  void add(StepContext& c) override;
  /// The air's force has no potential. This is minus its work as it was when last added, whose
  /// gradient is minus that force: what a line search needs. J
  double energy(const std::vector<Vec3>& x) const override;

private:
  std::vector<Triangle> m_triangles;
  WindOptions m_options;
  /// #P; push: force of the last add at no velocity.
  std::vector<Vec3> m_last_x, m_velocity, m_push;
};

} // namespace sloper::cloth
