#include <sloper/cloth/contact/contact_element.hpp>

#include <algorithm>

namespace sloper::cloth {

double edge_edge_mollifier(const Vec3& u, const Vec3& v) {
  constexpr double PARALLEL = 0.01; // squared sine: 5.7 degrees
  const double sine2 =
      u.cross(v).squaredNorm() / std::max(u.squaredNorm() * v.squaredNorm(), 1e-30);
  if (sine2 >= PARALLEL)
    return 1;
  const double r = sine2 / PARALLEL;
  return (2 - r) * r;
}

void add_forces(const std::vector<ContactElement>& elements, std::vector<Vec3>& force) {
  for (const ContactElement& e : elements)
    for (int k = 0; k < e.n; ++k)
      force[e.particle[k]] += e.weight[k] * e.force;
}

void ContactIndex::build(const std::vector<ContactElement>& elements, std::size_t n_particles) {
  start.assign(n_particles + 1, 0);
  for (const ContactElement& e : elements)
    for (int k = 0; k < e.n; ++k)
      ++start[e.particle[k] + 1];
  for (std::size_t i = 0; i < n_particles; ++i)
    start[i + 1] += start[i];
  entry.resize(static_cast<std::size_t>(start.back()));
  for (int e = static_cast<int>(elements.size()) - 1; e >= 0;
       --e) // backwards: each particle's entries end up in the elements' order
    for (int k = elements[e].n - 1; k >= 0; --k)
      entry[--start[elements[e].particle[k] + 1]] = {e, k};
  start.erase(start.begin());
  start.push_back(std::ssize(entry));
}

} // namespace sloper::cloth
