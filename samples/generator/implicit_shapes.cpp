#include "implicit_shapes.hpp"
#include <algorithm>
#include <cmath>
namespace sloper::samples {

MonotoneCurve::MonotoneCurve(std::vector<double> x, std::vector<double> y)
    : m_x(std::move(x)), m_y(std::move(y)), m_slope(m_x.size(), 0.0) {
  const std::size_t n = m_x.size();
  std::vector<double> d(n - 1);
  for (std::size_t i = 0; i + 1 < n; ++i)
    d[i] = (m_y[i + 1] - m_y[i]) / (m_x[i + 1] - m_x[i]);
  m_slope[0] = d[0];
  m_slope[n - 1] = d[n - 2];
  for (std::size_t i = 1; i + 1 < n; ++i) {
    if (d[i - 1] * d[i] <= 0)
      continue;
    // The weighted harmonic mean keeps the curve monotone between knots.
    const double h0 = m_x[i] - m_x[i - 1], h1 = m_x[i + 1] - m_x[i];
    const double w0 = 2 * h1 + h0, w1 = h1 + 2 * h0;
    m_slope[i] = (w0 + w1) / (w0 / d[i - 1] + w1 / d[i]);
  }
}

double MonotoneCurve::at(double x) const {
  if (x <= m_x.front())
    return m_y.front();
  if (x >= m_x.back())
    return m_y.back();
  const std::size_t i =
      static_cast<std::size_t>(std::upper_bound(m_x.begin(), m_x.end(), x) - m_x.begin()) - 1;
  const double h = m_x[i + 1] - m_x[i], t = (x - m_x[i]) / h, s = 1 - t;
  return s * s * (1 + 2 * t) * m_y[i] + t * t * (1 + 2 * s) * m_y[i + 1] +
         h * t * s * (s * m_slope[i] - t * m_slope[i + 1]);
}

Tube::Tube(const std::vector<TubeKnot>& knots, double round_low, double round_high)
    : m_round_low(round_low), m_round_high(round_high) {
  static constexpr double TubeKnot::*CHANNELS[] = {
      &TubeKnot::center_x, &TubeKnot::center_z, &TubeKnot::left,    &TubeKnot::right,
      &TubeKnot::front,    &TubeKnot::back,     &TubeKnot::exponent};
  constexpr int N = 400; // a table, so that a distance costs one linear interpolation
  m_low = knots.front().y;
  m_high = knots.back().y;
  m_step = (m_high - m_low) / N;
  m_table.resize(N + 1);
  std::vector<double> x, y;
  for (const TubeKnot& k : knots)
    x.push_back(k.y);
  for (auto channel : CHANNELS) {
    y.clear();
    for (const TubeKnot& k : knots)
      y.push_back(k.*channel);
    const MonotoneCurve curve(x, y);
    for (int i = 0; i <= N; ++i) {
      m_table[i].y = m_low + m_step * i;
      m_table[i].*channel = curve.at(m_table[i].y);
    }
  }
}

TubeKnot Tube::section(double y) const {
  const double u =
      std::clamp((y - m_low) / m_step, 0.0, static_cast<double>(m_table.size() - 1) - 1e-9);
  const int i = static_cast<int>(u);
  const double t = u - i;
  const TubeKnot &a = m_table[i], &b = m_table[i + 1];
  const auto mix = [t](double p, double q) { return p + t * (q - p); };
  return {mix(a.y, b.y),       mix(a.center_x, b.center_x), mix(a.center_z, b.center_z),
          mix(a.left, b.left), mix(a.right, b.right),       mix(a.front, b.front),
          mix(a.back, b.back), mix(a.exponent, b.exponent)};
}

/// (u^e + v^e)^(1/e) of two numbers that are not negative: one power less than as it stands, and
/// none for a circle.
static double power_norm(double u, double v, double e) {
  if (e == 2)
    return std::sqrt(u * u + v * v);
  const double larger = std::max(u, v);
  const double smaller = std::min(u, v);
  if (smaller == 0)
    return larger;
  return larger * std::pow(1 + std::pow(smaller / larger, e), 1 / e);
}

double Tube::distance(const Vec3& p) const {
  const TubeKnot s = section(p.y());
  const double x = p.x() - s.center_x, z = p.z() - s.center_z;
  const double u = std::abs(x) / (x > 0 ? s.left : s.right),
               v = std::abs(z) / (z > 0 ? s.front : s.back);
  const double rho = power_norm(u, v, s.exponent);
  const double r = std::sqrt(x * x + z * z);
  const double inner = std::min(std::min(s.left, s.right), std::min(s.front, s.back));
  // Along the ray from the section's centre; near the centre itself the ray has no direction.
  const double side = rho < 1e-6 ? -inner : r - r / rho;
  double d = round_intersection(side, p.y() - m_high, m_round_high);
  return round_intersection(d, m_low - p.y(), m_round_low);
}

double ellipsoid_distance(const Vec3& p, const Vec3& center, const Vec3& radii) {
  const Vec3 q = (p - center).cwiseQuotient(radii);
  const double k0 = q.norm(), k1 = q.cwiseQuotient(radii).norm();
  return k1 < 1e-9 ? -radii.minCoeff() : k0 * (k0 - 1) / k1;
}

double round_cone_distance(const Vec3& p, const Vec3& a, const Vec3& b, double ra, double rb) {
  const Vec3 ab = b - a;
  const double t = std::clamp((p - a).dot(ab) / ab.squaredNorm(), 0.0, 1.0);
  return (p - a - t * ab).norm() - (ra + t * (rb - ra));
}

double smooth_union(double a, double b, double k) {
  if (k <= 0)
    return std::min(a, b);
  const double h = std::max(k - std::abs(a - b), 0.0) / k;
  return std::min(a, b) - h * h * k / 4;
}

double round_intersection(double a, double b, double r) {
  if (r <= 0)
    return std::max(a, b);
  const double u = std::max(a + r, 0.0), v = std::max(b + r, 0.0);
  return std::min(-r, std::max(a, b)) + std::sqrt(u * u + v * v);
}

double smooth_step(double low, double high, double x) {
  const double t = std::clamp((x - low) / (high - low), 0.0, 1.0);
  return t * t * (3 - 2 * t);
}

} // namespace sloper::samples
