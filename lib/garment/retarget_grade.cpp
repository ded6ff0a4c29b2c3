#include <garment/retarget_grade.hpp>

#include <garment/bind_laplacian.hpp>
#include <garment/pattern_mirror.hpp>
#include <geometry/sparse_solver.hpp>

#include <Eigen/LU>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <memory>
#include <tuple>

namespace sloper::garment {

namespace {

constexpr double GRADE_LENGTH = 0.08; // m over which the stretch of a panel is smoothed
constexpr double SEAM_STIFFNESS = 30; // of the length of a seam edge, against the weights of the layout, which are about 1
constexpr int SEAM_ROUNDS = 400;      // at most
constexpr double SEAM_EDGE = 2e-6;    // m that the sides of a seam edge may differ by
constexpr double SEAM_FINDING = 1e-3; // m that the sides of a whole seam may differ by without a word

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
  Eigen::MatrixX2d log_stretch; ///< wanted, at vertices: weft, warp
  Eigen::MatrixX2d right, solved;
  std::vector<Eigen::Triplet<double>> entries;
  SparseSolver solver; ///< of `entries`

  double length_before(int i, int j) const { return (flat[i] - flat[j]).norm(); }
  double length_now(int i, int j) const { return (solved.row(i) - solved.row(j)).norm(); }
};

/// A mesh edge of a panel that is sewn to another one.
struct SeamEdge {
  struct Side {
    int layout, from, to;                                 ///< local vertices
    Eigen::RowVector2d dual = Eigen::RowVector2d::Zero(); ///< what the layout resisted so far
  } a, b;
};

/// A panel as it is, with the stretch that its cloth is to follow.
PanelLayout stretched_panel(const Garment& garment, const pattern::PanelInfo& panel, const std::vector<Vec3>& before, const std::vector<Vec3>& after) {
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
  layout.log_stretch = smoother.solve(weighted);
  return layout;
}

/// The wanted gradient of each panel coordinate, and the system that lays the panel out by it: weft stretch scales the first grain
/// coordinate, warp stretch the second, each where it stands.
void lay_out(PanelLayout& layout) {
  const int n = layout.panel->n_vertices;
  const std::vector<Vec3>& flat = layout.flat;
  layout.right = Eigen::MatrixX2d::Zero(n, 2);
  for (const Triangle& t : layout.triangles) {
    const Mat2 d = sides(Vec2(flat[t[0]].head<2>()), Vec2(flat[t[1]].head<2>()), Vec2(flat[t[2]].head<2>()));
    const double area = 0.5 * std::abs(d.determinant());
    if (area < 1e-12) continue;
    const Mat2 inverse = d.inverse(); // rows: gradients of the 2nd and 3rd hat function
    const Vec2 gradient[3] = {-(inverse.row(0) + inverse.row(1)).transpose(), inverse.row(0).transpose(), inverse.row(1).transpose()};
    Vec2 factor = Vec2::Zero();
    for (const int v : t) factor += layout.log_stretch.row(v).transpose() / 3;
    factor = factor.array().exp();
    for (int i = 0; i < 3; ++i) {
      for (int j = 0; j < 3; ++j) layout.entries.emplace_back(t[i], t[j], area * gradient[i].dot(gradient[j]));
      layout.right(t[i], 0) += area * gradient[i].x() * factor.x(); // wanted gradient of coordinate 0 is (weft, 0)
      layout.right(t[i], 1) += area * gradient[i].y() * factor.y();
    }
  }
  for (int i = 0; i < n; ++i) layout.entries.emplace_back(i, i, 1e-12); // fixes the free translation, moves nothing
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

/// Brings both sides of every seam to the ratio of lengths that they had, mesh edge by mesh edge, by the alternating direction method of
/// multipliers (Boyd et al. 2011): the layouts against the nearest edges of that ratio, with what the layouts resist added up.
void match_seams(std::vector<PanelLayout>& layouts, std::vector<SeamEdge>& edges) {
  for (const SeamEdge& e : edges)
    for (const SeamEdge::Side* s : {&e.a, &e.b})
      for (const auto& [i, j, w] :
           {std::tuple{s->from, s->from, 1}, std::tuple{s->to, s->to, 1}, std::tuple{s->from, s->to, -1}, std::tuple{s->to, s->from, -1}})
        layouts[s->layout].entries.emplace_back(i, j, w * SEAM_STIFFNESS);
  for (PanelLayout& layout : layouts) factorise(layout);
  for (int round = 0; round < SEAM_ROUNDS; ++round) {
    std::vector<Eigen::MatrixX2d> right;
    for (const PanelLayout& layout : layouts) right.push_back(layout.right);
    double apart = 0;
    for (SeamEdge& e : edges) {
      const double a = layouts[e.a.layout].length_before(e.a.from, e.a.to), b = layouts[e.b.layout].length_before(e.b.from, e.b.to);
      const double a_now = layouts[e.a.layout].length_now(e.a.from, e.a.to), b_now = layouts[e.b.layout].length_now(e.b.from, e.b.to);
      apart = std::max(apart, std::abs(a_now * b / a - b_now));
      const auto towards = [&](const SeamEdge::Side& s) {
        return Eigen::RowVector2d(layouts[s.layout].solved.row(s.to) - layouts[s.layout].solved.row(s.from) + s.dual);
      };
      const Eigen::RowVector2d to_a = towards(e.a), to_b = towards(e.b);
      const double stretch = (a * to_a.norm() + b * to_b.norm()) / (a * a + b * b);
      const auto pull = [&](SeamEdge::Side& s, const Eigen::RowVector2d& to, double length) {
        const Eigen::RowVector2d wanted = stretch * length / std::max(to.norm(), 1e-9) * to;
        s.dual = to - wanted;
        const Eigen::RowVector2d force = SEAM_STIFFNESS * (wanted - s.dual);
        right[s.layout].row(s.to) += force;
        right[s.layout].row(s.from) -= force;
      };
      pull(e.a, to_a, a);
      pull(e.b, to_b, b);
    }
    if (apart < SEAM_EDGE) return;
    for (std::size_t k = 0; k < layouts.size(); ++k) layouts[k].solved = layouts[k].solver.solve(right[k]);
  }
}

/// The mirror images of panels that are graded alike, by layout, partners as layouts too.
std::vector<PanelMirror> mirrors_of(const Garment& garment, const std::vector<PanelLayout>& layouts, const std::vector<Vec3>& before, const GradeSides& sides) {
  std::vector<Vec3> position;
  for (const int p : garment.particle_of) position.push_back(before[p]);
  const std::vector<PanelMirror> by_panel = panel_mirrors(garment.panels, position);
  std::map<int, int> layout_of_panel;
  const auto index = [&](const PanelLayout& layout) { return static_cast<int>(layout.panel - garment.panels.panels.data()); };
  for (std::size_t k = 0; k < layouts.size(); ++k) layout_of_panel[index(layouts[k])] = static_cast<int>(k);
  std::vector<PanelMirror> mirrors;
  for (const PanelLayout& layout : layouts) {
    PanelMirror mirror = by_panel[index(layout)];
    const auto partner = layout_of_panel.find(mirror.partner);
    mirror.partner = partner == layout_of_panel.end() || sides.apart.count(limb_of(garment, *layout.panel)) ? -1 : partner->second;
    mirrors.push_back(mirror);
  }
  return mirrors;
}

/// Half of what a panel's own vertices have and half of what its mirror image has there.
/// @param own  of a layout   @param turned  a value of the mirror image as the panel itself would have it
template<class Own, class Turned>
std::vector<Eigen::MatrixX2d> averaged(const Garment& garment, const std::vector<PanelLayout>& layouts, const std::vector<PanelMirror>& mirrors, Own&& own,
                                       Turned&& turned) {
  std::vector<Eigen::MatrixX2d> result;
  for (std::size_t k = 0; k < layouts.size(); ++k) {
    result.push_back(own(layouts[k]));
    if (mirrors[k].partner < 0) continue;
    const PanelLayout& partner = layouts[mirrors[k].partner];
    Eigen::MatrixX2d seen = seen_from_mirror(garment.panels, *partner.panel, *layouts[k].panel, mirrors[k], own(partner));
    turned(mirrors[k], seen);
    result.back() = 0.5 * (result.back() + seen);
  }
  return result;
}

double run_length(const Garment& garment, const std::vector<int>& run) {
  double sum = 0;
  for (std::size_t i = 1; i < run.size(); ++i) sum += (garment.panels.pattern[run[i]] - garment.panels.pattern[run[i - 1]]).norm();
  return sum;
}

/// Notes the seams' new lengths, and tells of those whose sides no longer match as they did.
void measure_seams(Garment& garment, const std::vector<std::array<double, 2>>& before, GradeReport& report) {
  for (std::size_t s = 0; s < garment.panels.seams.size(); ++s) {
    pattern::MeshSeam& seam = garment.panels.seams[s];
    seam.length_a = run_length(garment, seam.a), seam.length_b = run_length(garment, seam.b);
    if (!(before[s][0] > 0 && before[s][1] > 0)) continue;
    const double apart = std::abs(seam.length_a - seam.length_b * before[s][0] / before[s][1]);
    report.largest_seam_change_m = std::max(report.largest_seam_change_m, apart);
    if (apart <= SEAM_FINDING) continue;
    char length[32];
    std::snprintf(length, sizeof length, "%.1f", 1000 * apart);
    report.findings.push_back("the sides of seam \"" + seam.name + "\" fit each other " + length + " mm worse than before grading");
  }
}

} // namespace

std::string limb_of(const Garment& garment, const pattern::PanelInfo& panel) {
  std::map<std::string, double> share;
  for (int v = panel.first_vertex; v < panel.first_vertex + panel.n_vertices && !garment.bind.empty(); ++v)
    for (const BindWeight& w : garment.bind.particles[garment.particle_of[v]]) {
      const std::string& frame = garment.bind.frames[w.frame];
      share[frame.find("arm_") != std::string::npos ? "arm" : frame.rfind("leg_", 0) == 0 ? "leg" : "torso"] += w.weight;
    }
  const auto most = std::max_element(share.begin(), share.end(), [](const auto& a, const auto& b) { return a.second < b.second; });
  return most == share.end() ? "torso" : most->first;
}

GradeReport regrade(Garment& garment, const std::vector<Vec3>& before, const std::vector<Vec3>& after, const GradeSides& sides) {
  GradeReport report;
  std::vector<PanelLayout> layouts;
  std::vector<int> layout_of_vertex(garment.panels.pattern.size(), -1);
  for (const pattern::PanelInfo& panel : garment.panels.panels) {
    if (panel.n_vertices == 0 || panel.n_triangles == 0) continue;
    for (int i = 0; i < panel.n_vertices; ++i) layout_of_vertex[panel.first_vertex + i] = static_cast<int>(layouts.size());
    layouts.push_back(stretched_panel(garment, panel, before, after));
  }
  const std::vector<PanelMirror> mirrors = mirrors_of(garment, layouts, before, sides);
  for (const PanelMirror& mirror : mirrors) report.mirrored_panels += mirror.partner >= 0;
  const std::vector<Eigen::MatrixX2d> stretch = averaged(
      garment, layouts, mirrors, [](const PanelLayout& layout) { return layout.log_stretch; },
      [](const PanelMirror& mirror, Eigen::MatrixX2d& seen) {
        if (mirror.grain_across) seen.col(0).swap(seen.col(1));
      });
  for (std::size_t k = 0; k < layouts.size(); ++k) {
    layouts[k].log_stretch = stretch[k];
    lay_out(layouts[k]);
    factorise(layouts[k]);
    layouts[k].solved = layouts[k].solver.solve(layouts[k].right);
  }
  std::vector<SeamEdge> edges = seam_edges(garment, layout_of_vertex, layouts);
  match_seams(layouts, edges);

  // What meshes that are no mirror images of each other left of the difference goes here; it is far below a millimetre.
  const std::vector<Eigen::MatrixX2d> moved = averaged(
      garment, layouts, mirrors,
      [](const PanelLayout& layout) {
        Eigen::MatrixX2d move(layout.panel->n_vertices, 2);
        for (int i = 0; i < move.rows(); ++i)
          move.row(i) = (layout.to_grain.transpose() * (layout.solved.row(i).transpose() - Vec2(layout.flat[i].head<2>()))).transpose();
        return move;
      },
      [](const PanelMirror& mirror, Eigen::MatrixX2d& seen) { seen = Eigen::MatrixX2d(seen * mirror.linear); });
  std::vector<std::array<double, 2>> lengths;
  for (const pattern::MeshSeam& seam : garment.panels.seams) lengths.push_back({run_length(garment, seam.a), run_length(garment, seam.b)});
  for (std::size_t k = 0; k < layouts.size(); ++k) {
    const Eigen::RowVector2d shift = moved[k].colwise().mean(); // the panel keeps its centroid
    for (int i = 0; i < layouts[k].panel->n_vertices; ++i) garment.panels.pattern[layouts[k].panel->first_vertex + i] += (moved[k].row(i) - shift).transpose();
  }
  for (const auto& [limb, why] : sides.apart)
    if (std::any_of(garment.panels.panels.begin(), garment.panels.panels.end(),
                    [&, limb = limb](const auto& panel) { return limb_of(garment, panel) == limb; })) // clang 14 captures no structured binding
      report.findings.push_back(why + ": more than is graded alike, so left and right are graded apart");
  measure_seams(garment, lengths, report);
  return report;
}

} // namespace sloper::garment
