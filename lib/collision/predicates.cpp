#include <sloper/collision/predicates.hpp>

#include <algorithm>
#include <cmath>

namespace sloper::collision {

namespace {

constexpr double EPSILON = 0x1.0p-53;

/// An exact sum of doubles that do not overlap, smallest first (Shewchuk 1997, section 2). Zero has
/// no terms.
template<int CAPACITY> struct Expansion {
  double term[CAPACITY];
  int size = 0;
  void push(double x) {
    if (x != 0)
      term[size++] = x;
  }
  int sign() const {
    if (size == 0)
      return 0;
    return term[size - 1] > 0 ? 1 : -1;
  }
};

/// a + b = sum + error exactly (Knuth).
void two_sum(double a, double b, double& sum, double& error) {
  sum = a + b;
  const double bb = sum - a;
  error = (a - (sum - bb)) + (b - bb);
}

/// a b = product + error exactly.
void two_product(double a, double b, double& product, double& error) {
  product = a * b;
  error = std::fma(a, b, -product);
}

Expansion<2> difference(double a, double b) {
  Expansion<2> e;
  double sum, error;
  two_sum(a, -b, sum, error);
  e.push(error);
  e.push(sum);
  return e;
}

/// e += b (grow-expansion, zeros dropped).
template<int N> void add(Expansion<N>& e, double b) {
  double q = b;
  int size = 0;
  for (int i = 0; i < e.size; ++i) {
    double sum, error;
    two_sum(q, e.term[i], sum, error);
    if (error != 0)
      e.term[size++] = error;
    q = sum;
  }
  if (q != 0)
    e.term[size++] = q;
  e.size = size;
}

template<int N, int M> Expansion<2 * N * M> product(const Expansion<N>& a, const Expansion<M>& b) {
  Expansion<2 * N * M> r;
  for (int i = 0; i < a.size; ++i)
    for (int j = 0; j < b.size; ++j) {
      double p, error;
      two_product(a.term[i], b.term[j], p, error);
      add(r, error);
      add(r, p);
    }
  return r;
}

template<int N, int M> void accumulate(Expansion<N>& total, const Expansion<M>& e, double sign) {
  for (int i = 0; i < e.size; ++i)
    add(total, sign * e.term[i]);
}

int exact_orientation(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
  Expansion<2> m[3][3];
  const Vec3* row[3] = {&a, &b, &c};
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j)
      m[i][j] = difference((*row[i])[j], d[j]);
  Expansion<192> total;
  for (int i = 0; i < 3; ++i) {
    const int j = (i + 1) % 3, k = (i + 2) % 3;
    accumulate(total, product(product(m[1][j], m[2][k]), m[0][i]), 1);
    accumulate(total, product(product(m[1][k], m[2][j]), m[0][i]), -1);
  }
  return total.sign();
}

int exact_area(double ax, double ay, double bx, double by, double cx, double cy) {
  Expansion<16> total;
  accumulate(total, product(difference(ax, cx), difference(by, cy)), 1);
  accumulate(total, product(difference(ay, cy), difference(bx, cx)), -1);
  return total.sign();
}

bool is_flat(const std::array<Vec3, 3>& t) {
  for (int drop = 0; drop < 3; ++drop)
    if (projected_orientation(t[0], t[1], t[2], drop) != 0)
      return false;
  return true;
}

/// Closed segments pq and rs in one plane, seen along `drop`.
bool segments_meet(const Vec3& p, const Vec3& q, const Vec3& r, const Vec3& s, int drop) {
  const int o1 = projected_orientation(p, q, r, drop), o2 = projected_orientation(p, q, s, drop);
  const int o3 = projected_orientation(r, s, p, drop), o4 = projected_orientation(r, s, q, drop);
  if (o1 * o2 > 0 || o3 * o4 > 0)
    return false;
  if (o1 != 0 || o2 != 0 || o3 != 0 || o4 != 0)
    return true;
  for (int i = 1; i < 3; ++i) { // on one line: the intervals must overlap in both coordinates
    const int x = (drop + i) % 3;
    if (std::max(p[x], q[x]) < std::min(r[x], s[x]) || std::max(r[x], s[x]) < std::min(p[x], q[x]))
      return false;
  }
  return true;
}

bool coplanar_point_in(const Vec3& p, const std::array<Vec3, 3>& t, int drop) {
  bool positive = false, negative = false;
  for (int k = 0; k < 3; ++k) {
    const int o = projected_orientation(t[k], t[(k + 1) % 3], p, drop);
    positive |= o > 0;
    negative |= o < 0;
  }
  return !(positive && negative);
}

bool coplanar_triangles_intersect(const std::array<Vec3, 3>& a, const std::array<Vec3, 3>& b) {
  int drop = 0;
  const Vec3 n = (a[1] - a[0]).cross(a[2] - a[0]).cwiseAbs();
  n.maxCoeff(&drop);
  for (int i = 0; i < 3 && projected_orientation(a[0], a[1], a[2], drop) == 0; ++i)
    drop = i;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j)
      if (segments_meet(a[i], a[(i + 1) % 3], b[j], b[(j + 1) % 3], drop))
        return true;
  return coplanar_point_in(a[0], b, drop) || coplanar_point_in(b[0], a, drop);
}

