#include <sloper/cloth/forces/closures.hpp>

#include <algorithm>

namespace sloper::cloth {

void ClosuresEffect::declare(Couplings& couplings) const {
  for (const Closure& c : m_closures)
    couplings.symmetric.push_back({c.i, c.j});
}

void ClosuresEffect::bind(const BlockMatrix& matrix) {
  m_slots.clear();
  for (const Closure& c : m_closures)
    m_slots.push_back(matrix.slot(c.i, c.j));
}

void ClosuresEffect::add(StepContext& context) {
  for (std::size_t k = 0; k < m_closures.size(); ++k) {
    const Closure& c = m_closures[k];
    const Vec3 d = context.x[c.j] - context.x[c.i];
    const double length = d.norm(), over = length - c.rest_length;
    if (over <= 0)
      continue;
    const Vec3 u = d / length;
    const double pull = c.stiffness_n_m * std::min(over, REACH);
    context.force[c.i] += pull * u;
    context.force[c.j] -= pull * u;
    // Across d the tension over the length; along d k, and beyond reach the secant, which keeps the
    // step from overshooting.
    const double across = pull / length, along = over < REACH ? c.stiffness_n_m : pull / over;
    const Mat3 block = across * Mat3::Identity() + (along - across) * u * u.transpose();
    context.stiffness.add_diagonal(c.i, block);
    context.stiffness.add_diagonal(c.j, block);
    context.stiffness.add_off_diagonal(m_slots[k], -block);
  }
}

double ClosuresEffect::energy(const std::vector<Vec3>& x) const {
  double sum = 0;
  for (const Closure& c : m_closures) {
    const double over = (x[c.j] - x[c.i]).norm() - c.rest_length;
    if (over <= 0)
      continue;
    sum += over < REACH ? 0.5 * c.stiffness_n_m * over * over
                        : c.stiffness_n_m * REACH * (over - 0.5 * REACH);
  }
  return sum;
}

} // namespace sloper::cloth
