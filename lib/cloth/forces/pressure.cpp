#include <sloper/cloth/forces/pressure.hpp>

namespace sloper::cloth {

void PressureEffect::add(StepContext& c) {
  m_rim.assign(c.x.size(), Vec3::Zero());
  for (const Triangle& t : m_triangles) {
    const Vec3 force = m_pressure / 6 * (c.x[t[1]] - c.x[t[0]]).cross(c.x[t[2]] - c.x[t[0]]);
    for (int k = 0; k < 3; ++k) {
      c.force[t[k]] += force;
      m_rim[t[k]] += m_pressure / 6 * c.x[t[(k + 1) % 3]].cross(c.x[t[(k + 2) % 3]]) - force;
    }
  }
}

double PressureEffect::energy(const std::vector<Vec3>& x) const {
  double sum = 0;
  for (const Triangle& t : m_triangles)
    sum -= m_pressure / 6 * x[t[0]].dot(x[t[1]].cross(x[t[2]]));
  for (std::size_t i = 0; i < m_rim.size(); ++i)
    sum += m_rim[i].dot(x[i]);
  return sum;
}

} // namespace sloper::cloth
