#include <sloper/collision/distance.hpp>

#include <algorithm>
#include <limits>

namespace sloper::collision {

namespace {

/// sin2 of an angle below which cross products of double coordinates carry no direction worth
/// trusting.
constexpr double FLAT = 1e-20;
constexpr double WELL_SHAPED =
    1e-8; ///< the same, where the signs of the barycentric weights can be trusted

/// Makes `best` the closest point on edge k where that is nearer.
void try_edge(const Vec3& p, const Vec3* const corner[3], int k, PointTriangle& best) {
  const int next = k == 2 ? 0 : k + 1;
  const Vec3 &a = *corner[k], &b = *corner[next];
  const PointEdge e = point_edge(p, a, b);
  if (!(e.squared_distance < best.squared_distance))
    return;
  best.squared_distance = e.squared_distance;
  best.barycentric = Vec3::Zero();
  best.barycentric[k] = 1 - e.t;
  best.barycentric[next] = e.t;
  if (e.t <= 0) {
    best.feature = k;
    best.point = a;
  } else if (e.t >= 1) {
    best.feature = next;
    best.point = b;
  } else {
    best.feature = FEATURE_EDGE + k;
    best.point = a + e.t * (b - a);
  }
}

} // namespace

PointEdge point_edge(const Vec3& p, const Vec3& a, const Vec3& b) {
  const Vec3 ab = b - a, ap = p - a;
  const double length2 = ab.squaredNorm(), along = ap.dot(ab);
  if (!(along > 0) || length2 <= 0)
    return {ap.squaredNorm(), 0};
  if (along >= length2)
    return {(p - b).squaredNorm(), 1};
  const double t = along / length2;
  return {(ap - t * ab).squaredNorm(), t};
}

PointTriangle point_triangle(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c) {
  const Vec3* const corner[3] = {&a, &b, &c};
  const Vec3 ab = b - a, ac = c - a, ap = p - a;
  const Vec3 n = ab.cross(ac);
  const double n2 = n.squaredNorm();
  const double longest2 = std::max(ab.squaredNorm(), ac.squaredNorm());
  PointTriangle best{std::numeric_limits<double>::infinity(), Vec3(1, 0, 0), a, 0};
  bool seen[3] = {
      true, true,
      true}; // edges that p, seen along the normal, lies beyond: only those can be nearest
  if (n2 > FLAT * longest2 * longest2) {
    // barycentric weights of the projection: signed areas over the area
    const double wc = ab.cross(ap).dot(n) / n2, wb = ap.cross(ac).dot(n) / n2, wa = 1 - wb - wc;
    if (wa > 0 && wb > 0 && wc > 0) {
      const double height = ap.dot(n);
      best.squared_distance = height * height / n2;
      best.barycentric = Vec3(wa, wb, wc);
      best.point = a + wb * ab + wc * ac;
      best.feature = FEATURE_FACE;
      return best;
    }
    if (n2 > WELL_SHAPED * longest2 * longest2) { // else the weights' signs may be noise
      seen[0] = wc <= 0;
      seen[1] = wa <= 0;
      seen[2] = wb <= 0;
    }
  }
  for (int k = 0; k < 3; ++k)
    if (seen[k])
      try_edge(p, corner, k, best);
  return best;
}

EdgeEdge edge_edge(const Vec3& a0, const Vec3& a1, const Vec3& b0, const Vec3& b1) {
  const Vec3 u = a1 - a0, v = b1 - b0, w = a0 - b0;
  const double uu = u.squaredNorm(), vv = v.squaredNorm(), uv = u.dot(v), uw = u.dot(w),
               vw = v.dot(w);
  const double det = uu * vv - uv * uv;
  if (det > 1e-14 * uu * vv) {
    // the lines' closest point on a, clamped; the best t for it; and, where that must be clamped,
    // the best s for that
    double s = std::clamp((uv * vw - vv * uw) / det, 0.0, 1.0), t = (uv * s + vw) / vv;
    if (t < 0 || t > 1) {
      t = t < 0 ? 0 : 1;
      s = std::clamp((uv * t - uw) / uu, 0.0, 1.0);
    }
    return {(w + s * u - t * v).squaredNorm(), s, t};
  }
  // parallel or without length: an end point takes part, the nearest of the four
  // end-point-to-segment pairs
  const PointEdge p0 = point_edge(a0, b0, b1), p1 = point_edge(a1, b0, b1),
                  q0 = point_edge(b0, a0, a1), q1 = point_edge(b1, a0, a1);
  EdgeEdge best{p0.squared_distance, 0, p0.t};
  if (p1.squared_distance < best.squared_distance)
    best = {p1.squared_distance, 1, p1.t};
  if (q0.squared_distance < best.squared_distance)
    best = {q0.squared_distance, q0.t, 0};
  if (q1.squared_distance < best.squared_distance)
    best = {q1.squared_distance, q1.t, 1};
  return best;
}

} // namespace sloper::collision
