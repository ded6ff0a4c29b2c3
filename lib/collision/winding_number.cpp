#include <sloper/collision/winding_number.hpp>

#include <sloper/base/units.hpp>

#include <algorithm>
#include <cmath>

namespace sloper::collision {

namespace {

using Quadratic = std::array<double, 6>; ///< coefficients of xx yy zz xy xz yz
using Cubic = std::array<double, 10>; ///< coefficients of xxx yyy zzz xxy xxz yyx yyz zzx zzy xyz

/// Moments of a piece of surface about its centre, as the series asks for them: with offsets e, and
/// K the half of the sum of e e^T, per bit of surface, the normal n, (n . d)(e . d), 2 K n + tr(K)
/// n, and (n . d)(d . K d).
struct Moments {
  double area = 0;
  Vec3 center = Vec3::Zero(), normal = Vec3::Zero(), linear = Vec3::Zero();
  Quadratic first = {};
  Cubic cubic = {};
};

Quadratic product(const Vec3& a, const Vec3& b) {
  return {a[0] * b[0],
          a[1] * b[1],
          a[2] * b[2],
          a[0] * b[1] + a[1] * b[0],
          a[0] * b[2] + a[2] * b[0],
          a[1] * b[2] + a[2] * b[1]};
}

void add_product(const Quadratic& q, const Vec3& s, Cubic& sum) {
  sum[0] += q[0] * s[0];
  sum[1] += q[1] * s[1];
  sum[2] += q[2] * s[2];
  sum[3] += q[0] * s[1] + q[3] * s[0];
  sum[4] += q[0] * s[2] + q[4] * s[0];
  sum[5] += q[1] * s[0] + q[3] * s[1];
  sum[6] += q[1] * s[2] + q[5] * s[1];
  sum[7] += q[2] * s[0] + q[4] * s[2];
  sum[8] += q[2] * s[1] + q[5] * s[2];
  sum[9] += q[3] * s[2] + q[4] * s[1] + q[5] * s[0];
}

/// Twice the symmetric matrix of the form, times s.
Vec3 twice_times(const Quadratic& q, const Vec3& s) {
  return {2 * q[0] * s[0] + q[3] * s[1] + q[4] * s[2], q[3] * s[0] + 2 * q[1] * s[1] + q[5] * s[2],
          q[4] * s[0] + q[5] * s[1] + 2 * q[2] * s[2]};
}

Moments moments_of(const std::array<Vec3, 3>& corners) {
  Moments m;
  m.center = (corners[0] + corners[1] + corners[2]) / 3;
  m.normal = 0.5 * area_normal(corners[0], corners[1], corners[2]);
  m.area = m.normal.norm();
  Quadratic k = {};
  for (const Vec3& c : corners) {
    const Quadratic e = product(c - m.center, c - m.center);
    for (int i = 0; i < 6; ++i)
      k[i] += e[i] / 24;
  }
  m.linear = twice_times(k, m.normal) + (k[0] + k[1] + k[2]) * m.normal;
  add_product(k, m.normal, m.cubic);
  return m;
}

/// sum += m taken about the centre of sum.
void add_shifted(Moments& sum, const Moments& m) {
  const Vec3 shift = m.center - sum.center;
  const Quadratic moved = product(m.normal, shift);
  Quadratic half;
  for (int i = 0; i < 6; ++i) {
    half[i] = m.first[i] + 0.5 * moved[i];
    sum.first[i] += m.first[i] + moved[i];
  }
  sum.normal += m.normal;
  sum.linear += m.linear + twice_times(half, shift) + (half[0] + half[1] + half[2]) * shift;
  for (int i = 0; i < 10; ++i)
    sum.cubic[i] += m.cubic[i];
  add_product(half, shift, sum.cubic);
}

/// Numerator and denominator of the tangent of half the solid angle.
std::array<double, 2> half_solid_angle(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c) {
  const Vec3 u = a - p, v = b - p, w = c - p;
  const double lu = u.norm(), lv = v.norm(), lw = w.norm();
  return {u.dot(v.cross(w)), lu * lv * lw + u.dot(v) * lw + v.dot(w) * lu + w.dot(u) * lv};
}

/// A sum of angles, each within half a turn, of which the tangents are known: as a product of
/// complex numbers, with one arc tangent at the end.
class AngleSum {
public:
  void add(double sine, double cosine) {
    const double im = m_re * sine + m_im * cosine +
                      0.0; // never -0, which an arc tangent takes for the other side
    const double re = m_re * cosine - m_im * sine;
    if (m_im >= 0 && sine >= 0 && im < 0)
      ++m_turns;
    if (m_im < 0 && sine < 0 && im >= 0)
      --m_turns;
    const double size = std::abs(re) + std::abs(im);
    const double scale = size < 1e-100 || size > 1e100 ? 1 / size : 1;
    m_re = scale * re;
    m_im = scale * im;
  }
  double turns() const { return std::atan2(m_im, m_re) / (2 * units::PI) + m_turns; }

private:
  double m_re = 1, m_im = 0;
  int m_turns = 0;
};

} // namespace

double solid_angle_fraction(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c) {
  const auto [sine, cosine] = half_solid_angle(p, a, b, c);
  if (sine == 0 && cosine <= 0)
    return 0; // p lies in the triangle: neither side
  return std::atan2(sine, cosine) / (2 * units::PI);
}

WindingNumber::WindingNumber(const TriangleTree& tree, double reach) {
  const auto& nodes = tree.nodes();
  m_far_of_node.assign(nodes.size(), -1);
  int n_far = 0;
  for (std::size_t node = 0; node < nodes.size(); ++node)
    if (std::any_of(nodes[node].child, nodes[node].child + 4, [](int child) { return child >= 0; }))
      m_far_of_node[node] = n_far++;
  m_far.resize(static_cast<std::size_t>(n_far));
  std::vector<Moments> waiting; // of the nodes whose parent is still to come, the last first
  for (int node = static_cast<int>(nodes.size()) - 1; node >= 0; --node) {
    Moments lanes[4], sum;
    Vec3 weighted = Vec3::Zero(), middle = Vec3::Zero();
    int n_lanes = 0;
    for (int i = 0; i < 4; ++i) {
      const int child = nodes[node].child[i];
      if (child == TriangleTree::EMPTY)
        continue;
      if (child >= 0) {
        lanes[i] = waiting.back();
        waiting.pop_back();
      } else
        lanes[i] = moments_of(tree.corners(-2 - child));
      sum.area += lanes[i].area;
      weighted += lanes[i].area * lanes[i].center;
      middle += lanes[i].center;
      ++n_lanes;
    }
    sum.center = sum.area > 0 ? Vec3(weighted / sum.area) : Vec3(middle / std::max(n_lanes, 1));
    for (int i = 0; i < 4; ++i)
      if (nodes[node].child[i] != TriangleTree::EMPTY)
        add_shifted(sum, lanes[i]);
    waiting.push_back(sum);
    if (m_far_of_node[node] < 0)
      continue;
    FarField& far = m_far[m_far_of_node[node]];
    for (int i = 0; i < 4; ++i) {
      const Moments& m = lanes[i];
      const auto fill = [i](float(*to)[4], const auto& from, int n) {
        for (int k = 0; k < n; ++k)
          to[k][i] = static_cast<float>(from[k]);
      };
      fill(far.center, m.center, 3);
      fill(far.normal, m.normal, 3);
      fill(far.first, m.first, 6);
      fill(far.linear, m.linear, 3);
      fill(far.cubic, m.cubic, 10);
      // the farthest corner of the lane's box bounds the radius about the centre
      double radius2 = 0;
      for (int a = 0; a < 3; ++a) {
        const double low = m.center[a] - nodes[node].low[a][i],
                     high = nodes[node].high[a][i] - m.center[a];
        radius2 += std::max(low * low, high * high);
      }
      far.reach2[i] = nodes[node].child[i] >= 0 ? static_cast<float>(reach * reach * radius2)
                                                : std::numeric_limits<float>::infinity();
    }
  }
}

double WindingNumber::at(const TriangleTree& tree, const Vec3& p) const {
  const auto& nodes = tree.nodes();
  if (nodes.empty())
    return 0;
  const Float4 px = Float4::all(static_cast<float>(p.x())),
               py = Float4::all(static_cast<float>(p.y())),
               pz = Float4::all(static_cast<float>(p.z()));
  const Float4 nearest2 =
      Float4::all(1e-18f); // m2: for lanes about whose centre p lies, and which do not count
  const Float4 one = Float4::all(1), three = Float4::all(3), fifteen = Float4::all(15);
  Float4 far_field = Float4::all(0);
  AngleSum near_field;
  const auto add_triangle = [&](int slot) {
    const auto& c = tree.corners(slot);
    const auto [sine, cosine] = half_solid_angle(p, c[0], c[1], c[2]);
    if (sine != 0 || cosine > 0)
      near_field.add(sine, cosine); // else p lies in the triangle: neither side
  };
  int stack[128], top = 0;
  stack[top++] = 0;
  while (top > 0) {
    const int node = stack[--top];
    const auto& child = nodes[node].child;
    if (m_far_of_node[node] < 0) {
      for (int i = 0; i < 4; ++i)
        if (child[i] != TriangleTree::EMPTY)
          add_triangle(-2 - child[i]);
      continue;
    }
    const FarField& far = m_far[m_far_of_node[node]];
    const Float4 dx = Float4::load(far.center[0]) - px, dy = Float4::load(far.center[1]) - py,
                 dz = Float4::load(far.center[2]) - pz;
    const Float4 r2 = dx * dx + dy * dy + dz * dz, reach2 = Float4::load(far.reach2);
    int near = less_equal(r2, reach2);
    if (near != 15) {
      const Float4 inverse = one / square_root(max(r2, nearest2)), x = dx * inverse,
                   y = dy * inverse, z = dz * inverse;
      const auto& f = far.first;
      const auto& c = far.cubic;
      const auto get = [](const float* lanes) { return Float4::load(lanes); };
      const Float4 xx = x * x, yy = y * y, zz = z * z;
      const Float4 quadratic = get(f[0]) * xx + get(f[1]) * yy + get(f[2]) * zz +
                               get(f[3]) * x * y + get(f[4]) * x * z + get(f[5]) * y * z;
      const Float4 cubic = xx * (get(c[0]) * x + get(c[3]) * y + get(c[4]) * z) +
                           yy * (get(c[1]) * y + get(c[5]) * x + get(c[6]) * z) +
                           zz * (get(c[2]) * z + get(c[7]) * x + get(c[8]) * y) +
                           get(c[9]) * x * y * z;
      const Float4 of_normal =
          get(far.normal[0]) * x + get(far.normal[1]) * y + get(far.normal[2]) * z;
      const Float4 of_first = get(f[0]) + get(f[1]) + get(f[2]) - three * quadratic;
      const Float4 of_second =
          fifteen * cubic -
          three * (get(far.linear[0]) * x + get(far.linear[1]) * y + get(far.linear[2]) * z);
      far_field = far_field + where_less((of_normal + (of_first + of_second * inverse) * inverse) *
                                             inverse * inverse,
                                         reach2, r2);
    }
    while (near) {
      const int i = std::countr_zero(static_cast<unsigned>(near));
      near &= near - 1;
      if (child[i] >= 0)
        stack[top++] = child[i];
      else if (child[i] != TriangleTree::EMPTY)
        add_triangle(-2 - child[i]);
    }
  }
  alignas(16) float sums[4];
  far_field.store(sums);
  return (static_cast<double>(sums[0]) + sums[1] + sums[2] + sums[3]) / (4 * units::PI) +
         near_field.turns();
}

} // namespace sloper::collision
