#include <cloth/contact_element.hpp>

namespace sloper::cloth {

void add_forces(const std::vector<ContactElement>& elements, std::vector<Vec3>& force) {
  for (const ContactElement& e : elements)
    for (int k = 0; k < e.n; ++k) force[e.particle[k]] += e.weight[k] * e.force;
}

void multiply_add(const std::vector<ContactElement>& elements, const std::vector<Vec3>& x, std::vector<Vec3>& y) {
  for (const ContactElement& e : elements) {
    Vec3 s = Vec3::Zero();
    for (int k = 0; k < e.n; ++k) s += e.weight[k] * x[e.particle[k]];
    const Vec3 a = e.tangent_stiffness * s + (e.normal_stiffness - e.tangent_stiffness) * e.normal.dot(s) * e.normal;
    for (int k = 0; k < e.n; ++k) y[e.particle[k]] += e.weight[k] * a;
  }
}

} // namespace sloper::cloth
