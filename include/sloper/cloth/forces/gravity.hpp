#pragma once
/// Weight of the particles: f_i = m_i g.
/// Test: tests/cloth/forces/test_jacobians.cpp
#include <sloper/cloth/cloth_mesh.hpp>
#include <sloper/cloth/effect.hpp>

namespace sloper::cloth {

/// The weight of a cloth.
class GravityEffect : public Effect {
public:
  /// @param mesh  outlives the effect
  /// @param acceleration  m/s2, pointing down
  GravityEffect(const ClothMesh& mesh, const Vec3& acceleration)
      : m_mesh(mesh), m_acceleration(acceleration) {}
  const char* name() const override { return "gravity"; }
  /// Potential at x, J; zero at the origin.
  double energy(const std::vector<Vec3>& x) const override {
    double sum = 0;
    for (std::size_t i = 0; i < m_mesh.mass.size(); ++i)
      sum -= m_mesh.mass[i] * m_acceleration.dot(x[i]);
    return sum;
  }
  void add(StepContext& c) override {
    for (std::size_t i = 0; i < m_mesh.mass.size(); ++i)
      c.force[i] += m_mesh.mass[i] * m_acceleration;
  }

private:
  const ClothMesh& m_mesh;
  Vec3 m_acceleration;
};

} // namespace sloper::cloth
