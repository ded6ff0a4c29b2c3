#pragma once
/// Occupied cells of a grid over a scan: what tells a body from floor and debris.
#include <sloper/geometry/triangle_mesh.hpp>

#include <array>
#include <vector>

namespace sloper::body {

/// Occupied cells of a grid over the scan.
class Voxels {
public:
  /// @param n_cells  along the longest side of the scan, without a few points far off
  Voxels(const TriangleMesh& scan, int n_cells);
  double cell_size() const { return m_cell; }
  const Box3& box() const { return m_box; }
  int count() const { return static_cast<int>(m_cells.size()); }
  const std::array<int, 3>& cell(int i) const { return m_cells[i]; }
  int of_vertex(std::size_t v) const { return m_of_vertex[v]; }
  int extent(int axis) const { return m_n[axis]; }
  int number_at(int x, int y, int z) const {
    if (x < 0 || y < 0 || z < 0 || x >= m_n[0] || y >= m_n[1] || z >= m_n[2])
      return -1;
    return m_number[(static_cast<std::size_t>(x) * m_n[1] + y) * m_n[2] + z];
  }

private:
  /// A few points far off must not make the cells as large as the body.
  static Box3 box_without_outliers(const std::vector<Vec3>& points);
  void fill_cells(const TriangleMesh& scan, int n_cells);
  int add(const Vec3& p);
  /// Samples a triangle that is larger than a cell.
  void fill(const Vec3& a, const Vec3& b, const Vec3& c);

  Box3 m_box;
  double m_cell = 1;
  std::array<int, 3> m_n{};
  std::vector<int> m_number, m_of_vertex;
  std::vector<std::array<int, 3>> m_cells;
};

} // namespace sloper::body
