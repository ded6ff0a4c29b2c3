#include <garment/retarget_grade.hpp>

#include <garment/bind_laplacian.hpp>

#include <Eigen/LU>
#include <Eigen/SparseCholesky>

#include <algorithm>
#include <cmath>

namespace sloper::garment {

namespace {

constexpr double GRADE_LENGTH = 0.08; // m over which the stretch of a panel is smoothed

using Mat2 = Eigen::Matrix2d;
using Mat32 = Eigen::Matrix<double, 3, 2>;

Mat2 sides(const Vec2& a, const Vec2& b, const Vec2& c) {
  Mat2 m;
  m << b - a, c - a;
  return m;
}
Mat32 sides(const Vec3& a, const Vec3& b, const Vec3& c) {
  Mat32 m;
  m << b - a, c - a;
  return m;
}

/// Grades one panel; local vertex numbers are global ones less the panel's first.
void regrade_panel(Garment& garment, const pattern::PanelInfo& panel, const std::vector<Vec3>& before, const std::vector<Vec3>& after) {
  const int n = panel.n_vertices;
  if (n == 0 || panel.n_triangles == 0) return;
  std::vector<Vec3> flat(n);
  Mat2 to_grain; // rows: weft, warp
  to_grain << panel.grain.y(), -panel.grain.x(), panel.grain.x(), panel.grain.y();
  Vec2 centroid = Vec2::Zero();
  for (int i = 0; i < n; ++i) {
    const Vec2 p = to_grain * garment.panels.pattern[panel.first_vertex + i];
    flat[i] = Vec3(p.x(), p.y(), 0);
    centroid += p / n;
  }
  std::vector<Triangle> triangles;
  // Log stretch along weft and warp at vertices, area-weighted.
  Eigen::MatrixX2d log_stretch = Eigen::MatrixX2d::Zero(n, 2);
  Eigen::VectorXd weight = Eigen::VectorXd::Zero(n);
  for (int f = panel.first_triangle; f < panel.first_triangle + panel.n_triangles; ++f) {
    const Triangle& t = garment.panels.triangles[f];
    const Triangle local{t[0] - panel.first_vertex, t[1] - panel.first_vertex, t[2] - panel.first_vertex};
    triangles.push_back(local);
    const Mat2 d = sides(Vec2(flat[local[0]].head<2>()), Vec2(flat[local[1]].head<2>()), Vec2(flat[local[2]].head<2>()));
    const double area = 0.5 * std::abs(d.determinant());
    if (area < 1e-12) continue;
    const auto corner = [&](const std::vector<Vec3>& x, int k) -> const Vec3& { return x[garment.particle_of[t[k]]]; };
    const Mat32 fb = sides(corner(before, 0), corner(before, 1), corner(before, 2)) * d.inverse();
    const Mat32 fa = sides(corner(after, 0), corner(after, 1), corner(after, 2)) * d.inverse();
    for (int axis = 0; axis < 2; ++axis) {
      const double ratio = fa.col(axis).norm() / std::max(fb.col(axis).norm(), 1e-9);
      const double value = std::log(std::clamp(ratio, 0.2, 5.0));
      for (const int v : local) log_stretch(v, axis) += area * value;
    }
    for (const int v : local) weight[v] += area;
  }
  for (int i = 0; i < n; ++i)
    if (weight[i] > 0) log_stretch.row(i) /= weight[i];

  const SurfaceOperators ops = surface_operators(flat, triangles);
  Eigen::SparseMatrix<double> system = GRADE_LENGTH * GRADE_LENGTH * ops.stiffness;
  for (int i = 0; i < n; ++i) system.coeffRef(i, i) += ops.mass[i];
  const Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> smoother(system);
  const Eigen::MatrixX2d weighted = ops.mass.asDiagonal() * log_stretch;
  const Eigen::MatrixX2d smooth = smoother.solve(weighted);

  // Lay out again: weft stretch scales the first grain coordinate, warp stretch the second, each where it stands.
  std::vector<Eigen::Triplet<double>> entries;
  Eigen::MatrixX2d right = Eigen::MatrixX2d::Zero(n, 2);
  for (const Triangle& t : triangles) {
    const Mat2 d = sides(Vec2(flat[t[0]].head<2>()), Vec2(flat[t[1]].head<2>()), Vec2(flat[t[2]].head<2>()));
    const double area = 0.5 * std::abs(d.determinant());
    if (area < 1e-12) continue;
    const Mat2 inverse = d.inverse(); // rows: gradients of the 2nd and 3rd hat function
    const Vec2 gradient[3] = {-(inverse.row(0) + inverse.row(1)).transpose(), inverse.row(0).transpose(), inverse.row(1).transpose()};
    Vec2 factor = Vec2::Zero();
    for (const int v : t) factor += smooth.row(v).transpose() / 3;
    factor = factor.array().exp();
    for (int i = 0; i < 3; ++i) {
      for (int j = 0; j < 3; ++j) entries.emplace_back(t[i], t[j], area * gradient[i].dot(gradient[j]));
      right(t[i], 0) += area * gradient[i].x() * factor.x(); // wanted gradient of coordinate 0 is (weft, 0)
      right(t[i], 1) += area * gradient[i].y() * factor.y();
    }
  }
  for (int i = 0; i < n; ++i) entries.emplace_back(i, i, 1e-9 * ops.mass[i]); // fixes the free translation, moves nothing
  Eigen::SparseMatrix<double> poisson(n, n);
  poisson.setFromTriplets(entries.begin(), entries.end());
  const Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> layout(poisson);
  const Eigen::MatrixX2d solved = layout.solve(right);
  const Eigen::RowVector2d shift = centroid.transpose() - solved.colwise().mean();
  for (int i = 0; i < n; ++i) garment.panels.pattern[panel.first_vertex + i] = to_grain.transpose() * (solved.row(i) + shift).transpose();
}

} // namespace

void regrade(Garment& garment, const std::vector<Vec3>& before, const std::vector<Vec3>& after) {
  for (const pattern::PanelInfo& panel : garment.panels.panels) regrade_panel(garment, panel, before, after);
  const auto length = [&](const std::vector<int>& run) {
    double sum = 0;
    for (std::size_t i = 1; i < run.size(); ++i) sum += (garment.panels.pattern[run[i]] - garment.panels.pattern[run[i - 1]]).norm();
    return sum;
  };
  for (pattern::MeshSeam& seam : garment.panels.seams) seam.length_a = length(seam.a), seam.length_b = length(seam.b);
}

} // namespace sloper::garment
