#include <sloper/cloth/forces/triangle_map.hpp>

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>

namespace sloper::cloth {

/// Rest length of the spring between two particles, m; negative where there is none.
static double rest_length(const ClothMesh& mesh, int a, int b) {
  const std::array<int, 2> edge{std::min(a, b), std::max(a, b)};
  const auto found = std::lower_bound(mesh.edges.begin(), mesh.edges.end(), edge);
  return found != mesh.edges.end() && *found == edge
             ? mesh.springs[found - mesh.edges.begin()].rest_length
             : -1;
}

/// The triangle's flat shape with the edge lengths of its springs.
static std::array<Vec2, 3> rest_shape(const ClothMesh& mesh, const RestTriangle& t) {
  using Mat2 = Eigen::Matrix2d;
  Mat3 rows;
  Vec3 squares;
  double ratio = 0;
  for (int k = 0; k < 3; ++k) {
    const Vec2 e = t.flat[(k + 1) % 3] - t.flat[k];
    double length = rest_length(mesh, t.particle[k], t.particle[(k + 1) % 3]);
    if (length < 0)
      length = e.norm();
    rows.row(k) << e.x() * e.x(), 2 * e.x() * e.y(), e.y() * e.y();
    squares[k] = length * length;
    ratio += length / e.norm() / 3;
  }
  const Vec3 g = rows.fullPivLu().solve(squares);
  Mat2 metric;
  metric << g[0], g[1], g[1], g[2];
  const Eigen::SelfAdjointEigenSolver<Mat2> eigen(metric);
  const bool possible = metric.allFinite() && eigen.eigenvalues()[0] > 1e-2 * ratio * ratio;
  const Mat2 map = possible ? eigen.operatorSqrt() : Mat2(ratio * Mat2::Identity());
  return {map * t.flat[0], map * t.flat[1], map * t.flat[2]};
}

std::vector<TriangleMap> make_triangle_maps(const ClothMesh& mesh) {
  std::vector<TriangleMap> maps;
  maps.reserve(mesh.triangles.size());
  for (const RestTriangle& t : mesh.triangles) {
    const auto flat = rest_shape(mesh, t);
    const Vec2 a = flat[1] - flat[0], b = flat[2] - flat[0];
    const double det = a.x() * b.y() - a.y() * b.x();
    TriangleMap m;
    m.particle = t.particle;
    m.du = {(a.y() - b.y()) / det, b.y() / det, -a.y() / det};
    m.dv = {(b.x() - a.x()) / det, -b.x() / det, a.x() / det};
    m.area = 0.5 * std::abs(det);
    m.fabric = t.fabric;
    maps.push_back(m);
  }
  return maps;
}

void declare_pairs(const std::vector<TriangleMap>& maps, std::vector<std::array<int, 2>>& pairs) {
  for (const TriangleMap& m : maps)
    for (int k = 0; k < 3; ++k)
      pairs.push_back({m.particle[k], m.particle[(k + 1) % 3]});
}

void find_slots(std::vector<TriangleMap>& maps, const BlockMatrix& matrix) {
  for (TriangleMap& m : maps)
    for (int k = 0; k < 3; ++k)
      m.slots[k] = matrix.slot(m.particle[k], m.particle[(k + 1) % 3]);
}

} // namespace sloper::cloth
