#include <cloth/contact_element.hpp>

#include <algorithm>

namespace sloper::cloth {

double crossing_share(const Vec3& u, const Vec3& v) {
  constexpr double PARALLEL = 0.01; // squared sine: 5.7 degrees
  const double sine2 = u.cross(v).squaredNorm() / std::max(u.squaredNorm() * v.squaredNorm(), 1e-30);
  if (sine2 >= PARALLEL) return 1;
  const double r = sine2 / PARALLEL;
  return (2 - r) * r;
}

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
