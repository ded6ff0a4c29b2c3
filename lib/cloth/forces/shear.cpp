#include <sloper/cloth/forces/shear.hpp>

#include <cmath>

namespace sloper::cloth {

std::vector<ShearTriangle> make_shear(const ClothMesh& mesh) {
  std::vector<ShearTriangle> shear;
  shear.reserve(mesh.triangles.size());
  for (const RestTriangle& t : mesh.triangles) {
    const Vec2 a = t.flat[1] - t.flat[0], b = t.flat[2] - t.flat[0];
    const double det = a.x() * b.y() - a.y() * b.x();
    const Fabric& fabric = mesh.fabrics[t.fabric];
    ShearTriangle s;
    s.particle = t.particle;
    s.du = {(a.y() - b.y()) / det, b.y() / det, -a.y() / det};
    s.dv = {(b.x() - a.x()) / det, -b.x() / det, a.x() / det};
    s.stiffness = fabric.shear_n_m * 0.5 * std::abs(det);
    s.damping_s = fabric.damping_s;
    shear.push_back(s);
  }
  return shear;
}

void find_slots(std::vector<ShearTriangle>& shear, const BlockMatrix& matrix) {
  for (ShearTriangle& s : shear)
    for (int k = 0; k < 3; ++k)
      s.slots[k] = matrix.slot(s.particle[k], s.particle[(k + 1) % 3]);
}

static void images(const ShearTriangle& s, const std::vector<Vec3>& x, Vec3& wu, Vec3& wv) {
  wu = s.du[0] * x[s.particle[0]] + s.du[1] * x[s.particle[1]] + s.du[2] * x[s.particle[2]];
  wv = s.dv[0] * x[s.particle[0]] + s.dv[1] * x[s.particle[1]] + s.dv[2] * x[s.particle[2]];
}

double shear_energy(const std::vector<ShearTriangle>& shear, const std::vector<Vec3>& x) {
  double sum = 0;
  for (const ShearTriangle& s : shear) {
    Vec3 wu, wv;
    images(s, x, wu, wv);
    const double c = wu.dot(wv);
    sum += 0.5 * s.stiffness * c * c;
  }
  return sum;
}

void add_shear(const std::vector<ShearTriangle>& shear, const std::vector<Vec3>& x, double h,
               std::vector<Vec3>& force, BlockMatrix& stiffness) {
  for (const ShearTriangle& s : shear) {
    Vec3 wu, wv;
    images(s, x, wu, wv);
    const double c = wu.dot(wv);
    Vec3 gradient[3];
    for (int k = 0; k < 3; ++k) {
      gradient[k] = s.du[k] * wv + s.dv[k] * wu;
      force[s.particle[k]] -= s.stiffness * c * gradient[k];
    }
    const double k_damped = s.stiffness * (1 + s.damping_s / h);
    for (int k = 0; k < 3; ++k) {
      const int l = (k + 1) % 3;
      stiffness.add_diagonal(s.particle[k], k_damped * gradient[k] * gradient[k].transpose());
      const bool upper = s.particle[k] < s.particle[l];
      stiffness.add_off_diagonal(s.slots[k],
                                 k_damped * (upper ? gradient[k] * gradient[l].transpose()
                                                   : gradient[l] * gradient[k].transpose()));
    }
  }
}

void ShearEffect::declare(Couplings& couplings) const {
  for (const ShearTriangle& s : m_shear)
    for (int k = 0; k < 3; ++k)
      couplings.full.push_back({s.particle[k], s.particle[(k + 1) % 3]});
}

void ShearEffect::add_indefinite_part(const std::vector<Vec3>& x, BlockMatrix& stiffness) const {
  for (const ShearTriangle& s : m_shear) {
    Vec3 wu, wv;
    images(s, x, wu, wv);
    const double tension = s.stiffness * wu.dot(wv);
    for (int k = 0; k < 3; ++k) {
      const int l = (k + 1) % 3;
      stiffness.add_isotropic_diagonal(s.particle[k], 2 * tension * s.du[k] * s.dv[k]);
      stiffness.add_isotropic(s.slots[k], tension * (s.du[k] * s.dv[l] + s.dv[k] * s.du[l]));
    }
  }
}

} // namespace sloper::cloth
