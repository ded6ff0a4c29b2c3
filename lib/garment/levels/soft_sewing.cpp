#include <garment/levels/soft_sewing.hpp>
#include <sloper/base/units.hpp>
#include <sloper/cloth/bending_plates.hpp>
#include <sloper/cloth/contact/soft_body_contact.hpp>
#include <sloper/cloth/forces/bending.hpp>
#include <sloper/cloth/forces/dihedral_bending.hpp>
#include <sloper/cloth/forces/edge_spring.hpp>
#include <sloper/cloth/forces/gravity.hpp>
#include <sloper/cloth/forces/half_space.hpp>
#include <sloper/cloth/forces/orthotropic_bending.hpp>
#include <sloper/cloth/forces/sewing_spring.hpp>
#include <sloper/cloth/forces/shear.hpp>
#include <sloper/cloth/solver/implicit_step.hpp>
#include <sloper/garment/sewing.hpp>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace sloper::garment {

namespace {

// All steps are counted: nothing here depends on how far the cloth has come. Chosen on three
// garments (T-shirt, long sleeves, trousers).
constexpr int SEWING_STEPS = 60;
constexpr double SOFT_STEP_S = 0.1; // of the overdamped flow
constexpr double SOFT_MOVE = 0.02;  // m, of the fastest particle in a step
constexpr double BOARD = 1000; // times the fabric's bending, while seams close; with 100 panels
                               // buckle: spread of 24 mm in place of none
/// Cloth that was placed in folds is so much stiffer about its shape to the end: without self
/// contact softer folds sink into each other.
constexpr double FOLDED_BENDING = 10;
constexpr double FIRST_PULL = 10; // of a stitch at its reach, in weights of a particle
constexpr double LAST_PULL = 20;  // N, of a stitch at its reach
constexpr int PULL_GROWS_FROM = 15, PULL_GROWS_TO = 50;
constexpr double STITCH_REACH = 0.05; // m: the pull does not grow beyond this gap
constexpr double DRAWN_IN = 0.35; // of the body's thickness, until the panels are around it; with
                                  // 0.7 sleeves met hands on their way: spread of 5 mm in 5 starts
constexpr int INFLATE_FROM = 30, INFLATE_TO = 45;
constexpr double SEWING_REACH = 0.012;   // m: a chord of 48 mm lies 6 mm below an arm's skin
constexpr double SEWING_STIFFNESS = 5e5; // N/m3
constexpr double SEWING_CREEP =
    0.1; // of it, along the skin: without, a skirt as wide as the hip slides up to the waist
constexpr double RELAXING_STIFFNESS = 3e5; // N/m3
constexpr double CREEP = 0.5;              // of it, along the skin
constexpr double SEWING_TOLERANCE =
    1e-4; // relative residual; 1e-3 left 11 mm of spread once, exact solves gain nothing more
constexpr double SIDE_STIFFNESS = 200; // N/m of a particle
constexpr double SIDE_GAP = 0.004;     // m: how far legs are kept from the middle
constexpr double LONG_EDGE = 0.024;    // m: with shorter ones contact on particles alone will do

double share_of_way(int k, int from, int to) {
  return std::clamp(static_cast<double>(k - from) / (to - from), 0.0, 1.0);
}

double mean_weight(const cloth::ClothMesh& mesh) {
  return std::accumulate(mesh.mass.begin(), mesh.mass.end(), 0.0) * units::GRAVITY /
         static_cast<double>(mesh.n_particles);
}

/// Of a part such as "leg_l": 1 left, 2 right; 0 of parts other than this limb.
char side_of(const std::string& part, const std::string& limb) {
  if (part == limb + "_l")
    return 1;
  return part == limb + "_r" ? 2 : 0;
}

/// Of a garment that was worn: the leg that holds most of a particle, as leg_sides().
std::vector<char> leg_sides_of(const Bind& bind) {
  std::vector<char> side(bind.particles.size(), 0);
  for (std::size_t i = 0; i < side.size(); ++i)
    for (const BindWeight& w : bind.particles[i])
      if (w.weight > 0.5)
        side[i] = side_of(bind.frames[w.frame], "leg");
  return side;
}

/// Which trouser leg each particle belongs to: 1 left, 2 right, 0 none, and none where both are
/// joined.
std::vector<char> leg_sides(const Garment& garment) {
  if (!garment.bind.empty())
    return leg_sides_of(garment.bind);
  std::vector<char> side(garment.position.size(), 0), joins(garment.position.size(), 0);
  for (const pattern::PanelInfo& p : garment.panels.panels) {
    const char now = side_of(p.part, "leg");
    for (int v = p.first_vertex; now && v < p.first_vertex + p.n_vertices; ++v) {
      const auto i = static_cast<std::size_t>(garment.particle_of[v]);
      joins[i] = static_cast<char>(joins[i] || (side[i] && side[i] != now));
      side[i] = now;
    }
  }
  for (const auto& [a, b] : open_stitches(garment))
    if (side[a] != side[b])
      joins[a] = joins[b] = 1;
  for (std::size_t i = 0; i < side.size(); ++i)
    if (joins[i])
      side[i] = 0;
  return side;
}

/// The stitches by which sleeves and cuffs close around an arm.
std::vector<std::array<int, 2>> sleeve_stitches(const Garment& garment) {
  std::vector<char> arm(garment.position.size(), 0);
  for (const pattern::PanelInfo& p : garment.panels.panels) {
    const char now = side_of(p.part, "arm");
    for (int v = p.first_vertex; v < p.first_vertex + p.n_vertices; ++v)
      arm[garment.particle_of[v]] = now;
  }
  std::vector<std::array<int, 2>> stitches;
  for (const std::array<int, 2>& stitch : open_stitches(garment)) {
    const char a = arm[stitch[0]], b = arm[stitch[1]];
    if (a != 0 && a == b)
      stitches.push_back(stitch);
  }
  return stitches;
}

/// By particle: whether all of it was placed in folds.
std::vector<char> placed_in_folds(const Garment& garment) {
  std::vector<char> folded(garment.position.size(), 1);
  for (const pattern::PanelInfo& p : garment.panels.panels)
    for (int v = p.first_vertex; v < p.first_vertex + p.n_vertices && !p.in_folds; ++v)
      folded[garment.particle_of[v]] = 0;
  return folded;
}

/// Cloth in the middle of its way, by steps without a line search.
///
/// What makes it stiffer for a while keeps it flat, but for cloth that was placed in folds: unless
/// it is to spring flat, that keeps the shape in which it comes.
class SoftCloth {
public:
  SoftCloth(Garment& garment, CollisionBody& body, double reach, double stiffness, double drag,
            double tolerance, bool springs_flat = false)
      : m_garment(garment), m_start(garment.position), m_mesh(cloth_mesh_of(garment)),
        m_hinges(m_mesh.hinges), m_velocity(garment.position.size(), Vec3::Zero()),
        m_solver(m_mesh, garment.position, m_velocity) {
    m_solver.emplace<cloth::EdgeSpringEffect>(m_mesh);
    m_solver.emplace<cloth::ShearEffect>(m_mesh);
    if (!springs_flat)
      keep_folds();
    add_bending(!springs_flat && !m_folds);
    const cloth::SoftBodyContactOptions contact{.reach_m = reach,
                                                .stiffness_n_m3 = stiffness,
                                                .drag = drag,
                                                .on_edges = garment.panels.edge_length > LONG_EDGE};
    if (body.collider())
      m_contact =
          &m_solver.emplace<cloth::SoftBodyContactEffect>(m_mesh, *body.collider(), contact);
    keep_legs_apart();
    m_options.h = SOFT_STEP_S;
    m_options.cg_tolerance = tolerance;
    m_options.largest_move_m = SOFT_MOVE;
  }
  cloth::ClothSolver& solver() { return m_solver; }
  const cloth::ClothMesh& mesh() const { return m_mesh; }
  cloth::SoftBodyContactEffect* contact() { return m_contact; } ///< null without a body
  bool in_folds() const { return m_folds != nullptr; }
  /// Where it springs flat: stiffer in a region.
  void set_bending(double times, const StiffRegion& stiff) {
    for (std::size_t e = 0; e < m_hinges.size(); ++e) {
      const auto& on = m_hinges[e].particle;
      const bool in = std::any_of(on.begin(), on.end(), [&](int i) { return stiff.particles[i]; });
      m_mesh.hinges[e].stiffness = (in ? stiff.bending : times) * m_hinges[e].stiffness;
    }
  }
  void set_bending(double times) {
    m_mesh.bend_scale = times;
    for (std::size_t e = 0; e < m_hinges.size(); ++e)
      m_mesh.hinges[e].stiffness = (m_folds && m_in_folds[e] ? 1 : times) * m_hinges[e].stiffness;
    if (m_folds)
      m_folds->set_scale(times - 1);
  }
  /// @return false where it is not finite: the garment is as it came
  bool step() {
    m_last = m_solver.step(m_options);
    if (m_last.finite)
      return true;
    m_garment.position = m_start;
    return false;
  }
  const cloth::StepResult& last() const { return m_last; }

private:
  /// Adds what keeps folds, where there are any.
  void keep_folds() {
    const std::vector<char> folded = placed_in_folds(m_garment);
    m_folded_mesh = m_mesh;
    std::vector<double> angle;
    for (cloth::Hinge& hinge : m_folded_mesh.hinges) {
      const bool kept = std::all_of(hinge.particle.begin(), hinge.particle.end(),
                                    [&](int i) { return folded[i] != 0; });
      m_in_folds.push_back(kept);
      angle.push_back(cloth::hinge_angle(hinge, m_start));
      if (!kept)
        hinge.stiffness = hinge.firmness = 0;
    }
    if (std::find(m_in_folds.begin(), m_in_folds.end(), 1) != m_in_folds.end())
      m_folds = &m_solver.emplace<cloth::DihedralBendingEffect>(m_folded_mesh, std::move(angle));
  }
  /// By direction where a fabric does: the finer mesh must not find other folds to rest in.
  void add_bending(bool by_direction) {
    const auto& fabrics = m_mesh.fabrics;
    if (by_direction && std::any_of(fabrics.begin(), fabrics.end(), cloth::bends_by_direction))
      m_solver.emplace<cloth::OrthotropicBendingEffect>(m_mesh);
    else
      m_solver.emplace<cloth::BendingEffect>(m_mesh);
  }
  void keep_legs_apart() {
    const std::vector<char> side = leg_sides(m_garment);
    std::vector<int> left, right;
    for (std::size_t i = 0; i < side.size(); ++i) {
      if (side[i] == 1)
        left.push_back(static_cast<int>(i));
      if (side[i] == 2)
        right.push_back(static_cast<int>(i));
    }
    if (left.empty() || right.empty())
      return;
    const Vec3 to_left = Vec3::UnitX(), offset = SIDE_GAP * to_left;
    m_solver.emplace<cloth::HalfSpaceEffect>(std::move(left), offset, to_left, SIDE_STIFFNESS);
    m_solver.emplace<cloth::HalfSpaceEffect>(std::move(right), -offset, -to_left, SIDE_STIFFNESS);
  }

