#include <sloper/cloth/forces/pins.hpp>

namespace sloper::cloth {

Vec3 PinsEffect::force(std::size_t k, const std::vector<Vec3>& x) const {
  const Pin& pin = m_pins[k];
  const Vec3 off = pin.target - x[pin.particle];
  return pin.stiffness_n_m * (off - off.dot(pin.free_axis) * pin.free_axis);
}

double PinsEffect::energy(const std::vector<Vec3>& x) const {
  double sum = 0;
  for (std::size_t k = 0; k < m_pins.size(); ++k)
    sum += 0.5 * force(k, x).squaredNorm() / m_pins[k].stiffness_n_m;
  return sum;
}

void PinsEffect::add(StepContext& c) {
  for (std::size_t k = 0; k < m_pins.size(); ++k) {
    const Pin& pin = m_pins[k];
    c.force[pin.particle] += force(k, c.x);
    c.stiffness.add_diagonal(pin.particle,
                             pin.stiffness_n_m *
                                 (Mat3::Identity() - pin.free_axis * pin.free_axis.transpose()));
  }
}

} // namespace sloper::cloth
