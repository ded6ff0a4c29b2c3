#include <sloper/cloth/forces/bending.hpp>

namespace sloper::cloth {

std::vector<HingeSlots> find_hinge_slots(const ClothMesh& mesh, const BlockMatrix& matrix) {
  std::vector<HingeSlots> slots;
  slots.reserve(mesh.hinges.size());
  for (const Hinge& hinge : mesh.hinges) {
    HingeSlots s;
    int at = 0;
    for (int a = 0; a < 4; ++a)
      for (int b = a + 1; b < 4; ++b)
        s[at++] = matrix.slot(hinge.particle[a], hinge.particle[b]);
    slots.push_back(s);
  }
  return slots;
}

static Vec3 curvature(const Hinge& hinge, const std::vector<Vec3>& x) {
  Vec3 sum = Vec3::Zero();
  for (int k = 0; k < 4; ++k)
    sum += hinge.coefficient[k] * x[hinge.particle[k]];
  return sum;
}

void add_hinge_vector(const Hinge& hinge, const HingeSlots& slots, const Vec3& moment, double k,
                      std::vector<Vec3>& force, BlockMatrix& stiffness) {
  int at = 0;
  for (int a = 0; a < 4; ++a) {
    force[hinge.particle[a]] -= hinge.coefficient[a] * moment;
    stiffness.add_isotropic_diagonal(hinge.particle[a],
                                     k * hinge.coefficient[a] * hinge.coefficient[a]);
    for (int b = a + 1; b < 4; ++b)
      stiffness.add_isotropic(slots[at++], k * hinge.coefficient[a] * hinge.coefficient[b]);
  }
}

double bending_energy(const ClothMesh& mesh, const std::vector<Vec3>& x) {
  double sum = 0;
  for (const Hinge& hinge : mesh.hinges)
    sum += 0.5 * hinge.stiffness * curvature(hinge, x).squaredNorm();
  return sum;
}

void add_bending(const ClothMesh& mesh, const std::vector<Vec3>& x, double h,
                 const std::vector<HingeSlots>& slots, std::vector<Vec3>& force,
                 BlockMatrix& stiffness) {
  const double damping = mesh.fabrics.empty() ? 0 : mesh.fabrics[0].damping_s / h;
  for (std::size_t e = 0; e < mesh.hinges.size(); ++e) {
    const Hinge& hinge = mesh.hinges[e];
    const Vec3 c = hinge.stiffness * curvature(hinge, x);
    const double k = hinge.stiffness * (1 + damping);
    add_hinge_vector(hinge, slots[e], c, k, force, stiffness);
  }
}

void BendingEffect::declare(Couplings& couplings) const {
  for (const Hinge& hinge : m_mesh.hinges)
    for (int a = 0; a < 4; ++a)
      for (int b = a + 1; b < 4; ++b)
        couplings.isotropic.push_back({hinge.particle[a], hinge.particle[b]});
}

} // namespace sloper::cloth
