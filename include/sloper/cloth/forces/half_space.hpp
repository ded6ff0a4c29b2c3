#pragma once
/// Keeps particles on their side of a plane, each with a spring that begins at the plane:
/// E = k/2 min(0, n . (x - p))^2. Two sides that must not mix, such as trouser legs, then
/// need no contact between them. Test: tests/cloth/forces/test_half_space.cpp
#include <sloper/cloth/effect.hpp>

namespace sloper::cloth {

/// The effect of one plane on some particles.
class HalfSpaceEffect : public Effect {
public:
  /// @param particles  that are kept on their side
  /// @param point  of the plane, m
  /// @param normal  unit, to the side where particles belong
  /// @param stiffness  N/m, of each particle
  HalfSpaceEffect(std::vector<int> particles, const Vec3& point, const Vec3& normal,
                  double stiffness)
      : m_particles(std::move(particles)), m_point(point), m_normal(normal),
        m_stiffness(stiffness) {}
  const char* name() const override { return "half_space"; }
  void add(StepContext& context) override;
  double energy(const std::vector<Vec3>& x) const override;

private:
  double beyond(int particle, const std::vector<Vec3>& x) const {
    return m_normal.dot(m_point - x[particle]);
  }
  std::vector<int> m_particles;
  Vec3 m_point, m_normal;
  double m_stiffness;
};

} // namespace sloper::cloth
