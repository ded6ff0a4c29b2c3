#include <sloper/cloth/forces/triangle_stretch.hpp>

#include <algorithm>

namespace sloper::cloth {

/// A direction squeezed below this share of its length has no direction; it gives no force. 1
static constexpr double LEAST_STRETCH = 1e-9;

TriangleStretchEffect::TriangleStretchEffect(const ClothMesh& mesh, std::vector<Shrink> shrink)
    : m_mesh(mesh), m_maps(make_triangle_maps(mesh)), m_shrink(std::move(shrink)) {
  m_shrink.resize(m_maps.size());
}

double TriangleStretchEffect::energy(const std::vector<Vec3>& x) const {
  double sum = 0;
  for (std::size_t f = 0; f < m_maps.size(); ++f) {
    const TriangleMap& m = m_maps[f];
    const Fabric& fabric = m_mesh.fabrics[m.fabric];
    const double u = m.u(x).norm() - m_shrink[f].weft, v = m.v(x).norm() - m_shrink[f].warp;
    sum += 0.5 * m.area * (fabric.stretch_weft_n_m * u * u + fabric.stretch_warp_n_m * v * v);
  }
  return sum;
}

/// @param block  of the weft's and of the warp's direction, both symmetric
static void add_blocks(const TriangleMap& m, const Mat3 (&block)[2], BlockMatrix& stiffness) {
  for (int i = 0; i < 3; ++i) {
    const int j = (i + 1) % 3;
    stiffness.add_diagonal(m.particle[i],
                           m.du[i] * m.du[i] * block[0] + m.dv[i] * m.dv[i] * block[1]);
    stiffness.add_off_diagonal(m.slots[i],
                               m.du[i] * m.du[j] * block[0] + m.dv[i] * m.dv[j] * block[1]);
  }
}

void TriangleStretchEffect::add(StepContext& c) {
  for (std::size_t f = 0; f < m_maps.size(); ++f) {
    const TriangleMap& m = m_maps[f];
    const Fabric& fabric = m_mesh.fabrics[m.fabric];
    Mat3 block[2];
    for (int side = 0; side < 2; ++side) {
      const auto& d = side ? m.dv : m.du;
      const double rest = side ? m_shrink[f].warp : m_shrink[f].weft;
      const double k = m.area * (side ? fabric.stretch_warp_n_m : fabric.stretch_weft_n_m);
      const Vec3 w = side ? m.v(c.x) : m.u(c.x);
      const double length = w.norm();
      if (length < LEAST_STRETCH) {
        block[side] = k * Mat3::Identity();
        continue;
      }
      const Vec3 along = w / length, pull = k * (length - rest) * along;
      for (int i = 0; i < 3; ++i)
        c.force[m.particle[i]] -= d[i] * pull;
      const double across = k * std::max(1 - rest / length, 0.0);
      block[side] = (k * (1 + fabric.damping_s / c.h) - across) * along * along.transpose();
      block[side].diagonal().array() += across;
    }
    add_blocks(m, block, c.stiffness);
  }
}

void TriangleStretchEffect::add_indefinite_part(const std::vector<Vec3>& x,
                                                BlockMatrix& stiffness) const {
  for (std::size_t f = 0; f < m_maps.size(); ++f) {
    const TriangleMap& m = m_maps[f];
    const Fabric& fabric = m_mesh.fabrics[m.fabric];
    Mat3 block[2] = {Mat3::Zero(), Mat3::Zero()};
    bool squeezed = false;
    for (int side = 0; side < 2; ++side) {
      const double rest = side ? m_shrink[f].warp : m_shrink[f].weft;
      const Vec3 w = side ? m.v(x) : m.u(x);
      const double length = w.norm();
      if (length < LEAST_STRETCH || length >= rest)
        continue;
      squeezed = true;
      const double across =
          m.area * (side ? fabric.stretch_warp_n_m : fabric.stretch_weft_n_m) * (1 - rest / length);
      block[side] = -across / (length * length) * w * w.transpose();
      block[side].diagonal().array() += across;
    }
    if (squeezed)
      add_blocks(m, block, stiffness);
  }
}

} // namespace sloper::cloth
