#include <sloper/cloth/forces/edge_spring.hpp>
#include <sloper/cloth/forces/elastic_band.hpp>

#include <algorithm>

namespace sloper::cloth {

void ElasticBandEffect::declare(Couplings& couplings) const {
  for (const BandLink& l : m_links)
    couplings.symmetric.push_back({l.i, l.j});
}

void ElasticBandEffect::bind(const BlockMatrix& matrix) {
  m_slots.clear();
  for (const BandLink& l : m_links)
    m_slots.push_back(matrix.slot(l.i, l.j));
}

double ElasticBandEffect::tension(std::size_t k, const std::vector<Vec3>& x) const {
  const BandLink& l = m_links[k];
  return l.strength_n * std::max(0.0, (x[l.j] - x[l.i]).norm() / l.rest_length - 1);
}

double ElasticBandEffect::energy(const std::vector<Vec3>& x) const {
  double sum = 0;
  for (std::size_t k = 0; k < m_links.size(); ++k) {
    const double t = tension(k, x);
    sum += 0.5 * t * t * m_links[k].rest_length / m_links[k].strength_n;
  }
  return sum;
}

void ElasticBandEffect::add(StepContext& c) {
  for (std::size_t k = 0; k < m_links.size(); ++k) {
    const BandLink& l = m_links[k];
    if ((c.x[l.j] - c.x[l.i]).norm() <= l.rest_length)
      continue;
    const double stiffness = l.strength_n / l.rest_length;
    const Vec3 force = edge_spring_force(c.x[l.i], c.x[l.j], l.rest_length, stiffness);
    const Mat3 block = edge_spring_stiffness(c.x[l.i], c.x[l.j], l.rest_length, stiffness);
    c.force[l.i] += force;
    c.force[l.j] -= force;
    c.stiffness.add_diagonal(l.i, block);
    c.stiffness.add_diagonal(l.j, block);
    c.stiffness.add_off_diagonal(m_slots[k], -block);
  }
}

} // namespace sloper::cloth
