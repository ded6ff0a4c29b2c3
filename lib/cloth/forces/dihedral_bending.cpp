#include <sloper/cloth/forces/dihedral_bending.hpp>

#include <algorithm>
#include <cmath>

namespace sloper::cloth {

namespace {

/// Shorter than this (relative to the edge squared) a triangle's normal has no direction.
constexpr double FLATTEST = 1e-6;

} // namespace

HingeAngle measure_hinge(const Hinge& hinge, const std::vector<Vec3>& x, bool with_gradient) {
  HingeAngle angle;
  const Vec3 &x0 = x[hinge.particle[0]], &x1 = x[hinge.particle[1]], &x2 = x[hinge.particle[2]],
             &x3 = x[hinge.particle[3]];
  const Vec3 e = x1 - x0, a = e.cross(x2 - x0), b = (x3 - x0).cross(e);
  const double length = e.norm(), least = FLATTEST * length * length;
  if (!(a.norm() > least) || !(b.norm() > least))
    return angle;
  angle.defined = true;
  angle.value = std::atan2(a.cross(b).dot(e) / length, a.dot(b));
  if (!with_gradient)
    return angle;
  const Vec3 ga = a / a.squaredNorm(), gb = b / b.squaredNorm();
  angle.gradient[2] = -length * ga;
  angle.gradient[3] = -length * gb;
  angle.gradient[0] = ((x1 - x2).dot(e) * ga + (x1 - x3).dot(e) * gb) / length;
  angle.gradient[1] = ((x2 - x0).dot(e) * ga + (x3 - x0).dot(e) * gb) / length;
  return angle;
}

double hinge_angle(const Hinge& hinge, const std::vector<Vec3>& x) {
  return measure_hinge(hinge, x, false).value;
}

DihedralBendingEffect::DihedralBendingEffect(const ClothMesh& mesh, std::vector<double> rest_angle)
    : m_mesh(mesh), m_rest_angle(std::move(rest_angle)) {
  m_rest_angle.resize(mesh.hinges.size(), 0);
  for (const Hinge& h : mesh.hinges) {
    const std::array<int, 2> edge{std::min(h.particle[0], h.particle[1]),
                                  std::max(h.particle[0], h.particle[1])};
    const auto found = std::lower_bound(mesh.edges.begin(), mesh.edges.end(), edge);
    const double length = mesh.springs[found - mesh.edges.begin()].rest_length;
    m_stiffness.push_back((h.stiffness + h.firmness) * length *
                          length); // |sum c_k x_k| = |e| theta for small theta
  }
}

void DihedralBendingEffect::declare(Couplings& couplings) const {
  for (const Hinge& hinge : m_mesh.hinges)
    for (int a = 0; a < 4; ++a)
      for (int b = a + 1; b < 4; ++b)
        couplings.full.push_back({hinge.particle[a], hinge.particle[b]});
}

double DihedralBendingEffect::energy(const std::vector<Vec3>& x) const {
  double sum = 0;
  for (std::size_t h = 0; h < m_mesh.hinges.size(); ++h) {
    const HingeAngle angle = measure_hinge(m_mesh.hinges[h], x, false);
    if (!angle.defined)
      continue;
    const double off = angle.value - m_rest_angle[h];
    sum += 0.5 * m_scale * m_stiffness[h] * off * off;
  }
  return sum;
}

void add_hinge(StepContext& c, const Hinge& hinge, const HingeSlots& slots, const HingeAngle& angle,
               double moment, double k) {
  int at = 0;
  for (int a = 0; a < 4; ++a) {
    c.force[hinge.particle[a]] -= moment * angle.gradient[a];
    c.stiffness.add_diagonal(hinge.particle[a],
                             k * angle.gradient[a] * angle.gradient[a].transpose());
    for (int b = a + 1; b < 4; ++b, ++at) {
      const bool upper = hinge.particle[a] < hinge.particle[b];
      const Vec3& first = angle.gradient[upper ? a : b];
      const Vec3& second = angle.gradient[upper ? b : a];
      c.stiffness.add_off_diagonal(slots[at], k * first * second.transpose());
    }
  }
}

void DihedralBendingEffect::add(StepContext& c) {
  const double damping = m_mesh.fabrics.empty() ? 0 : m_mesh.fabrics[0].damping_s / c.h;
  for (std::size_t h = 0; h < m_mesh.hinges.size(); ++h) {
    const Hinge& hinge = m_mesh.hinges[h];
    const double stiffness = m_scale * m_stiffness[h];
    if (stiffness == 0)
      continue;
    const HingeAngle angle = measure_hinge(hinge, c.x, true);
    if (!angle.defined)
      continue;
    const double moment = stiffness * (angle.value - m_rest_angle[h]);
    const double k = stiffness * (1 + damping);
    add_hinge(c, hinge, m_slots[h], angle, moment, k);
  }
}

} // namespace sloper::cloth
