#include <base/units.hpp>
#include <cloth/contact/soft_body_contact.hpp>
#include <cloth/forces/bending.hpp>
#include <cloth/forces/edge_spring.hpp>
#include <cloth/forces/gravity.hpp>
#include <cloth/forces/half_space.hpp>
#include <cloth/forces/sewing_spring.hpp>
#include <cloth/forces/shear.hpp>
#include <cloth/linear/factorisation.hpp>
#include <cloth/solver/implicit_step.hpp>
#include <garment/body_model/collision_body.hpp>
#include <garment/levels/coarse_sewing.hpp>
#include <garment/sewing.hpp>

#include <algorithm>
#include <cmath>

namespace sloper::garment {

namespace {


} // namespace

static double lv_env(const char* n, double d) { const char* s = std::getenv(n); return s ? std::atof(s) : d; }
#define P(n, d) const double n = lv_env(#n, d);

static void keep_legs_apart(const Garment& garment, cloth::ClothSolver& solver, double stiffness) {
  std::vector<char> side(garment.position.size(), 0), joined(garment.position.size(), 0);
  for (const pattern::PanelInfo& p : garment.panels.panels)
    for (int v = p.first_vertex; v < p.first_vertex + p.n_vertices; ++v) {
      char& s = side[garment.particle_of[v]];
      const char now = p.part == "leg_l" ? 1 : p.part == "leg_r" ? 2 : 0;
      if (s && now && s != now) joined[garment.particle_of[v]] = 1;
      if (now) s = now;
    }
  for (const auto& [a, b] : open_stitches(garment))
    if (side[a] != side[b]) joined[a] = joined[b] = 1;
  std::vector<int> left, right;
  for (std::size_t i = 0; i < side.size(); ++i)
    if (side[i] && !joined[i]) (side[i] == 1 ? left : right).push_back(static_cast<int>(i));
  if (left.empty() || right.empty()) return;
  solver.emplace<cloth::HalfSpaceEffect>(left, Vec3(0.004, 0, 0), Vec3(1, 0, 0), stiffness);
  solver.emplace<cloth::HalfSpaceEffect>(right, Vec3(-0.004, 0, 0), Vec3(-1, 0, 0), stiffness);
}

CoarseSewing sew_coarsely(Garment& garment, const body::Body* body, const DrapeSettings& settings, Reporter& reporter,
                          const std::function<void(const std::vector<Vec3>&)>& on_step) {
  P(STEPS, 80) P(STEP_S, 0.1) P(MOVE, 0.02) P(BEND, 1000) P(BEND_END, 1000) P(PULL_FIRST, 10) P(PULL_LAST, 20) P(PULL_FROM, 20) P(PULL_TO, 70)
  P(INFLATE_FROM, 40) P(INFLATE_TO, 60) P(SCALE, 0.7) P(REACH, 0.012) P(STIFF, 5e5) P(SEW_PULL_REACH, 0.05) P(SIDE, 200) P(BEND_FROM,70) P(BEND_TO,80) P(TOL, 1e-6) P(EXACT,1)
  unsew(garment);
  CollisionBody met(body, settings.skin_tolerance_m, reporter);
  if (met.has_skin()) {
    met.find_arms_aside(garment);
    met.prepare(met.ends_near(garment.position) | (met.state().arms_aside ? CoveredSkin::HANDS : 0u));
    met.draw_in(SCALE);
  }
  cloth::ClothMesh mesh = cloth_mesh_of(garment);
  const std::vector<cloth::Hinge> hinges = mesh.hinges;
  std::vector<Vec3> velocity(garment.position.size(), Vec3::Zero());
  cloth::ClothSolver solver(mesh, garment.position, velocity);
  if (EXACT) solver.set_preconditioner(std::make_unique<cloth::Factorisation>());
  solver.emplace<cloth::EdgeSpringEffect>(mesh);
  solver.emplace<cloth::ShearEffect>(mesh);
  solver.emplace<cloth::BendingEffect>(mesh);
  auto& sewing = solver.emplace<cloth::SewingSpringEffect>(open_stitches(garment), 1.0, SEW_PULL_REACH);
  cloth::SoftBodyContactEffect* skin = nullptr;
  if (met.has_skin()) skin = &solver.emplace<cloth::SoftBodyContactEffect>(mesh, *met.collider(), cloth::SoftBodyContactOptions{REACH, STIFF, 0.05});
  if (SIDE > 0) keep_legs_apart(garment, solver, SIDE);
  double weight = 0;
  for (double m : mesh.mass) weight += m * units::GRAVITY / mesh.n_particles;
  cloth::StepOptions options;
  options.h = STEP_S;
  options.cg_tolerance = TOL;
  options.largest_move_m = MOVE;
  CoarseSewing result;
  for (int k = 0; k < STEPS; ++k) {
    const auto along = [&](double from, double to) { return std::clamp((k - from) / (to - from), 0.0, 1.0); };
    sewing.set_stiffness(PULL_FIRST * weight * std::pow(PULL_LAST / (PULL_FIRST * weight), along(PULL_FROM, PULL_TO)) / SEW_PULL_REACH);
    const double bend = BEND * std::pow(BEND_END / BEND, along(BEND_FROM, BEND_TO));
    for (std::size_t e = 0; e < hinges.size(); ++e) mesh.hinges[e].stiffness = bend * hinges[e].stiffness;
    if (skin && k > INFLATE_FROM && k <= INFLATE_TO) {
      const double scale = SCALE + (1 - SCALE) * along(INFLATE_FROM, INFLATE_TO);
      skin->body_moved((scale - met.state().scale) * met.reach());
      met.draw_in(scale);
    }
    const auto r = solver.step(options);
    if (on_step) on_step(garment.position);
    ++result.steps;
    if (std::getenv("V") && k % 5 == 4) std::printf("   k %d gap %.1f mm move %.2f mm cg %d\n", k, 1e3 * sewing.widest(garment.position).length, 1e3 * r.largest_move_m, r.cg.iterations);
  }
  const auto widest = sewing.widest(garment.position);
  result.widest_gap_m = widest.length;
  if (std::getenv("V")) std::printf("  widest at %.3f %.3f %.3f; solve %.3f asm %.3f\n", widest.middle.x(), widest.middle.y(), widest.middle.z(), solver.solve_s, solver.assembly_s);
  const std::vector<Vec3> at = garment.position;
  weld(garment, at);
  return result;
}

void relax_softly(Garment& garment, const body::Body* body, const DrapeSettings& settings, int steps, Reporter& reporter) {
  P(RSTEP_S, 0.1) P(RMOVE, 0.02) P(RBEND, 100) P(RBEND_END, 1) P(RREACH, 0.012) P(RSTIFF, 3e5) P(SIDE, 200) P(RTOL, 1e-4) P(RDRAG, 0.5) P(RREACH_END, 0.012) P(LOADAT,0)
  CollisionBody met(body, settings.skin_tolerance_m, reporter);
  if (met.has_skin()) {
    met.find_arms_aside(garment);
    met.prepare(met.ends_near(garment.position) | (met.state().arms_aside ? CoveredSkin::HANDS : 0u));
    met.put_arms_aside();
  }
  cloth::ClothMesh mesh = cloth_mesh_of(garment);
  const std::vector<cloth::Hinge> hinges = mesh.hinges;
  std::vector<Vec3> velocity(garment.position.size(), Vec3::Zero());
  cloth::ClothSolver solver(mesh, garment.position, velocity);
  solver.emplace<cloth::EdgeSpringEffect>(mesh);
  solver.emplace<cloth::ShearEffect>(mesh);
  solver.emplace<cloth::BendingEffect>(mesh);
  cloth::SoftBodyContactEffect* skin = nullptr;
  if (met.has_skin()) skin = &solver.emplace<cloth::SoftBodyContactEffect>(mesh, *met.collider(), cloth::SoftBodyContactOptions{RREACH, RSTIFF, 0.05, RDRAG});
  if (SIDE > 0) keep_legs_apart(garment, solver, SIDE);
  cloth::StepOptions options;
  options.h = RSTEP_S;
  options.cg_tolerance = RTOL;
  options.largest_move_m = RMOVE;
  for (int k = 0; k < steps; ++k) {
    if (k == LOADAT) solver.emplace<cloth::GravityEffect>(mesh, Vec3(0, -settings.gravity_m_s2, 0));
    const double bend = RBEND * std::pow(RBEND_END / RBEND, std::min(1.0, 2.0 * k / steps));
    for (std::size_t e = 0; e < hinges.size(); ++e) mesh.hinges[e].stiffness = bend * hinges[e].stiffness;
    const auto r = solver.step(options);
    if (std::getenv("V") && (k % 5 == 4||k<3)) std::printf("   relax k %d move %.2f mm cg %d residual %.2f max %.1f\n", k, 1e3 * r.largest_move_m, r.cg.iterations, r.residual_force_ratio, r.residual_force_ratio_max);
  }
  if (std::getenv("V")) std::printf("  solve %.3f asm %.3f skin %.3f\n", solver.solve_s, solver.assembly_s, skin?skin->wall_s:0.0);
}

} // namespace sloper::garment
