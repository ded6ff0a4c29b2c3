#include <sloper/cloth/forces/sewing_spring.hpp>

#include <algorithm>

namespace sloper::cloth {

void SewingSpringEffect::bind(const BlockMatrix& matrix) {
  m_slots.clear();
  for (const auto& s : m_stitches)
    m_slots.push_back(matrix.slot(s[0], s[1]));
}

void SewingSpringEffect::add(StepContext& c) {
  for (std::size_t k = 0; k < m_stitches.size(); ++k) {
    const auto [i, j] = m_stitches[k];
    const Vec3 d = c.x[j] - c.x[i];
    const double gap = d.norm();
    // Beyond reach the exact stiffness along d is 0; the secant keeps the step from overshooting.
    const double stiffness = m_stiffness * std::min(1.0, m_reach / std::max(gap, 1e-12));
    c.force[i] += stiffness * d;
    c.force[j] -= stiffness * d;
    c.stiffness.add_isotropic_diagonal(i, stiffness);
    c.stiffness.add_isotropic_diagonal(j, stiffness);
    c.stiffness.add_isotropic(m_slots[k], -stiffness);
  }
}

double SewingSpringEffect::energy(const std::vector<Vec3>& x) const {
  double sum = 0;
  for (const auto& s : m_stitches) {
    const double gap = (x[s[1]] - x[s[0]]).norm();
    sum += gap < m_reach ? 0.5 * m_stiffness * gap * gap
                         : m_stiffness * m_reach * (gap - 0.5 * m_reach);
  }
  return sum;
}

SewingSpringEffect::Gap SewingSpringEffect::widest(const std::vector<Vec3>& x) const {
  Gap widest;
  for (const auto& [i, j] : m_stitches) {
    const double length = (x[j] - x[i]).norm();
    if (length > widest.length)
      widest = {length, 0.5 * (x[i] + x[j])};
  }
  return widest;
}

} // namespace sloper::cloth
