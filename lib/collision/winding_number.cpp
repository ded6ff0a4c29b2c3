#include <collision/winding_number.hpp>

#include <base/units.hpp>

#include <algorithm>
#include <cmath>

namespace sloper::collision {

double solid_angle_fraction(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c) {
  const Vec3 u = a - p, v = b - p, w = c - p;
  const double lu = u.norm(), lv = v.norm(), lw = w.norm();
  const double numerator = u.dot(v.cross(w));
  const double denominator = lu * lv * lw + u.dot(v) * lw + v.dot(w) * lu + w.dot(u) * lv;
  if (numerator == 0 && denominator <= 0) return 0; // p lies in the triangle: neither side
  return std::atan2(numerator, denominator) / (2 * units::PI);
}

WindingNumber::WindingNumber(const TriangleTree& tree, const std::vector<char>& flipped, double reach) {
  const auto& nodes = tree.nodes();
  m_dipoles.resize(nodes.size());
  m_flipped_slot.assign(static_cast<std::size_t>(tree.n_slots()), 0);
  if (!flipped.empty())
    for (int s = 0; s < tree.n_slots(); ++s) m_flipped_slot[s] = flipped[tree.triangle_of_slot(s)];
  std::vector<double> area(nodes.size(), 0); // per node, for the weights of its parent
  std::vector<Vec3> center(nodes.size(), Vec3::Zero()), normal(nodes.size(), Vec3::Zero());
  for (int node = static_cast<int>(nodes.size()) - 1; node >= 0; --node) {
    Vec3 moment = Vec3::Zero(), middle = Vec3::Zero();
    int lanes = 0;
    for (int i = 0; i < 4; ++i) {
      Dipole& dipole = m_dipoles[node][i];
      const int child = nodes[node].child[i];
      dipole.center = dipole.area_normal = Vec3::Zero();
      if (child == TriangleTree::EMPTY) continue;
      double lane_area;
      if (child <= -2) {
        const auto& c = tree.corners(-2 - child);
        dipole.center = (c[0] + c[1] + c[2]) / 3;
        dipole.area_normal = (m_flipped_slot[-2 - child] ? -0.5 : 0.5) * area_normal(c[0], c[1], c[2]);
        lane_area = dipole.area_normal.norm();
      } else {
        dipole.center = center[child];
        dipole.area_normal = normal[child];
        lane_area = area[child];
      }
      // the farthest corner of the lane's box bounds the radius about the centre
      double radius2 = 0;
      for (int a = 0; a < 3; ++a) {
        const double low = dipole.center[a] - nodes[node].low[a][i], high = nodes[node].high[a][i] - dipole.center[a];
        radius2 += std::max(low * low, high * high);
      }
      dipole.reach2 = reach * reach * radius2;
      moment += lane_area * dipole.center;
      middle += dipole.center;
      ++lanes;
      area[node] += lane_area;
      normal[node] += dipole.area_normal;
    }
    center[node] = area[node] > 0 ? Vec3(moment / area[node]) : Vec3(middle / std::max(lanes, 1));
  }
}

double WindingNumber::at(const TriangleTree& tree, const Vec3& p) const {
  const auto& nodes = tree.nodes();
  if (nodes.empty()) return 0;
  double far_field = 0, near_field = 0;
  int stack[128], top = 0;
  stack[top++] = 0;
  while (top > 0) {
    const int node = stack[--top];
    for (int i = 0; i < 4; ++i) {
      const int child = nodes[node].child[i];
      if (child == TriangleTree::EMPTY) continue;
      const Dipole& dipole = m_dipoles[node][i];
      const Vec3 d = dipole.center - p;
      const double distance2 = d.squaredNorm();
      if (distance2 > dipole.reach2) {
        far_field += dipole.area_normal.dot(d) / (distance2 * std::sqrt(distance2));
      } else if (child >= 0) {
        stack[top++] = child;
      } else {
        const auto& c = tree.corners(-2 - child);
        const double fraction = solid_angle_fraction(p, c[0], c[1], c[2]);
        near_field += m_flipped_slot[-2 - child] ? -fraction : fraction;
      }
    }
  }
  return far_field / (4 * units::PI) + near_field;
}

} // namespace sloper::collision
