#pragma once
/// Points in a hashed grid, for finding neighbours.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <sloper/geometry/types.hpp>
#include <vector>
namespace sloper::body {

/// The grid of one list of points, which it does not own.
class PointGrid {
public:
  /// @param cell m; queries reach one cell in every direction
  PointGrid(const std::vector<Vec3>& points, double cell) : m_points(&points), m_cell(cell) {
    std::size_t size = 1;
    while (size < points.size())
      size *= 2;
    m_mask = size - 1;
    m_first.assign(size + 1, 0);
    std::vector<std::uint32_t> bucket(points.size());
    for (std::size_t i = 0; i < points.size(); ++i) {
      bucket[i] = static_cast<std::uint32_t>(
          hash(key(points[i].x()), key(points[i].y()), key(points[i].z())));
      ++m_first[bucket[i] + 1];
    }
    for (std::size_t b = 1; b < m_first.size(); ++b)
      m_first[b] += m_first[b - 1];
    m_items.resize(points.size());
    std::vector<int> at(m_first.begin(), m_first.end() - 1);
    for (std::size_t i = 0; i < points.size(); ++i)
      m_items[at[bucket[i]]++] = static_cast<int>(i);
  }
  double cell() const { return m_cell; }
  /// Calls visit(index, squared distance) for every point within `radius` <= cell of q.
  template<class Visit> void within(const Vec3& q, double radius, Visit visit) const {
    const long x = key(q.x()), y = key(q.y()), z = key(q.z());
    std::size_t seen[27];
    int n_seen = 0;
    for (long dx = -1; dx <= 1; ++dx)
      for (long dy = -1; dy <= 1; ++dy)
        for (long dz = -1; dz <= 1; ++dz) {
          const std::size_t b = hash(x + dx, y + dy, z + dz);
          if (std::find(seen, seen + n_seen, b) != seen + n_seen)
            continue; // two cells may share a bucket
          seen[n_seen++] = b;
          for (int i = m_first[b]; i < m_first[b + 1]; ++i) {
            const double d = ((*m_points)[m_items[i]] - q).squaredNorm();
            if (d <= radius * radius)
              visit(m_items[i], d);
          }
        }
  }
  /// Nearest point within the cell size, or -1.
  int nearest(const Vec3& q) const {
    int best = -1;
    double least = 1e300;
    within(q, m_cell, [&](int i, double d) {
      if (d < least || (d == least && i < best)) {
        least = d;
        best = i;
      }
    });
    return best;
  }

private:
  long key(double x) const { return static_cast<long>(std::floor(x / m_cell)); }
  std::size_t hash(long x, long y, long z) const {
    return (static_cast<std::size_t>(x) * 73856093u ^ static_cast<std::size_t>(y) * 19349663u ^
            static_cast<std::size_t>(z) * 83492791u) &
           m_mask;
  }
  const std::vector<Vec3>* m_points;
  double m_cell;
  std::size_t m_mask = 0;
  std::vector<int> m_first, m_items;
};

} // namespace sloper::body
