#include <sloper/cloth/forces/wind.hpp>

#include <algorithm>

namespace sloper::cloth {

/// Faster than this a particle was moved and did not fly; its own velocity is taken as 0. m/s
static constexpr double FASTEST = 20;

void WindEffect::begin_step(const std::vector<Vec3>& x, double h) {
  m_velocity.assign(x.size(), Vec3::Zero());
  if (m_last_x.size() == x.size())
    for (std::size_t i = 0; i < x.size(); ++i) {
      const Vec3 v = (x[i] - m_last_x[i]) / h;
      if (v.norm() < FASTEST)
        m_velocity[i] = v;
    }
  m_last_x = x;
}

void WindEffect::add(StepContext& c) {
  m_velocity.resize(c.x.size(), Vec3::Zero());
  m_push.assign(c.x.size(), Vec3::Zero());
  for (const Triangle& t : m_triangles) {
    const Vec3 cross = (c.x[t[1]] - c.x[t[0]]).cross(c.x[t[2]] - c.x[t[0]]);
    const double twice = cross.norm();
    if (twice < 1e-14)
      continue;
    const Vec3 n = cross / twice;
    const Vec3 q =
        m_options.velocity - (m_velocity[t[0]] + m_velocity[t[1]] + m_velocity[t[2]]) / 3;
    const double qn = q.dot(n), scale = 0.5 * m_options.air_density * 0.5 * twice / 3;
    const double along = scale * m_options.normal_drag * std::abs(qn),
                 across = scale * m_options.tangent_drag * (q - qn * n).norm();
    const Mat3 drag =
        across * Mat3::Identity() + (along - across) * n * n.transpose(); // N s/m on each corner
    const Vec3 force = drag * m_options.velocity;
    for (int k = 0; k < 3; ++k) {
      m_push[t[k]] += force;
      c.force[t[k]] += force;
      c.stiffness.add_diagonal(t[k], drag / c.h);
    }
  }
}

double WindEffect::energy(const std::vector<Vec3>& x) const {
  double sum = 0;
  for (std::size_t i = 0; i < m_push.size(); ++i)
    sum -= m_push[i].dot(x[i]);
  return sum;
}

} // namespace sloper::cloth
