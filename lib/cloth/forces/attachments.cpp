#include <sloper/cloth/forces/attachments.hpp>
#include <sloper/cloth/forces/edge_spring.hpp>

namespace sloper::cloth {

double AttachmentsEffect::energy(const std::vector<Vec3>& x) const {
  double sum = 0;
  for (const Attachment& a : m_attachments)
    if ((a.anchor - x[a.particle]).norm() > a.rest_length)
      sum += edge_spring_energy(x[a.particle], a.anchor, a.rest_length, a.stiffness_n_m);
  return sum;
}

void AttachmentsEffect::add(StepContext& c) {
  for (const Attachment& a : m_attachments) {
    const Vec3& x = c.x[a.particle];
    if ((a.anchor - x).norm() <= a.rest_length)
      continue;
    c.force[a.particle] += edge_spring_force(x, a.anchor, a.rest_length, a.stiffness_n_m);
    c.stiffness.add_diagonal(a.particle,
                             edge_spring_stiffness(x, a.anchor, a.rest_length, a.stiffness_n_m));
  }
}

} // namespace sloper::cloth
