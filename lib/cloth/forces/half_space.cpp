#include <sloper/cloth/forces/half_space.hpp>

namespace sloper::cloth {

void HalfSpaceEffect::add(StepContext& context) {
  const Mat3 block = m_stiffness * m_normal * m_normal.transpose();
  for (int i : m_particles) {
    const double depth = beyond(i, context.x);
    if (depth <= 0)
      continue;
    context.force[i] += m_stiffness * depth * m_normal;
    context.stiffness.add_diagonal(i, block);
  }
}

double HalfSpaceEffect::energy(const std::vector<Vec3>& x) const {
  double sum = 0;
  for (int i : m_particles) {
    const double depth = beyond(i, x);
    if (depth > 0)
      sum += 0.5 * m_stiffness * depth * depth;
  }
  return sum;
}

} // namespace sloper::cloth
