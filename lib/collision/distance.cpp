#include <collision/distance.hpp>

#include <algorithm>

namespace sloper::collision {

namespace {

/// sin2 of an angle below which cross products of double coordinates carry no direction worth trusting.
constexpr double FLAT = 1e-20;

/// The nearest of the three edges, for points whose projection is outside the triangle or whose triangle has no area.
PointTriangle nearest_edge(const Vec3& p, const Vec3* corner[3]) {
  PointTriangle best{};
  best.squared_distance = -1;
  for (int k = 0; k < 3; ++k) {
    const Vec3 &a = *corner[k], &b = *corner[(k + 1) % 3];
    const PointEdge e = point_edge(p, a, b);
    if (best.squared_distance >= 0 && e.squared_distance >= best.squared_distance) continue;
    best.squared_distance = e.squared_distance;
    best.barycentric = Vec3::Zero();
    best.barycentric[k] = 1 - e.t;
    best.barycentric[(k + 1) % 3] = e.t;
    if (e.t <= 0) {
      best.feature = k;
      best.point = a;
    } else if (e.t >= 1) {
      best.feature = (k + 1) % 3;
      best.point = b;
    } else {
      best.feature = FEATURE_EDGE + k;
      best.point = a + e.t * (b - a);
    }
  }
  return best;
}

} // namespace

PointEdge point_edge(const Vec3& p, const Vec3& a, const Vec3& b) {
  const Vec3 ab = b - a, ap = p - a;
  const double length2 = ab.squaredNorm(), along = ap.dot(ab);
  if (!(along > 0) || length2 <= 0) return {ap.squaredNorm(), 0};
  if (along >= length2) return {(p - b).squaredNorm(), 1};
  const double t = along / length2;
  return {(ap - t * ab).squaredNorm(), t};
}

PointTriangle point_triangle(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c) {
  const Vec3* corner[3] = {&a, &b, &c};
  const Vec3 ab = b - a, ac = c - a, ap = p - a;
  const Vec3 n = ab.cross(ac);
  const double n2 = n.squaredNorm();
  const double longest2 = std::max(ab.squaredNorm(), ac.squaredNorm());
  if (n2 > FLAT * longest2 * longest2) {
    // barycentric weights of the projection: signed areas over the area
    const double wc = ab.cross(ap).dot(n) / n2, wb = ap.cross(ac).dot(n) / n2, wa = 1 - wb - wc;
    if (wa > 0 && wb > 0 && wc > 0) {
      PointTriangle r;
      const double height = ap.dot(n);
      r.squared_distance = height * height / n2;
      r.barycentric = Vec3(wa, wb, wc);
      r.point = a + wb * ab + wc * ac;
      r.feature = FEATURE_FACE;
      return r;
    }
  }
  return nearest_edge(p, corner);
}

EdgeEdge edge_edge(const Vec3& a0, const Vec3& a1, const Vec3& b0, const Vec3& b1) {
  const Vec3 u = a1 - a0, v = b1 - b0, w = a0 - b0;
  const double uu = u.squaredNorm(), vv = v.squaredNorm(), uv = u.dot(v), uw = u.dot(w), vw = v.dot(w);
  const double det = uu * vv - uv * uv;
  if (det > 1e-14 * uu * vv) {
    const double s = (uv * vw - vv * uw) / det, t = (uu * vw - uv * uw) / det;
    if (s > 0 && s < 1 && t > 0 && t < 1) return {(w + s * u - t * v).squaredNorm(), s, t};
  }
  // an end point takes part: the nearest of the four end-point-to-segment pairs
  const PointEdge p0 = point_edge(a0, b0, b1), p1 = point_edge(a1, b0, b1), q0 = point_edge(b0, a0, a1), q1 = point_edge(b1, a0, a1);
  EdgeEdge best{p0.squared_distance, 0, p0.t};
  if (p1.squared_distance < best.squared_distance) best = {p1.squared_distance, 1, p1.t};
  if (q0.squared_distance < best.squared_distance) best = {q0.squared_distance, q0.t, 0};
  if (q1.squared_distance < best.squared_distance) best = {q1.squared_distance, q1.t, 1};
  return best;
}

} // namespace sloper::collision
