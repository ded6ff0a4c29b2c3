#include <garment/retarget/panel_layout.hpp>

#include <Eigen/LU>

#include <algorithm>
#include <cmath>
#include <utility>

namespace sloper::garment {

namespace {

// What the threads stretch by is smoothed far along a thread, which keeps its length, and little
// across, where each level has its own.
constexpr double ALONG_THREAD = 0.08;    // m
constexpr double ACROSS_THREADS = 0.005; // m
// Threads of loose cloth change evenly from one to the next, so that outlines can be cut: bumps
// narrower than a length that grows with how far the cloth hangs from the skin are smoothed away.
// Measured on 4 garments and 4 fresh bodies: docs/decisions/keep-fit.md.
constexpr double CLOSE_GAP = 0.005;   // m: cloth no farther from the skin is close
constexpr double SMOOTH_PER_GAP = 6;  // length for each metre that cloth hangs farther
constexpr double MOST_SMOOTHED = 0.1; // m
constexpr double GAP_ALONG = 0.3;     // m along a thread over which gaps are averaged ...
constexpr double GAP_ACROSS = 0.02;   // m ... and across: how loose a level is

using Mat2 = Eigen::Matrix2d;
using Mat32 = Eigen::Matrix<double, 3, 2>;

Mat2 sides(const Vec2& a, const Vec2& b, const Vec2& c) {
  Mat2 m;
  m << b - a, c - a;
  return m;
}

FlatTriangle flat_triangle(const Vec3& a, const Vec3& b, const Vec3& c) {
  FlatTriangle result;
  const Mat2 d = sides(Vec2(a.head<2>()), Vec2(b.head<2>()), Vec2(c.head<2>()));
  const double area = 0.5 * std::abs(d.determinant());
  if (area < 1e-12)
    return result;
  const Mat2 inverse = d.inverse(); // rows: gradients of the 2nd and 3rd hat function
  result.area = area;
  result.gradient = {-(inverse.row(0) + inverse.row(1)).transpose(), inverse.row(0).transpose(),
                     inverse.row(1).transpose()};
  return result;
}

/// The least squares fit to a value of each triangle by a function over the vertices, linear in
/// each triangle, under a smoothness that is added.
Eigen::VectorXd fitted(const PanelLayout& layout, const std::vector<double>& values,
                       std::vector<Eigen::Triplet<double>> smoothness) {
  const int n = layout.panel->n_vertices;
  Eigen::VectorXd right = Eigen::VectorXd::Zero(n);
  for (std::size_t f = 0; f < layout.triangles.size(); ++f) {
    const double area = layout.shapes[f].area;
    for (const int i : layout.triangles[f]) {
      right[i] += area / 3 * values[f];
      for (const int j : layout.triangles[f])
        smoothness.emplace_back(i, j, area / 9);
    }
  }
  for (int i = 0; i < n; ++i)
    smoothness.emplace_back(i, i, 1e-12); // for vertices of no triangle
  return SparseSolver(matrix_of(smoothness, n)).solve(right);
}

/// #F: how far from the skin the cloth hung, m; 0 where that is not known.
std::vector<double> triangle_gaps(const Garment& garment, const PanelLayout& layout) {
  std::vector<double> gaps(layout.triangles.size(), 0.0);
  if (garment.bind.empty())
    return gaps;
  for (std::size_t f = 0; f < gaps.size(); ++f)
    for (const int v : layout.triangles[f])
      for (const BindWeight& w :
           garment.bind.particles[garment.particle_of[layout.panel->first_vertex + v]])
        gaps[f] += w.weight * std::max(w.gap, 0.0) / 3;
  return gaps;
}

/// Adds the squared second derivative of a function across the threads of an axis, its bump of a
/// width of lengths[i] at vertex i as heavy as the function itself: threads that change evenly from
/// one to the next are free. At the outline it is not known.
void add_bending(const PanelLayout& layout, int axis, const std::vector<double>& lengths,
                 std::vector<Eigen::Triplet<double>>& entries) {
  const int n = layout.panel->n_vertices;
  std::vector<Eigen::Triplet<double>> slopes;
  add_gradients(layout, axis, 0, 1, slopes);
  Eigen::VectorXd areas = Eigen::VectorXd::Zero(n);
  for (std::size_t f = 0; f < layout.triangles.size(); ++f)
    for (const int i : layout.triangles[f])
      areas[i] += layout.shapes[f].area / 3;
  Eigen::VectorXd weights(n);
  for (int i = 0; i < n; ++i)
    weights[i] = areas[i] > 0 ? std::pow(lengths[i], 4) / areas[i] : 0;
  for (const int v : layout.panel->outline)
    weights[v - layout.panel->first_vertex] = 0;
  const Eigen::SparseMatrix<double> slope = matrix_of(slopes, n);
  const Eigen::SparseMatrix<double> bending = slope.transpose() * weights.asDiagonal() * slope;
  for (int k = 0; k < bending.outerSize(); ++k)
    for (Eigen::SparseMatrix<double>::InnerIterator e(bending, k); e; ++e)
      entries.emplace_back(static_cast<int>(e.row()), static_cast<int>(e.col()), e.value());
}

/// What the threads of one axis are to stretch by, over the vertices: smooth along each thread, and
/// from thread to thread as far as the cloth hangs loose.
/// @param values  #F, log stretch
Eigen::VectorXd smooth_stretch(const Garment& garment, const PanelLayout& layout, int axis,
                               const std::vector<double>& values) {
  std::vector<Eigen::Triplet<double>> entries;
  add_gradients(layout, axis, GAP_ALONG * GAP_ALONG, GAP_ACROSS * GAP_ACROSS, entries);
  const Eigen::VectorXd gaps = fitted(layout, triangle_gaps(garment, layout), std::move(entries));
  std::vector<double> lengths(gaps.size());
  for (std::size_t i = 0; i < lengths.size(); ++i)
    lengths[i] = std::clamp(SMOOTH_PER_GAP * (gaps[i] - CLOSE_GAP), 0.0, MOST_SMOOTHED);
  std::vector<Eigen::Triplet<double>> smoothness;
  add_gradients(layout, axis, ALONG_THREAD * ALONG_THREAD, ACROSS_THREADS * ACROSS_THREADS,
                smoothness);
  add_bending(layout, axis, lengths, smoothness);
  return fitted(layout, values, std::move(smoothness));
}

} // namespace

void add_gradients(const PanelLayout& layout, int axis, double along, double across,
                   std::vector<Eigen::Triplet<double>>& entries) {
  for (std::size_t f = 0; f < layout.triangles.size(); ++f) {
    const Triangle& t = layout.triangles[f];
    const FlatTriangle& flat = layout.shapes[f];
    for (int i = 0; i < 3 && flat.area > 0; ++i)
      for (int j = 0; j < 3; ++j)
        entries.emplace_back(
            t[i], t[j],
            flat.area * (along * flat.gradient[i][axis] * flat.gradient[j][axis] +
                         across * flat.gradient[i][1 - axis] * flat.gradient[j][1 - axis]));
  }
}

Eigen::SparseMatrix<double> matrix_of(const std::vector<Eigen::Triplet<double>>& entries, int n) {
  Eigen::SparseMatrix<double> matrix(n, n);
  matrix.setFromTriplets(entries.begin(), entries.end());
  return matrix;
}

PanelLayout stretched_panel(const Garment& garment, const pattern::PanelInfo& panel,
                            const std::vector<Vec3>& before, const std::vector<Vec3>& after,
                            const std::vector<Vec2>& widen_strained_pieces) {
  PanelLayout layout;
  layout.panel = &panel;
  const int n = panel.n_vertices;
  std::vector<Vec3>& flat = layout.flat;
  flat.resize(n);
  layout.to_grain << panel.grain.y(), -panel.grain.x(), panel.grain.x(), panel.grain.y();
  for (int i = 0; i < n; ++i) {
    const Vec2 p = layout.to_grain * garment.panels.pattern[panel.first_vertex + i];
    flat[i] = Vec3(p.x(), p.y(), 0);
  }
  for (int f = panel.first_triangle; f < panel.first_triangle + panel.n_triangles; ++f) {
    const Triangle& t = garment.panels.triangles[f];
    const Triangle local{t[0] - panel.first_vertex, t[1] - panel.first_vertex,
                         t[2] - panel.first_vertex};
    layout.triangles.push_back(local);
    layout.shapes.push_back(flat_triangle(flat[local[0]], flat[local[1]], flat[local[2]]));
  }
  std::array<std::vector<double>, 2> values; // log stretch of weft and warp in each triangle
  for (std::size_t f = 0; f < layout.triangles.size(); ++f) {
    const Triangle& t = garment.panels.triangles[panel.first_triangle + f];
    const FlatTriangle& shape = layout.shapes[f];
    Mat32 then = Mat32::Zero(),
          now = Mat32::Zero(); // columns: where a unit of weft, a unit of warp lay and lies
    for (int k = 0; k < 3 && shape.area > 0; ++k) {
      then += before[garment.particle_of[t[k]]] * shape.gradient[k].transpose();
      now += after[garment.particle_of[t[k]]] * shape.gradient[k].transpose();
    }
    for (int axis = 0; axis < 2; ++axis) {
      const double ratio = now.col(axis).norm() / std::max(then.col(axis).norm(), 1e-9);
      values[axis].push_back(shape.area > 0 ? std::log(std::clamp(ratio, 0.2, 5.0)) : 0);
      if (!widen_strained_pieces.empty())
        values[axis].back() += widen_strained_pieces[panel.first_triangle + f][axis];
    }
  }
  layout.log_stretch.resize(n, 2);
  for (int axis = 0; axis < 2; ++axis)
    layout.log_stretch.col(axis) = smooth_stretch(garment, layout, axis, values[axis]);
  return layout;
}

} // namespace sloper::garment
