#include <base/error.hpp>
#include <base/units.hpp>
#include <cloth/bending.hpp>
#include <cloth/edge_spring.hpp>
#include <cloth/factorisation.hpp>
#include <cloth/gravity.hpp>
#include <cloth/shear.hpp>
#include <garment/drape_run.hpp>
#include <garment/effects.hpp>
#include <garment/materials.hpp>
#include <garment/scene_effects.hpp>
#include <garment/sewing.hpp>
#include <garment/sleeve_ends.hpp>
#include <io/json.hpp>

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace sloper::garment {

namespace {

constexpr double SEW_SEARCH = 0.75;      // of the mesh edge: cloth nearer than this is watched while sewing
constexpr double ENERGY_LEFT = 0.15;     // of a solve's error in the energy norm; 0.03 to 0.1 and 0.3 took as long or longer over seven garments
constexpr double LEFT_AT_REST = 0.025;   // likewise, where all is as slow as at rest: what is slack and still on its way has little of the energy
constexpr double ROUGH = 0.01;           // relative residual; who asks for less means it
constexpr double SEW_TOLERANCE = 0.05;   // relative residual of a step: only where the panels end up counts
constexpr double SEW_BENDING = 30;       // times that of the fabric
constexpr double INFLATE_MOTION = 0.002; // m: how far the skin moves per step while the body is inflated
constexpr double LATEST = 0.01;          // m: how far skin may stay back where cloth is in its way
constexpr int LATE_STEPS = 40;           // in which what stayed back comes home
constexpr int GLIDE_STEPS = 40;          // after sewing, free of weight and friction, which would keep the strain that sewing left
constexpr int STALLED_STEPS = 400;       // without a residual that is a tenth less, and more than the weight: it will not come to rest
constexpr int UNMOVED_STEPS = 25;        // one after the other in which nothing can move at all
constexpr int MOST_UNTANGLINGS = 8;      // of cloth that crosses itself, half of them before it is at rest
constexpr int PART_EVERY = 40;           // steps between looks whether cloth still crosses itself or a few faces are still through the skin
constexpr int JUDGE_EVERY = 10;          // steps between looks whether the garment can still fit
constexpr double SUNK = 2e-4;            // m that all cloth together may sink, when what was kept in place is let go, and be at rest
constexpr double NEAR_RESIDUAL = 1;      // weights: below, steps may grow faster
constexpr double HUNG_SPEED = 0.02;      // m/s: slower, a skirt hangs, and arms that were held up can come down beside it
constexpr double HUNG_RESIDUAL = 10;     // weights: likewise
constexpr double LARGEST_STEP_S = 0.2;   // s, while settling

} // namespace

std::string place_text(const Vec3& p) {
  char text[64];
  std::snprintf(text, sizeof text, "(%.3f, %.3f, %.3f) m", p.x(), p.y(), p.z());
  return text;
}

void DrapeRun::add_phase_time(const char* name, double wall_s) {
  auto& phases = m_report.phases;
  const auto same = std::find_if(phases.begin(), phases.end(), [&](const auto& p) { return p.first == name; });
  if (same == phases.end()) phases.emplace_back(name, wall_s);
  else same->second += wall_s; // a run that goes on from a checkpoint
}

DrapeRun::DrapeRun(Garment& garment, const body::Body* body, const DrapeSettings& settings, Reporter& reporter, const FitBounds& bounds)
    : m_garment(garment), m_body(body), m_settings(settings), m_bounds(bounds), m_reporter(reporter), m_start(std::chrono::steady_clock::now()) {
  m_report.settings = settings;
  if (garment.panels.triangles.empty()) throw input_error("", "", "the garment has no triangles", "mesh a pattern with pattern-mesh first");
  check_garment(garment);
}

double DrapeRun::elapsed() const { return m_elapsed_before + std::chrono::duration<double>(std::chrono::steady_clock::now() - m_start).count(); }

double DrapeRun::mean_edge() const {
  double sum = 0;
  for (const cloth::EdgeSpring& s : m_cloth->springs) sum += s.rest_length;
  return sum / static_cast<double>(m_cloth->springs.size());
}

void DrapeRun::activate(const char* effect, const char* why) {
  for (EffectReport& e : m_report.effects)
    if (e.name == effect) e.active = true, e.why = why;
}

bool DrapeRun::active(const char* effect) const { return is_active(m_report.effects, effect); }

void DrapeRun::build_solver(bool open_seams) {
  if (m_solver) report_effects();
  m_cloth = std::make_unique<cloth::ClothMesh>(cloth_mesh_of(m_garment));
  m_solver = std::make_unique<cloth::ClothSolver>(*m_cloth, m_garment.position);
  if (m_settings.solver == 1) m_solver->set_preconditioner(std::make_unique<cloth::BlockJacobi>());
  if (m_settings.solver == 2) m_solver->set_preconditioner(std::make_unique<cloth::Factorisation>());
  m_loaded = false;
  if (!active("damping"))
    for (cloth::EdgeSpring& s : m_cloth->springs) s.damping_s = 0;
  if (!active("damping"))
    for (cloth::Fabric& f : m_cloth->fabrics) f.damping_s = 0;
  if (open_seams)
    for (cloth::Hinge& hinge : m_cloth->hinges) hinge.stiffness *= SEW_BENDING; // panels travel as boards and do not crumple
  if (active("edge_springs")) m_solver->emplace<cloth::EdgeSpringEffect>(*m_cloth);
  if (active("shear")) m_solver->emplace<cloth::ShearEffect>(*m_cloth);
  if (active("bending")) m_solver->emplace<cloth::BendingEffect>(*m_cloth);
  add_scene_effects(*m_solver, *m_cloth, m_garment, m_body, m_report.effects, open_seams);
  m_breath = m_hold = nullptr;
  m_sewing = nullptr;
  if (open_seams) m_sewing = &m_solver->emplace<cloth::SewingSpringEffect>(open_stitches(m_garment), 1.0, SEW_REACH);
  m_body_contact = nullptr;
  if (m_collider && active("body_contact")) {
    cloth::BodyContactOptions options;
    options.gap_m = m_settings.contact_gap_m;
    options.level = static_cast<cloth::ContactLevel>(m_settings.contact_level);
    m_body_contact = &m_solver->emplace<cloth::BodyContactEffect>(*m_cloth, *m_collider, options);
  }
  cloth::SelfContactOptions options;
  options.thickness_m = m_settings.self_thickness_m;
  if (open_seams) options.search_m = SEW_SEARCH * mean_edge();
  m_self_contact = nullptr;
  if (active("self_contact"))
    m_self_contact = &m_solver->emplace<cloth::SelfContactEffect>(*m_cloth, options, open_seams ? seam_classes(m_garment) : std::vector<int>{});
}

bool DrapeRun::step(double h, double inertia, double largest_move_m) {
  cloth::StepOptions options;
  options.largest_move_m = largest_move_m;
  options.line_search = m_settling;
  options.h = h;
  options.inertia = inertia;
  options.cg_tolerance = m_sewing ? std::max(SEW_TOLERANCE, m_settings.cg_tolerance) : m_settings.cg_tolerance;
  // Not while it glides: seams just closed and pinched cloth have nearly all the energy, the strain that is to even out has little.
  const bool glides = m_at.phase == DrapePhase::SETTLE && m_at.step < glide();
  if ((m_settling || m_sewing) && !glides && m_settings.cg_tolerance >= ROUGH) {
    const bool slow = m_settling && m_at.last.largest_move_m < m_settings.settle_speed_m_s * m_at.last_h;
    options.cg_energy_tolerance = slow ? LEFT_AT_REST : ENERGY_LEFT;
  }
  options.cg_max_iterations = m_settings.cg_max_iterations;
  m_at.last = m_solver->step(options);
  m_at.cg_iterations.push_back(m_at.last.cg.iterations);
  ++m_report.steps;
  m_report.simulated_s += h;
  m_at.last_h = h;
  if (!m_at.last.finite) {
    m_at.rejected.push_back("step " + std::to_string(m_report.steps) + ": not finite, undone");
    m_solver->stop();
    m_stopped = true;
    m_report.stop_reason = "diverged";
    return false;
  }
  if (m_settings.max_seconds > 0 && elapsed() > m_settings.max_seconds) {
    m_stopped = true;
    m_report.stop_reason = "time limit";
  } else if (m_reporter.stop_requested()) {
    m_stopped = true;
    m_report.stop_reason = "stopped by the user";
  } else if (m_report.steps >= m_settings.max_steps) {
    m_stopped = true;
    m_report.stop_reason = "step limit";
  }
  return !m_stopped;
}

std::string DrapeRun::crossing_text() const {
  if (!m_body_contact || m_body_contact->n_crossing() == 0) return "";
  return ", " + std::to_string(m_body_contact->n_crossing()) + " faces through the skin, one at " + place_text(m_body_contact->crossing_place());
}

/// The skin comes back to its place, if it can at no time through cloth that is clear of it: each vertex goes at most half of its way
/// to the cloth, then the cloth makes room. Where the cloth is slow to do so the skin waits, but not farther back than LATEST, and less
/// and less far once the rest of the body is back; then it goes through, and pushes.
void DrapeRun::inflate() {
  const bool goes_on = m_at.phase == DrapePhase::INFLATE;
  if ((m_at.scale >= 1 && !goes_on) || !m_body_contact) return;
  const Phase phase(*this, "inflate body");
  const double step_scale = INFLATE_MOTION / m_shrink->reach();
  std::vector<Vec3> skin = m_collider->mesh().positions;
  if (!goes_on) {
    m_at.phase = DrapePhase::INFLATE;
    m_at.latest = LATEST;
    m_at.farthest = 0;
  }
  step(1.0 / 30, 0); // contact knows how far skin may move from its last step
  while (!m_stopped && (m_at.scale < 1 || m_at.farthest > 0)) {
    if (m_at.scale < 1) m_at.scale = std::min(1.0, m_at.scale + step_scale);
    else m_at.latest = std::max(0.0, m_at.latest - LATEST / LATE_STEPS);
    const std::vector<Vec3> target = skin_at(m_at.scale);
    const std::vector<double> room = m_body_contact->skin_room(m_solver->x());
    m_at.farthest = 0;
    for (std::size_t v = 0; v < skin.size(); ++v) {
      const Vec3 way = target[v] - skin[v];
      const double length = way.norm(), late = std::min(length - room[v], m_at.latest);
      if (late > 0) {
        skin[v] = target[v] - late / length * way;
        m_at.farthest = std::max(m_at.farthest, late);
      } else {
        skin[v] = target[v];
      }
    }
    m_body_contact->move_body(skin);
    if (m_at.farthest >= m_at.latest) m_body_contact->refresh(); // some of it had to go through
    step(1.0 / 30, 0);
    if (!m_stopped && checkpoint()) step(1.0 / 30, 0);
  }
  m_body_contact->move_body(skin_at(1)); // also when stopped on the way
  m_body_contact->refresh();
}

void DrapeRun::hold_sleeves() {
  std::vector<cloth::Pin> pins;
  if (!m_at.held.empty()) pins = hold_sleeve_ends(m_garment);
  if (pins.empty() || pins.size() != m_at.held.size()) return;
  for (std::size_t k = 0; k < pins.size(); ++k) pins[k].target = m_at.held[k];
  if (!active("pins")) activate("pins", "sleeve ends are held at the wrists until the cloth above has found its folds");
  m_hold = &m_solver->emplace<cloth::PinsEffect>(std::move(pins));
}

void DrapeRun::let_sleeves_go() {
  take_back(m_hold);
  m_at.held.clear();
}

int DrapeRun::glide() const { return m_at.disturbed ? GLIDE_STEPS : 0; }

void DrapeRun::add_load() {
  if (m_loaded) return;
  m_loaded = true;
  if (active("gravity")) m_solver->emplace<cloth::GravityEffect>(*m_cloth, Vec3(0, -m_settings.gravity_m_s2, 0));
  const Material& material = material_of(m_garment, "");
  if (active("friction") && m_body_contact) m_body_contact->set_friction(material.friction_body);
  if (active("friction") && m_self_contact) m_self_contact->set_friction(material.friction_self);
}

/// Particles that a line search keeps in place for a while may be nails that a skirt hangs by. So rest counts once letting them go moves nothing.
bool DrapeRun::thaw() {
  double height = 0;
  for (const Vec3& p : m_solver->x()) height += p.y() / static_cast<double>(m_solver->x().size());
  if (m_at.thawed_at && std::abs(height - *m_at.thawed_at) < SUNK) return false;
  m_at.thawed_at = height;
  return m_solver->thaw();
}

void DrapeRun::settle() {
  const Phase phase(*this, "settle");
  m_settling = true;
  if (m_at.phase != DrapePhase::SETTLE) {
    m_at.phase = DrapePhase::SETTLE;
    m_at.step = 0;
    m_at.h = m_settings.time_step_s;
    m_at.thawed_at.reset();
    m_at.start_height.clear();
    for (const Vec3& p : m_solver->x()) m_at.start_height.push_back(p.y());
  }
  int &k = m_at.step, &calm = m_at.calm;
  double &h = m_at.h, &best = m_at.best;
  for (; !m_stopped; ++k) {
    checkpoint();
    if (k < glide()) breathe();
    if (k == glide()) {
      stop_breathing();
      close_tucks();
      let_sleeves_go();
      add_load();
      h = m_settings.time_step_s;
    }
    if (!step(h, 0)) break;
    const double speed = m_at.last.largest_move_m / h, residual = m_at.last.residual_force_ratio;
    if (k % 20 == 0)
      m_reporter.info("settle step " + std::to_string(k) + ": h " + std::to_string(h) + " s, speed " + std::to_string(speed) + " m/s, residual force " +
                      std::to_string(residual) + " of the weight, at most " + std::to_string(m_at.last.residual_force_ratio_max) + crossing_text());
    m_reporter.progress("settle", -1);
    if (m_at.last.halvings > 0) h = std::max(h * 0.7, m_settings.time_step_s);
    else if (m_at.last.largest_move_m < 0.003) h = std::min(h * (residual > NEAR_RESIDUAL ? 1.15 : 1.3), LARGEST_STEP_S);
    else if (m_at.last.largest_move_m > 0.01) h = std::max(h * 0.8, m_settings.time_step_s);
    if (k <= glide() || residual < 0.9 * best) {
      best = residual;
      m_at.best_at = k;
    } else if (best > 1 && k > m_at.best_at + STALLED_STEPS) {
      m_stopped = true;
      m_report.stop_reason = "no nearer to rest in " + std::to_string(STALLED_STEPS) + " steps";
      break;
    }
    m_at.unmoved = m_at.last.largest_move_m > 0 ? 0 : m_at.unmoved + 1;
    const bool stuck = m_at.unmoved >= UNMOVED_STEPS && residual >= m_settings.settle_force_ratio;
    if ((stuck || (k > glide() && k % PART_EVERY == 0)) && part_the_few()) {
      h = m_settings.time_step_s;
      calm = m_at.unmoved = 0;
      m_at.best_at = k;
      continue;
    }
    if (stuck) {
      m_stopped = true;
      m_report.stop_reason = "stuck: nothing could move in " + std::to_string(UNMOVED_STEPS) + " steps";
      break;
    }
    if (k > glide() && k % PART_EVERY == 0 && m_self_contact && !m_self_contact->crossings().empty() && m_at.untanglings < MOST_UNTANGLINGS / 2) untangle_now();
    if (k > glide() && k % JUDGE_EVERY == 0) judge_fit();
    const bool still = speed < m_settings.settle_speed_m_s && residual < m_settings.settle_force_ratio;
    calm = still && k >= glide() ? calm + 1 : 0;
    if (m_at.arms_aside && k > glide() && speed < HUNG_SPEED && residual < HUNG_RESIDUAL) {
      let_arms_hang();
      h = m_settings.time_step_s;
      calm = 0;
      continue;
    }
    if (calm < 3) continue;
    if (thaw()) {
      calm = 0;
      continue;
    }
    if (m_body_contact && m_body_contact->n_crossing() > 0 && ++m_at.pushed < MOST_PUSH_STEPS) continue; // what is through the skin is pushed harder each step
    if (m_coarse) {
      m_reporter.info("at rest on the coarser skin after " + std::to_string(k) + " steps, on to the whole one");
      leave_coarse_skin();
      calm = 0;
      continue;
    }
    if (m_at.untanglings < MOST_UNTANGLINGS && m_self_contact && !m_self_contact->find_crossings(m_solver->x()).empty()) {
      untangle_now();
      calm = 0;
      continue;
    }
    m_report.converged = true;
    m_report.stop_reason = "at rest";
    break;
  }
  if (m_at.arms_aside) let_arms_hang(); // stopped before
}

DrapeReport DrapeRun::run() {
  if (m_at.phase == DrapePhase::START) {
    const bool unsewn = m_garment.particle_of.empty();
    if (unsewn) unsew(m_garment);
    m_report.effects = choose_effects(m_garment, m_body, m_settings);
    if (m_moves) activate("body_motion", "the body moves");
    start_outside_body(unsewn);
    m_at.disturbed = unsewn || m_at.scale < 1 || m_settings.hold_sleeve_ends || m_settings.glides_first;
    if (!unsewn && m_at.disturbed && may_pass("pins"))
      for (const cloth::Pin& pin : hold_sleeve_ends(m_garment)) m_at.held.push_back(pin.target);
    if (unsewn && active("sewing")) sew();
  } else if (m_at.phase == DrapePhase::SEW) {
    sew();
  }
  if (!m_stopped) {
    if (m_at.phase == DrapePhase::START || m_at.phase == DrapePhase::SEW) {
      untangle();
      build_solver(false);
      hold_sleeves();
      let_tucks_pass();
    }
    if (m_at.phase != DrapePhase::SETTLE && m_at.phase != DrapePhase::MOVE) inflate();
    if (m_at.phase != DrapePhase::MOVE) settle();
    if (m_moves && !m_at.motion.over) follow_motion();
  }
  finish();
  m_report.wall_s = elapsed();
  return std::move(m_report);
}

DrapeReport drape(Garment& garment, const body::Body* body, const DrapeSettings& settings, Reporter& reporter, const FitBounds& bounds,
                  const Checkpoints& checkpoints) {
  DrapeRun run(garment, body, settings, reporter, bounds);
  run.set_checkpoints(checkpoints);
  return run.run();
}

} // namespace sloper::garment
