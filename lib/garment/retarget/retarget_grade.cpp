#include <garment/retarget/retarget_grade.hpp>

#include <garment/retarget/panel_layout.hpp>
#include <garment/retarget/pattern_mirror.hpp>
#include <sloper/geometry/sparse_solver.hpp>

#include <Eigen/LU>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <tuple>
#include <utility>

namespace sloper::garment {

namespace {

constexpr double SQUARE =
    0.02; // of the angle between warp and weft, a right one, against their lengths
constexpr double SEAM_STIFFNESS =
    30; // of the length of a seam edge, against the weights of the layout, which are about 1
constexpr double LAYOUT_MOVE = 5e-6; // m of no vertex in a round: the layout has come to rest
constexpr int LAYOUT_ROUNDS = 1000;  // at most
constexpr double SEAM_EDGE = 2e-6;   // m that the sides of a seam edge may differ by
constexpr double STRAIGHT =
    1 - 1e-4; // of a seam's length that its ends are apart: it is cut on a straight line
constexpr double STRAIGHTENING =
    0.05; // how far a straight seam of mirror images goes back to its line in one round
constexpr double SEAM_FINDING =
    1e-3; // m that the sides of a whole seam may differ by without a word

using Mat2 = Eigen::Matrix2d;

/// A mesh edge of a panel that is sewn to another one.
struct SeamEdge {
  struct Side {
    int layout, from, to;                                 ///< local vertices
    Eigen::RowVector2d dual = Eigen::RowVector2d::Zero(); ///< what the layout resisted so far
  } a, b;
  bool keeps_direction; ///< of a straight seam between a panel and its mirror image: it leaves its
                        ///< line only where nothing else gives way
};

/// What weft and warp of a triangle are to be stretched by.
Vec2 wanted_stretch(const PanelLayout& layout, const Triangle& t) {
  Vec2 log = Vec2::Zero();
  for (const int v : t)
    log += layout.log_stretch.row(v).transpose() / 3;
  return log.array().exp();
}

/// The system that lays a panel out, and the layout to begin with: each coordinate by itself, its
/// threads not turned.
void start_layout(PanelLayout& layout) {
  const int n = layout.panel->n_vertices;
  layout.stretch.clear();
  for (const Triangle& t : layout.triangles)
    layout.stretch.push_back(wanted_stretch(layout, t));
  const auto hold = [&](std::vector<Eigen::Triplet<double>>&
                            entries) { // fixes the free translation, moves nothing
    for (int i = 0; i < n; ++i)
      entries.emplace_back(i, i, 1e-12);
  };
  Eigen::MatrixX2d right = Eigen::MatrixX2d::Zero(n, 2);
  for (std::size_t f = 0; f < layout.triangles.size(); ++f)
    for (int i = 0; i < 3 && layout.shapes[f].area > 0; ++i)
      right.row(layout.triangles[f][i]) +=
          layout.shapes[f].area *
          layout.shapes[f].gradient[i].cwiseProduct(layout.stretch[f]).transpose();
  layout.solved.resize(n, 2);
  for (int axis = 0; axis < 2; ++axis) {
    std::vector<Eigen::Triplet<double>> entries;
    add_gradients(layout, axis, 1, SQUARE, entries);
    hold(entries);
    layout.solved.col(axis) =
        SparseSolver(matrix_of(entries, n)).solve(Eigen::VectorXd(right.col(axis)));
  }
  layout.seams = Eigen::MatrixX2d::Zero(n, 2);
  add_gradients(layout, 0, 1, 1, layout.entries);
  hold(layout.entries);
}

/// One round of a layout: each triangle's threads take the wanted lengths in the directions that
/// they have, nearly free to slant against each other as cloth is, and the panel comes as near to
/// all triangles as it can (the local and the global step of Liu et al. 2008, A local/global
/// approach to mesh parameterization, for threads).
/// @return the longest move of a vertex, m
double lay_out(PanelLayout& layout) {
  Eigen::MatrixX2d right = layout.seams;
  for (std::size_t f = 0; f < layout.triangles.size(); ++f) {
    const Triangle& t = layout.triangles[f];
    const FlatTriangle& flat = layout.shapes[f];
    if (flat.area <= 0)
      continue;
    Mat2 jacobian = Mat2::Zero(); // columns: where a unit of weft, a unit of warp now goes
    for (int i = 0; i < 3; ++i)
      jacobian += layout.solved.row(t[i]).transpose() * flat.gradient[i].transpose();
    const Vec2 weft = jacobian.col(0).normalized(), warp = jacobian.col(1).normalized(),
               stretch = layout.stretch[f];
    const Vec2 square = (weft + Vec2(warp.y(), -warp.x())).normalized(); // halfway to a right angle
    Mat2 wanted;
    wanted.col(0) = stretch[0] * ((1 - SQUARE) * weft + SQUARE * square).normalized();
    wanted.col(1) =
        stretch[1] * ((1 - SQUARE) * warp + SQUARE * Vec2(-square.y(), square.x())).normalized();
    for (int i = 0; i < 3; ++i)
      right.row(t[i]) += flat.area * (wanted * flat.gradient[i]).transpose();
  }
  const Eigen::MatrixX2d before = std::exchange(layout.solved, layout.solver.solve(right));
  return (layout.solved - before).rowwise().norm().maxCoeff();
}

double run_length(const Garment& garment, const std::vector<int>& run) {
  double sum = 0;
  for (std::size_t i = 1; i < run.size(); ++i)
    sum += (garment.panels.pattern[run[i]] - garment.panels.pattern[run[i - 1]]).norm();
  return sum;
}

bool is_straight(const Garment& garment, const std::vector<int>& run) {
  const double chord =
      (garment.panels.pattern[run.back()] - garment.panels.pattern[run.front()]).norm();
  return chord >= STRAIGHT * run_length(garment, run);
}

std::vector<SeamEdge> seam_edges(const Garment& garment, const std::vector<int>& layout_of_vertex,
                                 const std::vector<PanelLayout>& layouts,
                                 const std::vector<PanelMirror>& mirrors) {
  std::vector<SeamEdge> edges;
  const auto side = [&](int from, int to) {
    const int k = layout_of_vertex[from];
    const int first = k < 0 ? 0 : layouts[k].panel->first_vertex;
    return SeamEdge::Side{k == layout_of_vertex[to] ? k : -1, from - first, to - first};
  };
  for (const pattern::MeshSeam& seam : garment.panels.seams)
    for (std::size_t i = 0; i + 1 < seam.a.size() && i + 1 < seam.b.size(); ++i) {
      SeamEdge e{side(seam.a[i], seam.a[i + 1]), side(seam.b[i], seam.b[i + 1]), false};
      if (e.a.layout < 0 || e.b.layout < 0)
        continue; // from one panel over to the next
      e.keeps_direction = mirrors[e.a.layout].partner == e.b.layout && e.a.layout != e.b.layout &&
                          is_straight(garment, seam.a) && is_straight(garment, seam.b);
      if (layouts[e.a.layout].length_before(e.a.from, e.a.to) > 1e-6 &&
          layouts[e.b.layout].length_before(e.b.from, e.b.to) > 1e-6)
        edges.push_back(e);
    }
  return edges;
}

/// Lays the panels out, with both sides of every seam in the ratio of lengths that they had, mesh
/// edge by mesh edge, by the alternating direction method of multipliers (Boyd et al. 2011): the
/// layouts against the nearest edges of that ratio, with what the layouts resist added up.
void lay_out_together(std::vector<PanelLayout>& layouts, std::vector<SeamEdge>& edges) {
  for (const SeamEdge& e : edges)
    for (const SeamEdge::Side* s : {&e.a, &e.b})
      for (const auto& [i, j, w] : {std::tuple{s->from, s->from, 1}, std::tuple{s->to, s->to, 1},
                                    std::tuple{s->from, s->to, -1}, std::tuple{s->to, s->from, -1}})
        layouts[s->layout].entries.emplace_back(i, j, w * SEAM_STIFFNESS);
  for (PanelLayout& layout : layouts)
    layout.solver.compute(matrix_of(layout.entries, layout.panel->n_vertices));
  for (int round = 0; round < LAYOUT_ROUNDS; ++round) {
    for (PanelLayout& layout : layouts)
      layout.seams.setZero();
    double apart = 0, largest_move = 0;
    for (SeamEdge& e : edges) {
      const double a = layouts[e.a.layout].length_before(e.a.from, e.a.to),
                   b = layouts[e.b.layout].length_before(e.b.from, e.b.to);
      const double a_now = layouts[e.a.layout].length_now(e.a.from, e.a.to),
                   b_now = layouts[e.b.layout].length_now(e.b.from, e.b.to);
      apart = std::max(apart, std::abs(a_now * b / a - b_now));
      const auto towards = [&](const SeamEdge::Side& s) {
        return Eigen::RowVector2d(layouts[s.layout].solved.row(s.to) -
                                  layouts[s.layout].solved.row(s.from) + s.dual);
      };
      const Eigen::RowVector2d to_a = towards(e.a), to_b = towards(e.b);
      const double stretch = (a * to_a.norm() + b * to_b.norm()) / (a * a + b * b);
      const auto pull = [&](SeamEdge::Side& s, const Eigen::RowVector2d& to, double length) {
        const PanelLayout& layout = layouts[s.layout];
        Eigen::RowVector2d along = to / std::max(to.norm(), 1e-9);
        if (e.keeps_direction) {
          const Eigen::RowVector2d line =
              (layout.flat[s.to] - layout.flat[s.from]).head<2>().transpose().normalized();
          along = ((1 - STRAIGHTENING) * along + STRAIGHTENING * line).normalized();
        }
        const Eigen::RowVector2d wanted = stretch * length * along;
        s.dual = to - wanted;
        const Eigen::RowVector2d force = SEAM_STIFFNESS * (wanted - s.dual);
        layouts[s.layout].seams.row(s.to) += force;
        layouts[s.layout].seams.row(s.from) -= force;
      };
      pull(e.a, to_a, a);
      pull(e.b, to_b, b);
    }
    for (PanelLayout& layout : layouts)
      largest_move = std::max(largest_move, lay_out(layout));
    if (apart < SEAM_EDGE && largest_move < LAYOUT_MOVE)
      return;
  }
}

/// The mirror images of panels that are graded alike, by layout, partners as layouts too.
std::vector<PanelMirror> mirrors_of(const Garment& garment, const std::vector<PanelLayout>& layouts,
                                    const std::vector<Vec3>& before, const GradeSides& sides) {
  std::vector<Vec3> position;
  for (const int p : garment.particle_of)
    position.push_back(before[p]);
  const std::vector<PanelMirror> by_panel = panel_mirrors(garment.panels, position);
  std::map<int, int> layout_of_panel;
  const auto index = [&](const PanelLayout& layout) {
    return static_cast<int>(layout.panel - garment.panels.panels.data());
  };
  for (std::size_t k = 0; k < layouts.size(); ++k)
    layout_of_panel[index(layouts[k])] = static_cast<int>(k);
  std::vector<PanelMirror> mirrors;
  for (const PanelLayout& layout : layouts) {
    PanelMirror mirror = by_panel[index(layout)];
    const auto partner = layout_of_panel.find(mirror.partner);
    mirror.partner =
        partner == layout_of_panel.end() || sides.apart.count(limb_of(garment, *layout.panel))
            ? -1
            : partner->second;
    mirrors.push_back(mirror);
  }
  return mirrors;
}

/// Half of what a panel's own vertices have and half of what its mirror image has there.
/// @param own  of a layout   @param turned  a value of the mirror image as the panel itself would
/// have it
template<class Own, class Turned>
std::vector<Eigen::MatrixX2d>
averaged(const Garment& garment, const std::vector<PanelLayout>& layouts,
         const std::vector<PanelMirror>& mirrors, Own&& own, Turned&& turned) {
  std::vector<Eigen::MatrixX2d> result;
  for (std::size_t k = 0; k < layouts.size(); ++k) {
    result.push_back(own(layouts[k]));
    if (mirrors[k].partner < 0)
      continue;
    const PanelLayout& partner = layouts[mirrors[k].partner];
    Eigen::MatrixX2d seen = seen_from_mirror(garment.panels, *partner.panel, *layouts[k].panel,
                                             mirrors[k], own(partner));
    turned(mirrors[k], seen);
    result.back() = 0.5 * (result.back() + seen);
  }
  return result;
}

/// Notes the seams' new lengths, and tells of those whose sides no longer match as they did.
void measure_seams(Garment& garment, const std::vector<std::array<double, 2>>& before,
                   GradeReport& report) {
  for (std::size_t s = 0; s < garment.panels.seams.size(); ++s) {
    pattern::MeshSeam& seam = garment.panels.seams[s];
    seam.length_a = run_length(garment, seam.a);
    seam.length_b = run_length(garment, seam.b);
    if (!(before[s][0] > 0 && before[s][1] > 0))
      continue;
    const double apart = std::abs(seam.length_a - seam.length_b * before[s][0] / before[s][1]);
    report.largest_seam_change_m = std::max(report.largest_seam_change_m, apart);
    if (apart <= SEAM_FINDING)
      continue;
    char length[32];
    std::snprintf(length, sizeof length, "%.1f", 1000 * apart);
    report.findings.push_back({"retarget.seam-fits-worse"_id, "the sides of seam \"" + seam.name +
                                                                  "\" fit each other " + length +
                                                                  " mm worse than before grading"});
  }
}

} // namespace

std::string limb_of(const Garment& garment, const pattern::PanelInfo& panel) {
  std::map<std::string, double> share;
  for (int v = panel.first_vertex;
       v < panel.first_vertex + panel.n_vertices && !garment.bind.empty(); ++v)
    for (const BindWeight& w : garment.bind.particles[garment.particle_of[v]]) {
      const std::string& frame = garment.bind.frames[w.frame];
      std::string part = frame.rfind("leg_", 0) == 0 ? "leg" : "torso";
      if (frame.find("arm_") != std::string::npos)
        part = "arm";
      share[part] += w.weight;
    }
  const auto most = std::max_element(
      share.begin(), share.end(), [](const auto& a, const auto& b) { return a.second < b.second; });
  return most == share.end() ? "torso" : most->first;
}

GradeReport regrade(Garment& garment, const std::vector<Vec3>& before,
                    const std::vector<Vec3>& after, const GradeSides& sides,
                    const std::vector<Vec2>& widen_strained_pieces) {
  GradeReport report;
  std::vector<PanelLayout> layouts;
  std::vector<int> layout_of_vertex(garment.panels.pattern.size(), -1);
  for (const pattern::PanelInfo& panel : garment.panels.panels) {
    if (panel.n_vertices == 0 || panel.n_triangles == 0)
      continue;
    for (int i = 0; i < panel.n_vertices; ++i)
      layout_of_vertex[panel.first_vertex + i] = static_cast<int>(layouts.size());
    layouts.push_back(stretched_panel(garment, panel, before, after, widen_strained_pieces));
  }
  const std::vector<PanelMirror> mirrors = mirrors_of(garment, layouts, before, sides);
  for (const PanelMirror& mirror : mirrors)
    report.mirrored_panels += mirror.partner >= 0;
  const std::vector<Eigen::MatrixX2d> stretch = averaged(
      garment, layouts, mirrors, [](const PanelLayout& layout) { return layout.log_stretch; },
      [](const PanelMirror& mirror, Eigen::MatrixX2d& seen) {
        if (mirror.grain_across)
          seen.col(0).swap(seen.col(1));
      });
  for (std::size_t k = 0; k < layouts.size(); ++k) {
    layouts[k].log_stretch = stretch[k];
    start_layout(layouts[k]);
  }
  std::vector<SeamEdge> edges = seam_edges(garment, layout_of_vertex, layouts, mirrors);
  lay_out_together(layouts, edges);

  // Averages out the residual, far below a millimetre, of left and right meshes that are not exact
  // mirror images.
  const std::vector<Eigen::MatrixX2d> moved = averaged(
      garment, layouts, mirrors,
      [](const PanelLayout& layout) {
        Eigen::MatrixX2d move(layout.panel->n_vertices, 2);
        for (int i = 0; i < move.rows(); ++i)
          move.row(i) = (layout.to_grain.transpose() *
                         (layout.solved.row(i).transpose() - Vec2(layout.flat[i].head<2>())))
                            .transpose();
        return move;
      },
      [](const PanelMirror& mirror, Eigen::MatrixX2d& seen) {
        seen = Eigen::MatrixX2d(seen * mirror.linear);
      });
  std::vector<std::array<double, 2>> lengths;
  for (const pattern::MeshSeam& seam : garment.panels.seams)
    lengths.push_back({run_length(garment, seam.a), run_length(garment, seam.b)});
  for (std::size_t k = 0; k < layouts.size(); ++k) {
    const Eigen::RowVector2d shift = moved[k].colwise().mean(); // the panel keeps its centroid
    for (int i = 0; i < layouts[k].panel->n_vertices; ++i)
      garment.panels.pattern[layouts[k].panel->first_vertex + i] +=
          (moved[k].row(i) - shift).transpose();
  }
  for (const auto& [limb, why] : sides.apart)
    if (std::any_of(garment.panels.panels.begin(), garment.panels.panels.end(),
                    [&, limb = limb](const auto& panel) {
                      return limb_of(garment, panel) == limb;
                    })) // clang 14 captures no structured binding
      report.findings.push_back(
          {"retarget.sides-apart"_id,
           why + ": more than is graded alike, so left and right are graded apart"});
  measure_seams(garment, lengths, report);
  return report;
}

} // namespace sloper::garment