  Garment& m_garment;
  const std::vector<Vec3> m_start;
  cloth::ClothMesh m_mesh;
  const std::vector<cloth::Hinge> m_hinges;
  cloth::ClothMesh m_folded_mesh; ///< only hinges that keep folds have stiffness
  std::vector<char> m_in_folds;   ///< #hinges: whether it keeps a fold
  std::vector<Vec3> m_velocity;
  cloth::ClothSolver m_solver;
  cloth::DihedralBendingEffect* m_folds = nullptr;
  cloth::SoftBodyContactEffect* m_contact = nullptr;
  cloth::StepOptions m_options;
  cloth::StepResult m_last;
};

} // namespace

SoftSewing sew_softly(Garment& garment, CollisionBody& body, Reporter& reporter) {
  unsew(garment);
  if (body.collider())
    body.draw_in(DRAWN_IN);
  SoftCloth cloth(garment, body, SEWING_REACH, SEWING_STIFFNESS, SEWING_CREEP, SEWING_TOLERANCE);
  auto& stitches =
      cloth.solver().emplace<cloth::SewingSpringEffect>(open_stitches(garment), 1.0, STITCH_REACH);
  // Sleeves close first: a board that closes later stands off as its armhole lets it, and an arm
  // that hangs otherwise, or is bent, leaves it by the open seam (gaps of 16 to 25 mm in 5 of 8).
  cloth.solver().emplace<cloth::SewingSpringEffect>(sleeve_stitches(garment),
                                                    LAST_PULL / STITCH_REACH, STITCH_REACH);
  cloth.set_bending(BOARD);
  const double first_pull = FIRST_PULL * mean_weight(cloth.mesh());
  SoftSewing result;
  for (int k = 0; k < SEWING_STEPS && !reporter.stop_requested(); ++k) {
    reporter.progress("sew", 0.4 * k / SEWING_STEPS);
    const double pull = first_pull * std::pow(LAST_PULL / first_pull,
                                              share_of_way(k, PULL_GROWS_FROM, PULL_GROWS_TO));
    stitches.set_stiffness(pull / STITCH_REACH);
    const double scale = DRAWN_IN + (1 - DRAWN_IN) * share_of_way(k, INFLATE_FROM, INFLATE_TO);
    if (cloth.contact() && scale > body.state().scale) {
      cloth.contact()->body_moved((scale - body.state().scale) * body.reach());
      body.draw_in(scale);
    }
    result.finite = cloth.step();
    if (!result.finite)
      break;
    ++result.steps;
  }
  if (body.collider() && body.state().scale < 1)
    body.draw_in(1);
  result.widest_gap_m = stitches.widest(garment.position).length;
  const std::vector<Vec3> sewn = garment.position;
  weld(garment, sewn);
  return result;
}

