#include <garment/retarget_grade.hpp>

#include <garment/bind_laplacian.hpp>
#include <geometry/sparse_solver.hpp>

#include <Eigen/LU>

#include <algorithm>
#include <cmath>
#include <memory>
#include <tuple>

namespace sloper::garment {

namespace {

constexpr double GRADE_LENGTH = 0.08; // m over which the stretch of a panel is smoothed
constexpr double SEAM_STIFFNESS = 30; // of the length of a seam edge, against the weights of the layout, which are about 1
constexpr int SEAM_ROUNDS = 40;

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

/// One panel on its way to a new layout, in the grain's axes (x weft, y warp); local vertex numbers are global ones less the panel's first.
struct PanelLayout {
  const pattern::PanelInfo* panel;
  Mat2 to_grain; ///< rows: weft, warp
  Vec2 centroid = Vec2::Zero();
  std::vector<Vec3> flat; ///< before
  std::vector<Triangle> triangles;
  Eigen::MatrixX2d right, solved;
  std::vector<Eigen::Triplet<double>> entries;
  SparseSolver solver; ///< of `entries`

  double length_before(int i, int j) const { return (flat[i] - flat[j]).norm(); }
  double length_now(int i, int j) const { return (solved.row(i) - solved.row(j)).norm(); }
};

/// A mesh edge of a panel that is sewn to another one.
struct SeamEdge {
  struct Side {
    int layout, from, to; ///< local vertices
  } a, b;
};

/// The wanted gradient of each panel coordinate, and the system that lays the panel out by it.
PanelLayout panel_layout(const Garment& garment, const pattern::PanelInfo& panel, const std::vector<Vec3>& before, const std::vector<Vec3>& after) {
  PanelLayout layout;
  layout.panel = &panel;
  const int n = panel.n_vertices;
  std::vector<Vec3>& flat = layout.flat;
  flat.resize(n);
  layout.to_grain << panel.grain.y(), -panel.grain.x(), panel.grain.x(), panel.grain.y();
  for (int i = 0; i < n; ++i) {
    const Vec2 p = layout.to_grain * garment.panels.pattern[panel.first_vertex + i];
    flat[i] = Vec3(p.x(), p.y(), 0);
    layout.centroid += p / n;
  }
  // Log stretch along weft and warp at vertices, area-weighted.
  Eigen::MatrixX2d log_stretch = Eigen::MatrixX2d::Zero(n, 2);
  Eigen::VectorXd weight = Eigen::VectorXd::Zero(n);
  for (int f = panel.first_triangle; f < panel.first_triangle + panel.n_triangles; ++f) {
    const Triangle& t = garment.panels.triangles[f];
    const Triangle local{t[0] - panel.first_vertex, t[1] - panel.first_vertex, t[2] - panel.first_vertex};
    layout.triangles.push_back(local);
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

  const SurfaceOperators ops = surface_operators(flat, layout.triangles);
  Eigen::SparseMatrix<double> system = GRADE_LENGTH * GRADE_LENGTH * ops.stiffness;
  for (int i = 0; i < n; ++i) system.coeffRef(i, i) += ops.mass[i];
  const SparseSolver smoother(system);
  const Eigen::MatrixX2d weighted = ops.mass.asDiagonal() * log_stretch;
  const Eigen::MatrixX2d smooth = smoother.solve(weighted);

  // Lay out again: weft stretch scales the first grain coordinate, warp stretch the second, each where it stands.
  layout.right = Eigen::MatrixX2d::Zero(n, 2);
  for (const Triangle& t : layout.triangles) {
    const Mat2 d = sides(Vec2(flat[t[0]].head<2>()), Vec2(flat[t[1]].head<2>()), Vec2(flat[t[2]].head<2>()));
    const double area = 0.5 * std::abs(d.determinant());
    if (area < 1e-12) continue;
    const Mat2 inverse = d.inverse(); // rows: gradients of the 2nd and 3rd hat function
    const Vec2 gradient[3] = {-(inverse.row(0) + inverse.row(1)).transpose(), inverse.row(0).transpose(), inverse.row(1).transpose()};
    Vec2 factor = Vec2::Zero();
    for (const int v : t) factor += smooth.row(v).transpose() / 3;
    factor = factor.array().exp();
    for (int i = 0; i < 3; ++i) {
      for (int j = 0; j < 3; ++j) layout.entries.emplace_back(t[i], t[j], area * gradient[i].dot(gradient[j]));
      layout.right(t[i], 0) += area * gradient[i].x() * factor.x(); // wanted gradient of coordinate 0 is (weft, 0)
      layout.right(t[i], 1) += area * gradient[i].y() * factor.y();
    }
  }
  for (int i = 0; i < n; ++i) layout.entries.emplace_back(i, i, 1e-9 * ops.mass[i]); // fixes the free translation, moves nothing
  return layout;
}

void factorise(PanelLayout& layout) {
  Eigen::SparseMatrix<double> system(layout.panel->n_vertices, layout.panel->n_vertices);
  system.setFromTriplets(layout.entries.begin(), layout.entries.end());
  layout.solver.compute(system);
}

std::vector<SeamEdge> seam_edges(const Garment& garment, const std::vector<int>& layout_of_vertex, const std::vector<PanelLayout>& layouts) {
  std::vector<SeamEdge> edges;
  const auto side = [&](int from, int to) {
    const int k = layout_of_vertex[from];
    const int first = k < 0 ? 0 : layouts[k].panel->first_vertex;
    return SeamEdge::Side{k == layout_of_vertex[to] ? k : -1, from - first, to - first};
  };
  for (const pattern::MeshSeam& seam : garment.panels.seams)
    for (std::size_t i = 0; i + 1 < seam.a.size() && i + 1 < seam.b.size(); ++i) {
      const SeamEdge e{side(seam.a[i], seam.a[i + 1]), side(seam.b[i], seam.b[i + 1])};
      if (e.a.layout < 0 || e.b.layout < 0) continue; // from one panel over to the next
      if (layouts[e.a.layout].length_before(e.a.from, e.a.to) > 1e-6 && layouts[e.b.layout].length_before(e.b.from, e.b.to) > 1e-6) edges.push_back(e);
    }
  return edges;
}

/// Rounds that bring both sides of every seam to the ratio of lengths that they had, each way half.
void match_seams(std::vector<PanelLayout>& layouts, const std::vector<SeamEdge>& edges) {
  for (const SeamEdge& e : edges)
    for (const SeamEdge::Side& s : {e.a, e.b})
      for (const auto& [i, j, w] : {std::tuple{s.from, s.from, 1}, std::tuple{s.to, s.to, 1}, std::tuple{s.from, s.to, -1}, std::tuple{s.to, s.from, -1}})
        layouts[s.layout].entries.emplace_back(i, j, w * SEAM_STIFFNESS);
  for (PanelLayout& layout : layouts) factorise(layout);
  for (int round = 0; round < SEAM_ROUNDS; ++round) {
    std::vector<Eigen::MatrixX2d> right;
    for (const PanelLayout& layout : layouts) right.push_back(layout.right);
    for (const SeamEdge& e : edges) {
      const double a = layouts[e.a.layout].length_before(e.a.from, e.a.to), b = layouts[e.b.layout].length_before(e.b.from, e.b.to);
      const double a_now = layouts[e.a.layout].length_now(e.a.from, e.a.to), b_now = layouts[e.b.layout].length_now(e.b.from, e.b.to);
      const double stretch = std::sqrt(std::max(a_now, 1e-6) / a * std::max(b_now, 1e-6) / b);
      for (const auto& [s, length] : {std::pair{e.a, a}, std::pair{e.b, b}}) {
        const PanelLayout& layout = layouts[s.layout];
        const Eigen::RowVector2d d = layout.solved.row(s.to) - layout.solved.row(s.from);
        const Eigen::RowVector2d wanted = SEAM_STIFFNESS * stretch * length / std::max(d.norm(), 1e-9) * d;
        right[s.layout].row(s.to) += wanted;
        right[s.layout].row(s.from) -= wanted;
      }
    }
    for (std::size_t k = 0; k < layouts.size(); ++k) layouts[k].solved = layouts[k].solver.solve(right[k]);
  }
}

} // namespace

void regrade(Garment& garment, const std::vector<Vec3>& before, const std::vector<Vec3>& after) {
  std::vector<PanelLayout> layouts;
  std::vector<int> layout_of_vertex(garment.panels.pattern.size(), -1);
  for (const pattern::PanelInfo& panel : garment.panels.panels) {
    if (panel.n_vertices == 0 || panel.n_triangles == 0) continue;
    for (int i = 0; i < panel.n_vertices; ++i) layout_of_vertex[panel.first_vertex + i] = static_cast<int>(layouts.size());
    layouts.push_back(panel_layout(garment, panel, before, after));
    factorise(layouts.back());
    layouts.back().solved = layouts.back().solver.solve(layouts.back().right);
  }
  match_seams(layouts, seam_edges(garment, layout_of_vertex, layouts));
  for (const PanelLayout& layout : layouts) {
    const Eigen::RowVector2d shift = layout.centroid.transpose() - layout.solved.colwise().mean();
    for (int i = 0; i < layout.panel->n_vertices; ++i)
      garment.panels.pattern[layout.panel->first_vertex + i] = layout.to_grain.transpose() * (layout.solved.row(i) + shift).transpose();
  }
  const auto length = [&](const std::vector<int>& run) {
    double sum = 0;
    for (std::size_t i = 1; i < run.size(); ++i) sum += (garment.panels.pattern[run[i]] - garment.panels.pattern[run[i - 1]]).norm();
    return sum;
  };
  for (pattern::MeshSeam& seam : garment.panels.seams) seam.length_a = length(seam.a), seam.length_b = length(seam.b);
}

} // namespace sloper::garment
