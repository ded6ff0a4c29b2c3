#include <body/measure/relief.hpp>
#include <body/surface/point_grid.hpp>

#include <algorithm>

namespace sloper::body {

namespace {

/// Skin that faces forward in a box and about it, and how high each point stands out against the
/// ring around it.
struct Relief {
  std::vector<Vec3> points;
  std::vector<double> area, height; ///< m2, m; -1e300 where a point is not surrounded
};

Relief relief_of(const TriangleMesh& skin, const Box3& box, double radius, double sign) {
  const Vec3 margin = Vec3::Constant(radius);
  std::vector<char> is_near(skin.positions.size(), 0);
  for (std::size_t v = 0; v < skin.positions.size(); ++v) {
    const Vec3& p = skin.positions[v];
    is_near[v] =
        (p - box.low + margin).minCoeff() >= 0 && (box.high + margin - p).minCoeff() >= 0 ? 1 : 0;
  }
  const std::vector<Vec3> normals = vertex_normals(skin, is_near);
  std::vector<double> of_vertex(
      skin.positions.size(), 0); // areas, so that it does not matter how finely the skin is meshed
  for (const Triangle& t : skin.triangles) {
    const Vec3& p = skin.positions[t[0]];
    if ((p - box.low + 4 * margin).minCoeff() < 0 || (box.high + 4 * margin - p).minCoeff() < 0)
      continue;
    const double third = area_normal(p, skin.positions[t[1]], skin.positions[t[2]]).norm();
    for (const int v : t)
      of_vertex[v] += third;
  }
  Relief relief;
  auto& [points, area, height] = relief;
  std::vector<Vec3> normal;
  for (std::size_t v = 0; v < skin.positions.size(); ++v) {
    const Vec3& p = skin.positions[v];
    if (!is_near[v] || normals[v].z() < 0.2)
      continue;
    points.push_back(p);
    normal.push_back(normals[v]);
    area.push_back(of_vertex[v]);
  }
  height.assign(points.size(), -1e300);
  if (points.empty())
    return relief;
  const PointGrid grid(points, radius);
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Vec3& p = points[i];
    if ((p - box.low).minCoeff() < 0 || (box.high - p).minCoeff() < 0)
      continue;
    double ring = 0, weight = 0;
    int n = 0, quadrants = 0;
    grid.within(p, radius, [&](int j, double d) {
      if (d < 0.3 * radius * radius)
        return;
      const Vec3 off = points[j] - p;
      ring += area[j] * off.dot(normal[i]);
      weight += area[j];
      quadrants |= 1 << ((off.x() > 0 ? 1 : 0) + (off.y() > 0 ? 2 : 0));
      ++n;
    });
    if (n < 4 || quadrants != 15 || weight <= 0)
      continue; // not surrounded: at an edge
    height[i] = -sign * ring / weight;
  }
  return relief;
}

} // namespace

std::optional<ReliefPoint> strongest_relief(const TriangleMesh& skin, const Box3& box,
                                            double radius, double sign) {
  const auto [points, area, height] = relief_of(skin, box, radius, sign);
  if (points.empty())
    return std::nullopt;
  const std::size_t best =
      static_cast<std::size_t>(std::max_element(height.begin(), height.end()) - height.begin());
  const double most = height[best];
  if (most < -1e299)
    return std::nullopt;
  Vec3 sum = Vec3::Zero();
  double weight = 0;
  for (std::size_t i = 0; i < points.size(); ++i)
    if (const double w = area[i] * (height[i] - 0.7 * most);
        w > 0 && (points[i] - points[best]).norm() < radius) {
      sum += w * points[i];
      weight += w;
    }
  return ReliefPoint{weight > 0 && most > 0 ? Vec3(sum / weight) : points[best], sign * most};
}

std::vector<ReliefPoint> tallest_reliefs(const TriangleMesh& skin, const Box3& box, double radius,
                                         double sign, double apart, double least,
                                         std::size_t most) {
  const auto [points, area, height] = relief_of(skin, box, radius, sign);
  std::vector<std::size_t> order;
  for (std::size_t i = 0; i < points.size(); ++i)
    if (height[i] > least)
      order.push_back(i);
  std::stable_sort(order.begin(), order.end(),
                   [&h = height](std::size_t a, std::size_t b) { return h[a] > h[b]; });
  std::vector<ReliefPoint> tallest;
  for (const std::size_t i : order) {
    const Vec3& p = points[i];
    const bool is_slope = std::any_of(tallest.begin(), tallest.end(), [&](const ReliefPoint& top) {
      return (top.p - p).norm() < apart;
    });
    if (is_slope)
      continue;
    tallest.push_back({p, sign * height[i]});
    if (tallest.size() == most)
      break;
  }
  return tallest;
}

} // namespace sloper::body
