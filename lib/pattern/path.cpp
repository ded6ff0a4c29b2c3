#include <sloper/base/units.hpp>
#include <sloper/pattern/path.hpp>

#include <algorithm>
#include <cmath>

namespace sloper::pattern {

Segment Segment::straight(const Vec2& a, const Vec2& b) {
  return {{a, a + (b - a) / 3.0, b + (a - b) / 3.0, b}, true};
}

Segment Segment::quadratic(const Vec2& a, const Vec2& control, const Vec2& b) {
  return {{a, a + (control - a) * (2.0 / 3.0), b + (control - b) * (2.0 / 3.0), b}, false};
}

Segment Segment::cubic(const Vec2& a, const Vec2& c1, const Vec2& c2, const Vec2& b) {
  return {{a, c1, c2, b}, false};
}

Vec2 Segment::at(double t) const {
  if (t <= 0)
    return p[0];
  if (t >= 1)
    return p[3];
  const double u = 1 - t;
  if (line)
    return u * p[0] + t * p[3];
  return u * u * u * p[0] + 3 * u * u * t * p[1] + 3 * u * t * t * p[2] + t * t * t * p[3];
}

Vec2 Segment::derivative(double t) const {
  if (line)
    return p[3] - p[0];
  const double u = 1 - t;
  return 3 * u * u * (p[1] - p[0]) + 6 * u * t * (p[2] - p[1]) + 3 * t * t * (p[3] - p[2]);
}

double Segment::length(double t0, double t1) const {
  if (line)
    return (t1 - t0) * (p[3] - p[0]).norm();
  static constexpr double X[5] = {0, 0.538469310105683, -0.538469310105683, 0.906179845938664,
                                  -0.906179845938664};
  static constexpr double W[5] = {0.568888888888889, 0.478628670499366, 0.478628670499366,
                                  0.236926885056189, 0.236926885056189};
  double sum = 0;
  for (int i = 0; i < 5; ++i)
    sum += W[i] * derivative(0.5 * (t0 + t1) + 0.5 * (t1 - t0) * X[i]).norm();
  return 0.5 * (t1 - t0) * sum;
}

Segment Segment::reversed() const {
  return {{p[3], p[2], p[1], p[0]}, line};
}

Path circle_arc(const Vec2& a, const Vec2& b, double radius, bool large, bool ccw) {
  const Vec2 chord = b - a;
  const double half = 0.5 * chord.norm();
  if (half == 0)
    return {Segment::straight(a, b)};
  radius = std::max(radius, half);
  const Vec2 left = Vec2(-chord.y(), chord.x()) / (2 * half);
  // The centre lies to the left of the way for a short counter-clockwise arc, and for a long
  // clockwise one.
  const double offset =
      std::sqrt(std::max(0.0, radius * radius - half * half)) * (large == ccw ? -1 : 1);
  const Vec2 center = 0.5 * (a + b) + offset * left;
  double sweep = 2 * std::asin(std::min(1.0, half / radius));
  if (large)
    sweep = 2 * units::PI - sweep;
  if (!ccw)
    sweep = -sweep;
  const int n = std::max(1, static_cast<int>(std::ceil(std::abs(sweep) / (units::PI / 12) - 1e-9)));
  const double step = sweep / n, handle = 4.0 / 3.0 * std::tan(step / 4);
  const double start = std::atan2(a.y() - center.y(), a.x() - center.x());
  Path path;
  Vec2 from = a;
  for (int i = 0; i < n; ++i) {
    const double t0 = start + i * step, t1 = t0 + step;
    const Vec2 to = i + 1 == n ? b : Vec2(center + radius * Vec2(std::cos(t1), std::sin(t1)));
    path.push_back(Segment::cubic(from, from + handle * radius * Vec2(-std::sin(t0), std::cos(t0)),
                                  to - handle * radius * Vec2(-std::sin(t1), std::cos(t1)), to));
    from = to;
  }
  return path;
}

Path reversed(const Path& path) {
  Path out;
  for (auto it = path.rbegin(); it != path.rend(); ++it)
    out.push_back(it->reversed());
  return out;
}

ArcLength::ArcLength(const Path& path) : m_path(&path) {
  m_knots.push_back({0, 0.0, 0.0});
  for (std::size_t k = 0; k < path.size(); ++k) {
    const int n = path[k].line ? 1 : 16;
    for (int i = 0; i < n; ++i) {
      const double t0 = static_cast<double>(i) / n, t1 = static_cast<double>(i + 1) / n;
      m_knots.push_back({static_cast<int>(k), t1, m_knots.back().s + path[k].length(t0, t1)});
    }
  }
}

std::pair<int, double> ArcLength::locate(double s) const {
  const auto it = std::lower_bound(m_knots.begin() + 1, m_knots.end() - 1, s,
                                   [](const Knot& k, double value) { return k.s < value; });
  const Knot& after = *it;
  const Knot& before = *(it - 1);
  const double t0 =
      before.segment == after.segment ? before.t : 0.0; // a segment begins where the last one ended
  const double span = after.s - before.s;
  double t = span > 0 ? t0 + (after.t - t0) * (s - before.s) / span : t0;
  const Segment& segment = (*m_path)[after.segment];
  for (int i = 0; i < 3 && !segment.line; ++i) {
    const double speed = segment.derivative(t).norm();
    if (speed <= 0)
      break;
    t = std::clamp(t - (segment.length(t0, t) - (s - before.s)) / speed, t0, after.t);
  }
  return {after.segment, t};
}

Vec2 ArcLength::at(double s) const {
  if (s <= 0)
    return m_path->front().p[0];
  if (s >= length())
    return m_path->back().p[3];
  const auto [segment, t] = locate(s);
  return (*m_path)[segment].at(t);
}

Vec2 ArcLength::tangent(double s) const {
  const auto [segment, t] = locate(std::clamp(s, 0.0, length()));
  const Segment& curve = (*m_path)[segment];
  Vec2 d = curve.derivative(t);
  if (d.norm() < 1e-12)
    d = curve.at(std::min(1.0, t + 1e-3)) -
        curve.at(std::max(0.0, t - 1e-3)); // a control point on an end
  return d.norm() > 0 ? Vec2(d.normalized()) : Vec2(1, 0);
}

namespace {

/// The part of a segment from parameter t0 to t1, by de Casteljau.
Segment part_of(const Segment& s, double t0, double t1) {
  const auto blossom = [&](double a, double b, double c) {
    const auto mix = [](const Vec2& p, const Vec2& q, double t) { return Vec2(p + t * (q - p)); };
    const Vec2 p01 = mix(s.p[0], s.p[1], a), p12 = mix(s.p[1], s.p[2], a),
               p23 = mix(s.p[2], s.p[3], a);
    return mix(mix(p01, p12, b), mix(p12, p23, b), c);
  };
  if (s.line)
    return Segment::straight(s.at(t0), s.at(t1));
  return Segment::cubic(blossom(t0, t0, t0), blossom(t0, t0, t1), blossom(t0, t1, t1),
                        blossom(t1, t1, t1));
}

} // namespace

Path ArcLength::between(double s0, double s1) const {
  const bool from_start = s0 <= 0, to_end = s1 >= length();
  const auto [k0, t0] = from_start ? std::pair<int, double>{0, 0.0} : locate(s0);
  const auto [k1, t1] =
      to_end ? std::pair<int, double>{static_cast<int>(m_path->size()) - 1, 1.0} : locate(s1);
  Path out;
  for (int k = k0; k <= k1; ++k) {
    const double a = k == k0 ? t0 : 0.0, b = k == k1 ? t1 : 1.0;
    if (b - a < 1e-12)
      continue;
    const Segment& segment = (*m_path)[k];
    out.push_back(a == 0 && b == 1 ? segment : part_of(segment, a, b));
  }
  if (out.empty())
    out.push_back(Segment::straight(at(s0), at(s1)));
  out.front().p[0] = at(s0);
  out.back().p[3] = at(s1);
  return out;
}

double length(const Path& path) {
  double sum = 0;
  for (const Segment& s : path)
    for (int i = 0, n = s.line ? 1 : 16; i < n; ++i)
      sum += s.length(static_cast<double>(i) / n, static_cast<double>(i + 1) / n);
  return sum;
}

double turning(const ArcLength& arc, double s0, double s1) {
  constexpr int N = 24;
  double sum = 0;
  Vec2 before = arc.tangent(s0 + (s1 - s0) * 0.5 / N);
  for (int k = 1; k < N; ++k) {
    const Vec2 t = arc.tangent(s0 + (s1 - s0) * (k + 0.5) / N);
    sum += std::abs(std::atan2(before.x() * t.y() - before.y() * t.x(), before.dot(t)));
    before = t;
  }
  return sum;
}

double signed_area(const std::vector<Path>& loop) {
  // Green: area = 1/2 integral of x dy - y dx; three Gauss points are exact for the quintic
  // integrand of a cubic.
  static constexpr double X[3] = {0.5, 0.112701665379258, 0.887298334620742},
                          W[3] = {4.0 / 9, 5.0 / 18, 5.0 / 18};
  double area = 0;
  for (const Path& path : loop)
    for (const Segment& s : path)
      for (int i = 0; i < 3; ++i) {
        const Vec2 p = s.at(X[i]), d = s.derivative(X[i]);
        area += 0.5 * W[i] * (p.x() * d.y() - p.y() * d.x());
      }
  return area;
}

} // namespace sloper::pattern