/// pq touches the plane of t (sides of p and q given, not both zero and not on one side): does it
/// do so inside t?
bool crosses_inside(const Vec3& p, const Vec3& q, const std::array<Vec3, 3>& t) {
  const int s0 = orientation(p, q, t[0], t[1]), s1 = orientation(p, q, t[1], t[2]);
  if (s0 * s1 < 0)
    return false;
  const int s2 = orientation(p, q, t[2], t[0]);
  return s0 * s2 >= 0 && s1 * s2 >= 0;
}

} // namespace

int orientation(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
  const double adx = a.x() - d.x(), ady = a.y() - d.y(), adz = a.z() - d.z();
  const double bdx = b.x() - d.x(), bdy = b.y() - d.y(), bdz = b.z() - d.z();
  const double cdx = c.x() - d.x(), cdy = c.y() - d.y(), cdz = c.z() - d.z();
  const double bc1 = bdx * cdy, bc2 = cdx * bdy, ca1 = cdx * ady, ca2 = adx * cdy, ab1 = adx * bdy,
               ab2 = bdx * ady;
  const double det = adz * (bc1 - bc2) + bdz * (ca1 - ca2) + cdz * (ab1 - ab2);
  const double permanent = (std::abs(bc1) + std::abs(bc2)) * std::abs(adz) +
                           (std::abs(ca1) + std::abs(ca2)) * std::abs(bdz) +
                           (std::abs(ab1) + std::abs(ab2)) * std::abs(cdz);
  const double bound = (7 + 56 * EPSILON) * EPSILON * permanent;
  if (det > bound)
    return 1;
  if (-det > bound)
    return -1;
  if (permanent == 0)
    return 0;
  return exact_orientation(a, b, c, d);
}

int projected_orientation(const Vec3& a, const Vec3& b, const Vec3& c, int drop) {
  const int x = (drop + 1) % 3, y = (drop + 2) % 3;
  const double left = (a[x] - c[x]) * (b[y] - c[y]), right = (a[y] - c[y]) * (b[x] - c[x]);
  const double det = left - right,
               bound = (3 + 16 * EPSILON) * EPSILON * (std::abs(left) + std::abs(right));
  if (det > bound)
    return 1;
  if (-det > bound)
    return -1;
  if (left == 0 && right == 0)
    return 0;
  return exact_area(a[x], a[y], b[x], b[y], c[x], c[y]);
}

bool segment_crosses_triangle(const Vec3& p, const Vec3& q, const std::array<Vec3, 3>& t) {
  const int sp = orientation(t[0], t[1], t[2], p), sq = orientation(t[0], t[1], t[2], q);
  if (sp * sq > 0 || (sp == 0 && sq == 0))
    return false;
  return crosses_inside(p, q, t);
}

bool triangles_intersect(const std::array<Vec3, 3>& a, const std::array<Vec3, 3>& b) {
  int side_b[3], side_a[3];
  for (int k = 0; k < 3; ++k)
    side_b[k] = orientation(a[0], a[1], a[2], b[k]);
  if ((side_b[0] > 0 && side_b[1] > 0 && side_b[2] > 0) ||
      (side_b[0] < 0 && side_b[1] < 0 && side_b[2] < 0))
    return false;
  for (int k = 0; k < 3; ++k)
    side_a[k] = orientation(b[0], b[1], b[2], a[k]);
  if ((side_a[0] > 0 && side_a[1] > 0 && side_a[2] > 0) ||
      (side_a[0] < 0 && side_a[1] < 0 && side_a[2] < 0))
    return false;
  const bool coplanar = side_a[0] == 0 && side_a[1] == 0 && side_a[2] == 0;
  if (coplanar || (side_b[0] == 0 && side_b[1] == 0 && side_b[2] == 0)) {
    if (is_flat(a) || is_flat(b))
      return false;
    return coplanar && coplanar_triangles_intersect(a, b);
  }
  // Neither is flat, or a plane would have had all signs zero. The common segment ends on an edge
  // of a or of b.
  for (int k = 0; k < 3; ++k) {
    const int next = (k + 1) % 3;
    if (side_a[k] * side_a[next] <= 0 && (side_a[k] != 0 || side_a[next] != 0) &&
        crosses_inside(a[k], a[next], b))
      return true;
    if (side_b[k] * side_b[next] <= 0 && (side_b[k] != 0 || side_b[next] != 0) &&
        crosses_inside(b[k], b[next], a))
      return true;
  }
  return false;
}

} // namespace sloper::collision
