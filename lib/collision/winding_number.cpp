#include <collision/winding_number.hpp>

#include <base/units.hpp>

#include <algorithm>
#include <cmath>

namespace sloper::collision {

namespace {

/// Moments of a piece of surface about a centre c, offsets e = x - c: sum n, sum n e^T, half the sum n_i e e^T for each i.
struct Moments {
  double area = 0;
  Vec3 center = Vec3::Zero(), normal = Vec3::Zero();
  Mat3 first = Mat3::Zero();
  std::array<Mat3, 3> second = {Mat3::Zero(), Mat3::Zero(), Mat3::Zero()};
};

Moments moments_of(const std::array<Vec3, 3>& corners, bool flipped) {
  Moments m;
  m.center = (corners[0] + corners[1] + corners[2]) / 3;
  m.normal = (flipped ? -0.5 : 0.5) * area_normal(corners[0], corners[1], corners[2]);
  m.area = m.normal.norm();
  Mat3 spread = Mat3::Zero();
  for (const Vec3& c : corners) spread += (c - m.center) * (c - m.center).transpose();
  for (int i = 0; i < 3; ++i) m.second[i] = (m.normal[i] / 24) * spread;
  return m;
}

/// sum += m taken about the centre of sum.
void add_shifted(Moments& sum, const Moments& m) {
  const Vec3 shift = m.center - sum.center;
  sum.normal += m.normal;
  sum.first += m.first + m.normal * shift.transpose();
  for (int i = 0; i < 3; ++i) {
    const Mat3 mixed = m.first.row(i).transpose() * shift.transpose();
    sum.second[i] += m.second[i] + 0.5 * (mixed + mixed.transpose()) + (0.5 * m.normal[i]) * (shift * shift.transpose());
  }
}

} // namespace

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
  m_far.resize(nodes.size());
  m_flipped_slot.assign(static_cast<std::size_t>(tree.n_slots()), 0);
  if (!flipped.empty())
    for (int s = 0; s < tree.n_slots(); ++s) m_flipped_slot[s] = flipped[tree.triangle_of_slot(s)];
  std::vector<Moments> moments(nodes.size());
  for (int node = static_cast<int>(nodes.size()) - 1; node >= 0; --node) {
    Moments lanes[4], &sum = moments[node];
    Vec3 weighted = Vec3::Zero(), middle = Vec3::Zero();
    int n_lanes = 0;
    for (int i = 0; i < 4; ++i) {
      const int child = nodes[node].child[i];
      if (child == TriangleTree::EMPTY) continue;
      lanes[i] = child >= 0 ? moments[child] : moments_of(tree.corners(-2 - child), m_flipped_slot[-2 - child]);
      sum.area += lanes[i].area;
      weighted += lanes[i].area * lanes[i].center;
      middle += lanes[i].center;
      ++n_lanes;
    }
    sum.center = sum.area > 0 ? Vec3(weighted / sum.area) : Vec3(middle / std::max(n_lanes, 1));
    for (int i = 0; i < 4; ++i) {
      if (nodes[node].child[i] == TriangleTree::EMPTY) continue;
      const Moments& m = lanes[i];
      add_shifted(sum, m);
      Expansion& far = m_far[node][i];
      far.center = m.center;
      far.area_normal = m.normal;
      const Mat3& f = m.first;
      far.first = {f(0, 0), f(1, 1), f(2, 2), f(0, 1) + f(1, 0), f(0, 2) + f(2, 0), f(1, 2) + f(2, 1)};
      const auto& s = m.second;
      for (int k = 0; k < 3; ++k) far.second_linear[k] = 2 * (s[0](0, k) + s[1](1, k) + s[2](2, k)) + s[k].trace();
      far.cubic = {s[0](0, 0),
                   s[1](1, 1),
                   s[2](2, 2),
                   2 * s[0](0, 1) + s[1](0, 0),
                   2 * s[0](0, 2) + s[2](0, 0),
                   2 * s[1](0, 1) + s[0](1, 1),
                   2 * s[1](1, 2) + s[2](1, 1),
                   2 * s[2](0, 2) + s[0](2, 2),
                   2 * s[2](1, 2) + s[1](2, 2),
                   2 * (s[0](1, 2) + s[1](0, 2) + s[2](0, 1))};
      // the farthest corner of the lane's box bounds the radius about the centre
      double radius2 = 0;
      for (int a = 0; a < 3; ++a) {
        const double low = m.center[a] - nodes[node].low[a][i], high = nodes[node].high[a][i] - m.center[a];
        radius2 += std::max(low * low, high * high);
      }
      far.reach2 = reach * reach * radius2;
    }
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
      const Expansion& far = m_far[node][i];
      const Vec3 d = far.center - p;
      const double r2 = d.squaredNorm();
      if (r2 > far.reach2) {
        const double x = d.x(), y = d.y(), z = d.z(), inverse2 = 1 / r2, xx = x * x, yy = y * y, zz = z * z;
        const auto& f = far.first;
        const auto& c = far.cubic;
        const double quadratic = f[0] * xx + f[1] * yy + f[2] * zz + f[3] * x * y + f[4] * x * z + f[5] * y * z;
        const double cubic =
            xx * (c[0] * x + c[3] * y + c[4] * z) + yy * (c[1] * y + c[5] * x + c[6] * z) + zz * (c[2] * z + c[7] * x + c[8] * y) + c[9] * x * y * z;
        far_field += (far.area_normal.dot(d) + f[0] + f[1] + f[2] - 3 * inverse2 * (quadratic + far.second_linear.dot(d)) + 15 * inverse2 * inverse2 * cubic) *
                     inverse2 * std::sqrt(inverse2);
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
