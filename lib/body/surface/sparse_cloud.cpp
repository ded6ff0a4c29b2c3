#include <body/surface/point_grid.hpp>
#include <body/surface/sparse_cloud.hpp>

#include <Eigen/Eigenvalues>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

namespace sloper::body {

namespace {

constexpr int FILL_ROUNDS = 3, COMPANY = 8; ///< points that a plane is laid through
constexpr std::array<double, 7> REACH = {1.5, 2.1, 3.0, 4.2,
                                         6.0, 8.5, 12.0}; ///< of the spacing wanted
constexpr double DENSE = 2.1;  ///< eight points within so many spacings: nothing to add
constexpr double AGREE = 0.55; ///< cosine of two normals on one side of the body
constexpr double ALONG = 0.45; ///< sine of the angle of the line between two points to the surface

struct Neighbourhood {
  double reach = 0; ///< 0: alone
  Vec3 normal = Vec3::Zero();
  std::vector<int> near;
};

std::vector<Neighbourhood> neighbourhoods(const std::vector<Vec3>& points, double spacing) {
  std::vector<Neighbourhood> all(points.size());
  std::vector<int> open(points.size());
  for (std::size_t i = 0; i < open.size(); ++i)
    open[i] = static_cast<int>(i);
  for (const double factor : REACH) {
    const double reach = factor * spacing;
    const PointGrid grid(points, reach);
    std::vector<int> left;
    for (const int i : open) {
      Neighbourhood& n = all[i];
      n.near.clear();
      grid.within(points[i], reach, [&](int j, double) { n.near.push_back(j); });
      if (static_cast<int>(n.near.size()) < COMPANY) {
        left.push_back(i);
        continue;
      }
      n.reach = reach;
      std::sort(n.near.begin(), n.near.end()); // the grid's order is no order
      Vec3 mean = Vec3::Zero();
      for (const int j : n.near)
        mean += points[j] / static_cast<double>(n.near.size());
      Mat3 spread = Mat3::Zero();
      for (const int j : n.near)
        spread += (points[j] - mean) * (points[j] - mean).transpose();
      Eigen::SelfAdjointEigenSolver<Mat3> solver;
      solver.computeDirect(spread);
      n.normal = solver.eigenvectors().col(0);
    }
    open = std::move(left);
    if (open.empty())
      break;
  }
  return all;
}

/// The middle of the curve between two points of one surface; none when they are on two.
std::optional<Vec3> middle_between(const Vec3& p, const Vec3& n, const Vec3& q, Vec3 m) {
  const Vec3 line = q - p;
  const double length = line.norm();
  double agree = n.dot(m);
  if (agree < 0) {
    m = -m;
    agree = -agree;
  }
  if (agree < AGREE || std::abs(line.dot(n)) > ALONG * length ||
      std::abs(line.dot(m)) > ALONG * length)
    return std::nullopt;
  return Vec3(0.5 * (p + q) - 0.125 * (line.dot(n) * n - line.dot(m) * m));
}

} // namespace

std::vector<Vec3> fill_thin_cloud(const std::vector<Vec3>& points, double spacing) {
  std::vector<Vec3> cloud = points;
  for (int round = 0; round < FILL_ROUNDS; ++round) {
    const std::vector<Neighbourhood> around = neighbourhoods(cloud, spacing);
    std::vector<Vec3> added;
    for (std::size_t i = 0; i < cloud.size(); ++i) {
      const Neighbourhood& a = around[i];
      if (a.reach <= DENSE * spacing)
        continue; // dense already, or alone
      for (const int j : a.near) {
        const Neighbourhood& b = around[j];
        const bool both = b.reach > DENSE * spacing &&
                          std::binary_search(b.near.begin(), b.near.end(), static_cast<int>(i));
        if (b.reach <= 0 || (both && j < static_cast<int>(i)) ||
            (cloud[j] - cloud[i]).squaredNorm() < spacing * spacing)
          continue;
        if (const auto middle = middle_between(cloud[i], a.normal, cloud[j], b.normal))
          added.push_back(*middle);
      }
    }
    if (added.empty())
      break;
    // neighbours share their middles: one point a cell is enough
    const double cell = 0.6 * spacing;
    std::vector<std::pair<std::array<long, 3>, int>> order(added.size());
    for (std::size_t i = 0; i < added.size(); ++i)
      order[i] = {{std::lround(added[i].x() / cell), std::lround(added[i].y() / cell),
                   std::lround(added[i].z() / cell)},
                  static_cast<int>(i)};
    std::sort(order.begin(), order.end());
    for (std::size_t i = 0; i < order.size(); ++i)
      if (i == 0 || order[i].first != order[i - 1].first)
        cloud.push_back(added[order[i].second]);
  }
  return cloud;
}

} // namespace sloper::body
