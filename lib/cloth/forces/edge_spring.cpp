#include <sloper/cloth/forces/edge_spring.hpp>

#include <algorithm>
#include <cmath>

namespace sloper::cloth {

/// Shorter than this an edge has no direction; its force is left out for the step. m
static constexpr double SHORTEST = 1e-9;

double edge_spring_energy(const Vec3& xi, const Vec3& xj, double rest_length, double stiffness) {
  const double extension = (xj - xi).norm() - rest_length;
  return 0.5 * stiffness * extension * extension;
}

Vec3 edge_spring_force(const Vec3& xi, const Vec3& xj, double rest_length, double stiffness) {
  const Vec3 d = xj - xi;
  const double length = d.norm();
  if (length < SHORTEST)
    return Vec3::Zero();
  return stiffness * (length - rest_length) / length * d;
}

Mat3 edge_spring_stiffness(const Vec3& xi, const Vec3& xj, double rest_length, double stiffness,
                           bool clamp) {
  const Vec3 d = xj - xi;
  const double length = d.norm();
  if (length < SHORTEST)
    return stiffness * Mat3::Identity();
  const Vec3 u = d / length;
  double side = 1 - rest_length / length;
  if (clamp)
    side = std::max(side, 0.0);
  return stiffness * (side * Mat3::Identity() + (1 - side) * u * u.transpose());
}

void add_edge_springs(const ClothMesh& mesh, const std::vector<Vec3>& x, double h,
                      const std::vector<int>& slots, std::vector<Vec3>& force,
                      BlockMatrix& stiffness) {
  for (std::size_t s = 0; s < mesh.springs.size(); ++s) {
    const EdgeSpring& spring = mesh.springs[s];
    const Vec3 d = x[spring.j] - x[spring.i];
    const double length = d.norm();
    if (length < SHORTEST)
      continue;
    const Vec3 u = d / length;
    const Vec3 f = spring.stiffness * (length - spring.rest_length) * u;
    force[spring.i] += f;
    force[spring.j] -= f;
    const double side = std::max(1 - spring.rest_length / length, 0.0) * spring.stiffness;
    const double along = spring.stiffness * (1 + spring.damping_s / h) - side;
    Mat3 block = along * u * u.transpose();
    block.diagonal().array() += side;
    stiffness.add_diagonal(spring.i, block);
    stiffness.add_diagonal(spring.j, block);
    stiffness.add_off_diagonal(slots[s], -block);
  }
}

void EdgeSpringEffect::add_indefinite_part(const std::vector<Vec3>& x,
                                           BlockMatrix& stiffness) const {
  for (std::size_t s = 0; s < m_mesh.springs.size(); ++s) {
    const EdgeSpring& spring = m_mesh.springs[s];
    const Vec3 d = x[spring.j] - x[spring.i];
    const double length = d.norm();
    if (length < SHORTEST || length >= spring.rest_length)
      continue;
    const double side = (1 - spring.rest_length / length) * spring.stiffness;
    Mat3 block = -side / (length * length) * d * d.transpose();
    block.diagonal().array() += side;
    stiffness.add_diagonal(spring.i, block);
    stiffness.add_diagonal(spring.j, block);
    stiffness.add_off_diagonal(m_slots[s], -block);
  }
}

double edge_springs_energy(const ClothMesh& mesh, const std::vector<Vec3>& x) {
  double sum = 0;
  for (const EdgeSpring& s : mesh.springs)
    sum += edge_spring_energy(x[s.i], x[s.j], s.rest_length, s.stiffness);
  return sum;
}

void EdgeSpringEffect::declare(Couplings& couplings) const {
  for (const EdgeSpring& s : m_mesh.springs)
    couplings.symmetric.push_back({s.i, s.j});
}

void EdgeSpringEffect::bind(const BlockMatrix& matrix) {
  m_slots.clear();
  for (const EdgeSpring& s : m_mesh.springs)
    m_slots.push_back(matrix.slot(s.i, s.j));
}

} // namespace sloper::cloth
