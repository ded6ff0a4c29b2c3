#include <body/ingest/voxels.hpp>
#include <sloper/base/statistics.hpp>

#include <algorithm>
#include <cmath>

namespace sloper::body {

Voxels::Voxels(const TriangleMesh& scan, int n_cells) {
  m_box = box_without_outliers(scan.positions);
  fill_cells(scan, n_cells);
}

Box3 Voxels::box_without_outliers(const std::vector<Vec3>& points) {
  const Box3 all = bounding_box(points);
  Box3 box;
  const std::size_t step = 1 + points.size() / 40000;
  std::vector<double> values;
  for (int a = 0; a < 3; ++a) {
    values.clear();
    for (std::size_t i = 0; i < points.size(); i += step)
      values.push_back(points[i][a]);
    const std::size_t rank = values.size() / 500;
    const double low = *place_rank(values, rank),
                 high = *place_rank(values, values.size() - 1 - rank), margin = 0.3 * (high - low);
    box.low[a] = std::max(all.low[a], low - margin);
    box.high[a] = std::min(all.high[a], high + margin);
  }
  return box;
}

void Voxels::fill_cells(const TriangleMesh& scan, int n_cells) {
  m_cells.clear();
  m_cell = std::max(m_box.size().maxCoeff() / n_cells, 1e-12);
  for (int a = 0; a < 3; ++a)
    m_n[a] = static_cast<int>(m_box.size()[a] / m_cell) + 1;
  m_number.assign(static_cast<std::size_t>(m_n[0]) * m_n[1] * m_n[2], -1);
  m_of_vertex.resize(scan.positions.size());
  for (std::size_t v = 0; v < scan.positions.size(); ++v)
    m_of_vertex[v] = add(scan.positions[v]);
  for (const Triangle& t : scan.triangles)
    fill(scan.positions[t[0]], scan.positions[t[1]], scan.positions[t[2]]);
}

int Voxels::add(const Vec3& p) {
  std::array<int, 3> c;
  for (int a = 0; a < 3; ++a)
    c[a] = static_cast<int>(std::clamp((p[a] - m_box.low[a]) / m_cell, 0.0, m_n[a] - 1.0));
  int& number = m_number[(static_cast<std::size_t>(c[0]) * m_n[1] + c[1]) * m_n[2] + c[2]];
  if (number < 0) {
    number = count();
    m_cells.push_back(c);
  }
  return number;
}

void Voxels::fill(const Vec3& a, const Vec3& b, const Vec3& c) {
  const double longest =
      std::sqrt(std::max({(b - a).squaredNorm(), (c - b).squaredNorm(), (a - c).squaredNorm()}));
  if (longest <= m_cell || longest > 0.4 * m_box.size().maxCoeff())
    return; // a spike to an outlier is no surface
  const int n = std::min(64, static_cast<int>(std::ceil(longest / (0.7 * m_cell))));
  for (int i = 0; i <= n; ++i)
    for (int j = 0; j <= n - i; ++j)
      add(a + (b - a) * i / n + (c - a) * j / n);
}

} // namespace sloper::body