SoftRelaxed relax_softly(Garment& garment, CollisionBody& body, const SoftRelaxing& how,
                         double gravity_m_s2, Reporter& reporter) {
  SoftCloth cloth(garment, body, how.reach_m, RELAXING_STIFFNESS, CREEP, how.cg_tolerance);
  cloth.solver().emplace<cloth::GravityEffect>(cloth.mesh(), Vec3(0, -gravity_m_s2, 0));
  const double folded_bending = std::min(how.bending, FOLDED_BENDING);
  for (int k = 0; k < how.steps && !reporter.stop_requested(); ++k) {
    reporter.progress("relax", -1);
    const double bending = std::pow(how.bending, 1 - share_of_way(k, 0, (how.steps + 1) / 2));
    cloth.set_bending(cloth.in_folds() ? std::max(bending, folded_bending) : bending);
    if (cloth.contact())
      cloth.contact()->set_reach(how.reach_m + (how.last_reach_m - how.reach_m) *
                                                   share_of_way(k, 0, how.steps - 1));
    if (!cloth.step())
      return {.finite = false};
  }
  return {.residual_force_ratio = cloth.last().residual_force_ratio};
}

SoftRelaxed spring_softly(Garment& garment, CollisionBody& body, const SoftRelaxing& how,
                          const StiffRegion& stiff, double gravity_m_s2) {
  SoftCloth cloth(garment, body, how.reach_m, RELAXING_STIFFNESS, CREEP, how.cg_tolerance, true);
  cloth.solver().emplace<cloth::GravityEffect>(cloth.mesh(), Vec3(0, -gravity_m_s2, 0));
  cloth.set_bending(how.bending, stiff);
  for (int k = 0; k < how.steps; ++k)
    if (!cloth.step())
      return {.finite = false};
  return {.residual_force_ratio = cloth.last().residual_force_ratio};
}

} // namespace sloper::garment
