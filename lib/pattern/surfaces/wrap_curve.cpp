#include <geos_c.h>
#include <pattern/surfaces/wrap_curve.hpp>
#include <sloper/base/error.hpp>

#include <algorithm>
#include <cmath>

namespace sloper::pattern {
namespace {

constexpr double FAR = 3; // m: half length of the wings

/// A GEOS context and the geometries made in it.
class Shapes {
public:
  Shapes() = default;
  ~Shapes() {
    for (GEOSGeometry* g : m_all)
      GEOSGeom_destroy_r(m_context, g);
    GEOS_finish_r(m_context);
  }
  Shapes(const Shapes&) = delete;
  Shapes& operator=(const Shapes&) = delete;

  GEOSGeometry* hull(const std::vector<Vec2>& points) {
    std::vector<GEOSGeometry*> list;
    for (const Vec2& p : points)
      list.push_back(GEOSGeom_createPointFromXY_r(m_context, p.x(), p.y()));
    const GEOSGeometry* cloud = keep(GEOSGeom_createCollection_r(
        m_context, GEOS_MULTIPOINT, list.data(), static_cast<unsigned>(list.size())));
    return keep(GEOSConvexHull_r(m_context, cloud));
  }
  GEOSGeometry* grown(const GEOSGeometry* g, double by) {
    return keep(GEOSBuffer_r(m_context, g, by, 16));
  }
  GEOSGeometry* united(const GEOSGeometry* a, const GEOSGeometry* b) {
    return keep(GEOSUnion_r(m_context, a, b));
  }
  GEOSGeometry* below(double z) {
    GEOSCoordSequence* c = GEOSCoordSeq_create_r(m_context, 5, 2);
    const double x[5] = {-FAR, FAR, FAR, -FAR, -FAR}, y[5] = {-FAR, -FAR, z, z, -FAR};
    for (unsigned k = 0; k < 5; ++k)
      GEOSCoordSeq_setXY_r(m_context, c, k, x[k], y[k]);
    return keep(
        GEOSGeom_createPolygon_r(m_context, GEOSGeom_createLinearRing_r(m_context, c), nullptr, 0));
  }
  /// Outer ring, counter-clockwise, without its repeated last point.
  std::vector<Vec2> ring(const GEOSGeometry* g) {
    const GEOSGeometry* outer = GEOSGeomTypeId_r(m_context, g) == GEOS_POLYGON
                                    ? GEOSGetExteriorRing_r(m_context, g)
                                    : nullptr;
    if (!outer)
      throw Error(ErrorKind::INTERNAL, "general.internal"_id, "", "placement",
                  "no outline around the body");
    const GEOSCoordSequence* c = GEOSGeom_getCoordSeq_r(m_context, outer);
    unsigned n = 0;
    GEOSCoordSeq_getSize_r(m_context, c, &n);
    std::vector<Vec2> points(n - 1);
    double area = 0;
    for (unsigned k = 0; k + 1 < n; ++k)
      GEOSCoordSeq_getXY_r(m_context, c, k, &points[k].x(), &points[k].y());
    for (std::size_t k = 0; k < points.size(); ++k)
      area += points[k].x() * points[(k + 1) % points.size()].y() -
              points[k].y() * points[(k + 1) % points.size()].x();
    if (area < 0)
      std::reverse(points.begin(), points.end());
    return points;
  }

private:
  GEOSGeometry* keep(GEOSGeometry* g) {
    if (!g)
      throw Error(ErrorKind::INTERNAL, "general.internal"_id, "", "placement",
                  "GEOS gave no geometry");
    m_all.push_back(g);
    return g;
  }
  GEOSContextHandle_t m_context = GEOS_init_r();
  std::vector<GEOSGeometry*> m_all;
};

} // namespace

void WrapCurve::measure() {
  m_s.assign(1, 0.0);
  for (std::size_t k = 0; k + 1 < m_points.size(); ++k)
    m_s.push_back(m_s.back() + (m_points[k + 1] - m_points[k]).norm());
}

WrapCurve WrapCurve::front_of(const std::vector<Vec2>& points, double gap, double wing,
                              double fillet, double middle_x) {
  Shapes shapes;
  const GEOSGeometry* region =
      shapes.united(shapes.grown(shapes.hull(points), gap), shapes.below(wing));
  region = shapes.grown(shapes.grown(region, fillet), -fillet);
  std::vector<Vec2> ring = shapes.ring(region);
  // From the right wing over the top to the left one; counter-clockwise is from +x to -x.
  std::size_t right = 0, left = 0;
  for (std::size_t k = 0; k < ring.size(); ++k) {
    const auto score = [&](const Vec2& p, double sign) { return sign * p.x() + p.y(); };
    if (score(ring[k], 1) > score(ring[right], 1))
      right = k;
    if (score(ring[k], -1) > score(ring[left], -1))
      left = k;
  }
  WrapCurve out;
  for (std::size_t k = right;; k = (k + 1) % ring.size()) {
    out.m_points.push_back(ring[k]);
    if (k == left)
      break;
  }
  std::reverse(out.m_points.begin(), out.m_points.end()); // x grows
  out.measure();
  for (std::size_t k = 0; k + 1 < out.m_points.size(); ++k) {
    const Vec2 &a = out.m_points[k], &b = out.m_points[k + 1];
    if (a.x() <= middle_x && b.x() >= middle_x && b.x() > a.x()) {
      out.m_origin = out.m_s[k] + (middle_x - a.x()) / (b.x() - a.x()) * (b - a).norm();
      break;
    }
  }
  return out;
}

WrapCurve WrapCurve::around(const std::vector<Vec2>& points, double gap, double length) {
  Shapes shapes;
  const GEOSGeometry* hull = shapes.hull(points);
  WrapCurve out;
  out.m_closed = true;
  for (int round = 0; round < 3;
       ++round) { // growing a convex outline by g adds 2 pi g, up to the polygon's own error
    out.m_points = shapes.ring(shapes.grown(hull, gap));
    std::reverse(out.m_points.begin(), out.m_points.end()); // from the front towards +x
    out.m_points.push_back(out.m_points.front());
    out.measure();
    if (out.length() >= length)
      break;
    gap += (length - out.length()) / (2 * 3.14159265358979) + 1e-5;
  }
  Vec2 low = Vec2::Constant(1e300), high = Vec2::Constant(-1e300);
  for (const Vec2& p : out.m_points) {
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  }
  const double x = 0.5 * (low.x() + high.x());
  double best = -1e300;
  for (std::size_t k = 0; k + 1 < out.m_points.size(); ++k) {
    const Vec2 &a = out.m_points[k], &b = out.m_points[k + 1];
    if ((a.x() <= x) == (b.x() <= x))
      continue;
    const double t = (x - a.x()) / (b.x() - a.x()), z = a.y() + t * (b.y() - a.y());
    if (z > best) {
      best = z;
      out.m_origin = out.m_s[k] + t * (b - a).norm();
    }
  }
  return out;
}

Vec2 WrapCurve::at(double u) const {
  double s = m_origin + u;
  if (m_closed)
    s -= std::floor(s / length()) * length();
  if (s <= 0)
    return m_points.front() + s * (m_points[1] - m_points[0]).normalized();
  if (s >= length())
    return m_points.back() +
           (s - length()) * (m_points.back() - m_points[m_points.size() - 2]).normalized();
  const std::size_t k =
      static_cast<std::size_t>(std::upper_bound(m_s.begin(), m_s.end(), s) - m_s.begin());
  const double span = m_s[k] - m_s[k - 1];
  return m_points[k - 1] +
         (span > 0 ? (s - m_s[k - 1]) / span : 0.0) * (m_points[k] - m_points[k - 1]);
}

} // namespace sloper::pattern
