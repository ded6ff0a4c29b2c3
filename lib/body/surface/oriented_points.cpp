#include <body/surface/oriented_points.hpp>
#include <body/surface/point_grid.hpp>
#include <sloper/base/statistics.hpp>

#include <Eigen/Eigenvalues>

#include <algorithm>
#include <cmath>

namespace sloper::body {

namespace {

struct CellKey {
  long x, y, z;
  int index;
  bool same_cell(const CellKey& o) const { return x == o.x && y == o.y && z == o.z; }
};

/// Points on a triangle that is longer than the spacing, so that coarse meshes are covered too.
void add_face_samples(const Vec3& a, const Vec3& b, const Vec3& c, double spacing,
                      std::vector<Vec3>& points) {
  const double longest =
      std::sqrt(std::max({(b - a).squaredNorm(), (c - b).squaredNorm(), (a - c).squaredNorm()}));
  if (longest <= spacing)
    return;
  const int n = std::min(200, static_cast<int>(std::ceil(longest / (0.6 * spacing))));
  for (int i = 0; i <= n; ++i)
    for (int j = 0; j <= n - i; ++j) {
      if ((i == 0 && j == 0) || i == n || j == n)
        continue; // the corners are points already
      points.push_back(a + (b - a) * i / n + (c - a) * j / n);
    }
}

/// Mean of the points in every occupied cell, in order of cell.
std::vector<Vec3> average_by_cell(const std::vector<Vec3>& points, double cell) {
  std::vector<CellKey> keys(points.size());
  auto key = [&](double x) { return static_cast<long>(std::floor(x / cell)); };
  for (std::size_t i = 0; i < points.size(); ++i)
    keys[i] = {key(points[i].x()), key(points[i].y()), key(points[i].z()), static_cast<int>(i)};
  std::sort(keys.begin(), keys.end(), [](const CellKey& a, const CellKey& b) {
    return std::tie(a.x, a.y, a.z, a.index) < std::tie(b.x, b.y, b.z, b.index);
  });
  std::vector<Vec3> means;
  for (std::size_t i = 0; i < keys.size();) {
    std::size_t j = i;
    Vec3 sum = Vec3::Zero();
    for (; j < keys.size() && keys[j].same_cell(keys[i]); ++j)
      sum += points[keys[j].index];
    means.push_back(sum / static_cast<double>(j - i));
    i = j;
  }
  return means;
}

/// Occupied cells for looking along rays.
class Occupancy {
public:
  Occupancy(const std::vector<Vec3>& points, double cell) : m_cell(cell) {
    for (const Vec3& p : points)
      m_box.add(p);
    for (int a = 0; a < 3; ++a)
      m_n[a] = static_cast<int>(m_box.size()[a] / cell) + 1;
    m_full.assign(static_cast<std::size_t>(m_n[0]) * m_n[1] * m_n[2], 0);
    for (const Vec3& p : points) {
      int c[3];
      for (int a = 0; a < 3; ++a)
        c[a] = std::min(m_n[a] - 1, static_cast<int>((p[a] - m_box.low[a]) / cell));
      m_full[(static_cast<std::size_t>(c[0]) * m_n[1] + c[1]) * m_n[2] + c[2]] = 1;
    }
  }
  /// True when the ray leaves the box without meeting an occupied cell after the first two cells.
  bool sees_out(const Vec3& from, const Vec3& direction) const {
    for (double t = 2.0 * m_cell;; t += 0.8 * m_cell) {
      const Vec3 p = from + t * direction - m_box.low;
      int c[3];
      for (int a = 0; a < 3; ++a) {
        if (p[a] < 0)
          return true;
        c[a] = static_cast<int>(p[a] / m_cell);
        if (c[a] >= m_n[a])
          return true;
      }
      if (m_full[(static_cast<std::size_t>(c[0]) * m_n[1] + c[1]) * m_n[2] + c[2]])
        return false;
    }
  }

private:
  Box3 m_box;
  double m_cell;
  int m_n[3] = {0, 0, 0};
  std::vector<char> m_full;
};

/// Directions evenly over the sphere (Fibonacci spiral).
std::vector<Vec3> sphere_directions(int n) {
  std::vector<Vec3> directions;
  const double golden = 2.399963229728653;
  for (int i = 0; i < n; ++i) {
    const double y = 1 - (2 * i + 1.0) / n, r = std::sqrt(1 - y * y);
    directions.emplace_back(r * std::cos(golden * i), y, r * std::sin(golden * i));
  }
  return directions;
}

void orient_outward(OrientedPoints& samples, const PointGrid& grid) {
  const std::size_t n = samples.position.size();
  const Occupancy occupancy(samples.position, 1.8 * samples.spacing);
  const std::vector<Vec3> directions = sphere_directions(48);
  std::vector<double> belief(n);
  for (std::size_t i = 0; i < n; ++i) {
    double open = 0;
    for (const Vec3& d : directions)
      if (occupancy.sees_out(samples.position[i], d))
        open += samples.normal[i].dot(d);
    belief[i] = open;
  }
  // neighbours of like direction speak for each other
  for (int round = 0; round < 4; ++round) {
    std::vector<double> next(n);
    for (std::size_t i = 0; i < n; ++i) {
      double sum = 0, weight = 0;
      grid.within(samples.position[i], 2.0 * samples.spacing, [&](int j, double) {
        const double agree = samples.normal[i].dot(samples.normal[j]);
        sum += agree * std::abs(agree) * belief[j];
        weight += agree * agree;
      });
      next[i] = weight > 0 ? sum / weight : belief[i];
    }
    belief = next;
  }
  for (std::size_t i = 0; i < n; ++i)
    if (belief[i] < 0)
      samples.normal[i] = -samples.normal[i];
}

} // namespace

OrientedPoints sample_surface(const std::vector<Vec3>& positions,
                              const std::vector<Triangle>& triangles, const std::vector<char>& use,
                              double spacing, double max_lonely_share) {
  std::vector<Vec3> points;
  for (std::size_t v = 0; v < positions.size(); ++v)
    if (use[v])
      points.push_back(positions[v]);
  const std::size_t n_scan = points.size();
  for (const Triangle& t : triangles)
    if (use[t[0]] && use[t[1]] && use[t[2]])
      add_face_samples(positions[t[0]], positions[t[1]], positions[t[2]], spacing, points);
  OrientedPoints samples;
  samples.spacing = spacing;
  samples.position = average_by_cell(points, spacing);
  const std::size_t n = samples.position.size();
  samples.normal.assign(n, Vec3::UnitY());
  samples.area.assign(n, spacing * spacing);
  const double reach = 2.2 * spacing;
  const PointGrid grid(samples.position, reach);
  int lonely = 0;
  for (std::size_t i = 0; i < n; ++i) {
    Vec3 mean = Vec3::Zero();
    int count = 0, close = 0;
    grid.within(samples.position[i], reach, [&](int j, double d) {
      mean += samples.position[j];
      ++count;
      close += d < 1.5 * 1.5 * spacing * spacing;
    });
    lonely += count < 6;
    mean /= count;
    Mat3 spread = Mat3::Zero();
    grid.within(samples.position[i], reach, [&](int j, double) {
      const Vec3 d = samples.position[j] - mean;
      spread += d * d.transpose();
    });
    Eigen::SelfAdjointEigenSolver<Mat3> solver;
    solver.computeDirect(spread);
    samples.normal[i] = solver.eigenvectors().col(0);
    samples.area[i] = 3.14159265 * 1.5 * 1.5 * spacing * spacing / close;
  }
  samples.lonely_share = n ? static_cast<double>(lonely) / static_cast<double>(n) : 0;
  if (samples.lonely_share > max_lonely_share)
    return samples;
  orient_outward(samples, grid);
  // noise: how far the scan's own points lie from the plane of their nearest sample
  double sum = 0;
  int counted = 0;
  std::vector<double> off;
  for (std::size_t k = 0; k < n_scan; k += 1 + n_scan / 20000) {
    const int i = grid.nearest(points[k]);
    if (i < 0)
      continue;
    off.push_back(std::abs((points[k] - samples.position[i]).dot(samples.normal[i])));
    ++counted;
  }
  if (!off.empty())
    sum = upper_median(off) / 0.6745;
  samples.noise_m = counted ? sum : 0;
  return samples;
}

} // namespace sloper::body
