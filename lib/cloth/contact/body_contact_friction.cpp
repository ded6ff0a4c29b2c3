#include <sloper/cloth/contact/body_contact.hpp>

/// Coulomb friction of cloth on skin: a tie from each loaded particle to the place where it stuck,
/// which slides along when it pulls too hard.
namespace sloper::cloth {

void BodyContactEffect::add_friction(StepContext& context) {
  ++friction_calls;
  for (int i = 0; i < m_mesh.n_particles; ++i) {
    const double load = m_load[i].norm();
    m_tangent[i] = 0;
    if (load <= 0) {
      m_has_anchor[i] = 0;
      continue;
    }
    const Vec3 normal = m_load[i] / load;
    if (!m_has_anchor[i])
      m_anchor[i] = context.x[i];
    m_has_anchor[i] = 1;
    Vec3 u = context.x[i] - m_anchor[i];
    u -= u.dot(normal) * normal;
    double tangent = m_tangent[i] = m_options.tangent_ratio * m_load_stiffness[i];
    const double length = u.norm(), pull = tangent * length, most = m_options.friction * load,
                 carried = m_carried[i].norm();
    if (pull > most && carried > 0) {
      // On skin that moves the pull ends where the cloth has caught up, and what the skin has gone
      // since the last step may yet be caught up with: else the cloth would be held to where the
      // skin was.
      context.force[i] -= most / length * u;
      const double kept = most / tangent + carried;
      if (length > kept)
        m_anchor[i] = context.x[i] - kept / length * u;
      tangent = most / length;
    } else if (pull > most) {
      u *= most / pull;
      context.force[i] -= tangent * u;
      m_anchor[i] = context.x[i] - u;
      tangent = m_options.slide_ratio * m_load_stiffness[i];
    } else {
      context.force[i] -= tangent * u;
    }
    context.stiffness.add_diagonal(i, tangent * (Mat3::Identity() - normal * normal.transpose()));
  }
}

/// Of the ties, with the load of the last step: quadratic to the limit, then linear.
double BodyContactEffect::friction_energy(const std::vector<Vec3>& x) const {
  double sum = 0;
  if (m_options.friction <= 0)
    return sum;
  for (int i = 0; i < m_mesh.n_particles; ++i) {
    if (m_tangent[i] <= 0)
      continue;
    const double load = m_load[i].norm(), most = m_options.friction * load;
    Vec3 u = x[i] - m_anchor[i];
    u -= u.dot(m_load[i]) / (load * load) * m_load[i];
    const double length = u.norm(), limit = most / m_tangent[i];
    sum += length <= limit ? 0.5 * m_tangent[i] * length * length : most * (length - 0.5 * limit);
  }
  return sum;
}

} // namespace sloper::cloth
