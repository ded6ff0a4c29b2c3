#include "section.hpp"
#include <algorithm>
#include <cmath>
#include <sloper/base/units.hpp>
namespace sloper::samples {

Section2 hull_section(const std::vector<Vec3>& points, const Vec3& u, const Vec3& v) {
  Section2 s;
  if (points.size() < 3)
    return s;
  const Vec3 o = points.front();
  std::vector<Vec2> q;
  Box3 box;
  for (const Vec3& p : points) {
    q.emplace_back((p - o).dot(u), (p - o).dot(v));
    box.add(p);
  }
  std::sort(q.begin(), q.end(), [](const Vec2& a, const Vec2& b) {
    return a.x() != b.x() ? a.x() < b.x() : a.y() < b.y();
  });
  std::vector<Vec2> hull;
  const auto turn = [](const Vec2& a, const Vec2& b, const Vec2& c) {
    return (b - a).x() * (c - a).y() - (b - a).y() * (c - a).x();
  };
  for (int half = 0; half < 2; ++half) { // Andrew's monotone chain
    const std::size_t base = hull.size();
    for (const Vec2& p : q) {
      while (hull.size() >= base + 2 && turn(hull[hull.size() - 2], hull.back(), p) <= 0)
        hull.pop_back();
      hull.push_back(p);
    }
    hull.pop_back();
    std::reverse(q.begin(), q.end());
  }
  Vec2 middle = Vec2::Zero();
  for (std::size_t i = 0; i < hull.size(); ++i) {
    const Vec2 &a = hull[i], &b = hull[(i + 1) % hull.size()];
    const double cross = a.x() * b.y() - a.y() * b.x();
    s.girth_m += (b - a).norm();
    s.area += 0.5 * cross;
    middle += cross / 6 * (a + b);
  }
  if (s.area <= 0)
    return s;
  middle /= s.area;
  s.center = o + middle.x() * u + middle.y() * v;
  s.low = box.low;
  s.high = box.high;
  s.empty = false;
  return s;
}

Section2 field_section(const Field& f, const Vec3& center, const Vec3& u, const Vec3& v,
                       double reach) {
  constexpr int N = 90;
  constexpr double STEP = 0.015;
  std::vector<Vec3> points;
  for (int i = 0; i < N; ++i) {
    const double angle = 2 * units::PI * i / N;
    const Vec3 d = std::cos(angle) * u + std::sin(angle) * v;
    double low = 0, high = STEP;
    while (high < reach && f(center + high * d) < 0) {
      low = high;
      high += STEP;
    }
    for (int k = 0; k < 14; ++k) {
      const double mid = 0.5 * (low + high);
      (f(center + mid * d) < 0 ? low : high) = mid;
    }
    points.push_back(center + low * d);
  }
  return hull_section(points, u, v);
}

Section2 mesh_section(const TriangleMesh& mesh, const Vec3& point, const Vec3& normal,
                      const std::function<bool(const Triangle&)>& keep) {
  std::vector<double> height(mesh.positions.size()); // over the plane
  for (std::size_t v = 0; v < height.size(); ++v)
    height[v] = (mesh.positions[v] - point).dot(normal);
  std::vector<Vec3> points;
  for (const Triangle& t : mesh.triangles) {
    const double d[3] = {height[t[0]], height[t[1]], height[t[2]]};
    if ((d[0] > 0) == (d[1] > 0) && (d[1] > 0) == (d[2] > 0))
      continue;
    if (!keep(t))
      continue;
    for (int k = 0; k < 3; ++k) {
      const int m = (k + 1) % 3;
      if ((d[k] > 0) != (d[m] > 0))
        points.push_back(mesh.positions[t[k]] +
                         d[k] / (d[k] - d[m]) * (mesh.positions[t[m]] - mesh.positions[t[k]]));
    }
  }
  const Vec3 u =
      normal.cross(std::abs(normal.z()) < 0.9 ? Vec3::UnitZ() : Vec3::UnitX()).normalized();
  return hull_section(points, u, normal.cross(u));
}

} // namespace sloper::samples
