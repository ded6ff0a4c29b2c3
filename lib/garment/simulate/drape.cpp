#include <base/error.hpp>
#include <base/units.hpp>
#include <cloth/forces/bending.hpp>
#include <cloth/forces/edge_spring.hpp>
#include <cloth/forces/gravity.hpp>
#include <cloth/forces/shear.hpp>
#include <cloth/linear/factorisation.hpp>
#include <garment/materials.hpp>
#include <garment/scene/effects.hpp>
#include <garment/scene/scene_effects.hpp>
#include <garment/sewing.hpp>
#include <garment/simulate/drape_run.hpp>
#include <garment/simulate/sleeve_ends.hpp>
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

} // namespace

std::string place_text(const Vec3& p) {
  char text[64];
  std::snprintf(text, sizeof text, "(%.3f, %.3f, %.3f) m", p.x(), p.y(), p.z());
  return text;
}

std::string millimetres(double m) { return std::to_string(std::lround(m * 1e4) / 10) + "." + std::to_string(std::lround(m * 1e4) % 10) + " mm"; }

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
  const bool searched = m_settling && inertia == 0;
  options.line_search = searched;
  options.h = h;
  options.inertia = inertia;
  options.cg_tolerance = m_sewing ? std::max(SEW_TOLERANCE, m_settings.cg_tolerance) : m_settings.cg_tolerance;
  // Not while it glides: seams just closed and pinched cloth have nearly all the energy, the strain that is to even out has little.
  const bool glides = m_at.phase == DrapePhase::SETTLE && m_at.step < glide();
  if ((searched || m_sewing) && !glides && m_settings.cg_tolerance >= ROUGH) {
    const bool slow = searched && m_at.last.largest_move_m < m_settings.settle_speed_m_s * m_at.last_h;
    options.cg_energy_tolerance = slow ? LEFT_AT_REST : ENERGY_LEFT;
  }
  options.cg_max_iterations = m_settings.cg_max_iterations;
  m_at.last = m_solver->step(options);
  note_solves();
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
    m_body_contact->move_body(skin, m_solver->x());
    if (m_at.farthest >= m_at.latest) m_body_contact->refresh(); // some of it had to go through
    step(1.0 / 30, 0);
    if (!m_stopped && checkpoint()) step(1.0 / 30, 0);
  }
  m_body_contact->move_body(skin_at(1), m_solver->x()); // also when stopped on the way
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

void DrapeRun::add_load() {
  if (m_loaded) return;
  m_loaded = true;
  if (active("gravity")) m_solver->emplace<cloth::GravityEffect>(*m_cloth, Vec3(0, -m_settings.gravity_m_s2, 0));
  const Material& material = material_of(m_garment, "");
  if (active("friction") && m_body_contact) m_body_contact->set_friction(material.friction_body);
  if (active("friction") && m_self_contact) m_self_contact->set_friction(material.friction_self);
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
