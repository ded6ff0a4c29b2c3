#include <sloper/cloth/forces/membrane.hpp>

#include <Eigen/Eigenvalues>
#include <algorithm>

namespace sloper::cloth {

MembraneEffect::MembraneEffect(const ClothMesh& mesh) : m_maps(make_triangle_maps(mesh)) {
  for (const Fabric& f : mesh.fabrics) {
    const double yu = f.stretch_weft_n_m, yv = f.stretch_warp_n_m,
                 ratio = f.poisson / std::max(yu, yv);
    const double determinant = 1 - ratio * yu * ratio * yv; // 1 - nu_uv nu_vu > 0 for nu < 1
    m_elasticity.push_back({yu / determinant, ratio * yu * yv / determinant, yv / determinant,
                            f.shear_n_m, f.damping_s});
  }
}

double MembraneEffect::energy(const std::vector<Vec3>& x) const {
  double sum = 0;
  for (const TriangleMap& m : m_maps) {
    const Elasticity& c = m_elasticity[m.fabric];
    const Vec3 u = m.u(x), v = m.v(x);
    const double euu = 0.5 * (u.squaredNorm() - 1), evv = 0.5 * (v.squaredNorm() - 1), g = u.dot(v);
    sum += 0.5 * m.area *
           (c.uu * euu * euu + 2 * c.uv * euu * evv + c.vv * evv * evv + c.shear * g * g);
  }
  return sum;
}

using Mat2 = Eigen::Matrix2d;

/// A symmetric matrix without its negative part, or that part alone.
static Mat2 part_of(const Mat2& a, bool positive) {
  Eigen::SelfAdjointEigenSolver<Mat2> eigen;
  eigen.computeDirect(a);
  const Vec2 values =
      positive ? Vec2(eigen.eigenvalues().cwiseMax(0)) : Vec2(eigen.eigenvalues().cwiseMin(0));
  return eigen.eigenvectors() * values.asDiagonal() * eigen.eigenvectors().transpose();
}

Eigen::Matrix2d MembraneEffect::stress_of(const TriangleMap& m, const Vec3& u,
                                          const Vec3& v) const {
  const Elasticity& c = m_elasticity[m.fabric];
  const double euu = 0.5 * (u.squaredNorm() - 1), evv = 0.5 * (v.squaredNorm() - 1),
               suv = c.shear * u.dot(v);
  Mat2 stress;
  stress << c.uu * euu + c.uv * evv, suv, suv, c.vv * evv + c.uv * euu;
  return m.area * stress;
}

void MembraneEffect::add(StepContext& context) {
  for (const TriangleMap& m : m_maps) {
    const Elasticity& c = m_elasticity[m.fabric];
    const Vec3 u = m.u(context.x), v = m.v(context.x);
    const Mat2 stress = stress_of(m, u, v);
    Vec3 du[3], dv[3], dg[3]; // gradients of the three strains
    for (int k = 0; k < 3; ++k) {
      du[k] = m.du[k] * u;
      dv[k] = m.dv[k] * v;
      dg[k] = m.du[k] * v + m.dv[k] * u;
      context.force[m.particle[k]] -=
          stress(0, 0) * du[k] + stress(1, 1) * dv[k] + stress(0, 1) * dg[k];
    }
    // The second derivatives of the strains are scalars times I, so the geometric part is (d_k^T S
    // d_l) I with the 2 x 2 stress.
    const Mat2 pulling = part_of(stress, true);
    const double damped = m.area * (1 + c.damping_s / context.h);
    auto block = [&](int k, int l) {
      const double side = Vec2(m.du[k], m.dv[k]).dot(pulling * Vec2(m.du[l], m.dv[l]));
      Mat3 b = damped * (du[k] * (c.uu * du[l] + c.uv * dv[l]).transpose() +
                         dv[k] * (c.vv * dv[l] + c.uv * du[l]).transpose() +
                         c.shear * dg[k] * dg[l].transpose());
      b.diagonal().array() += side;
      return b;
    };
    for (int k = 0; k < 3; ++k) {
      context.stiffness.add_diagonal(m.particle[k], block(k, k));
      add_side(m, k, block(k, (k + 1) % 3), context.stiffness);
    }
  }
}

void MembraneEffect::add_indefinite_part(const std::vector<Vec3>& x, BlockMatrix& stiffness) const {
  for (const TriangleMap& m : m_maps) {
    const Mat2 pushing = part_of(stress_of(m, m.u(x), m.v(x)), false);
    if (pushing.isZero(0))
      continue;
    for (int k = 0; k < 3; ++k) {
      const Vec2 d = pushing * Vec2(m.du[k], m.dv[k]);
      const int l = (k + 1) % 3;
      stiffness.add_isotropic_diagonal(m.particle[k], d.dot(Vec2(m.du[k], m.dv[k])));
      stiffness.add_isotropic(m.slots[k], d.dot(Vec2(m.du[l], m.dv[l])));
    }
  }
}

} // namespace sloper::cloth
