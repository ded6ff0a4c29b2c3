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
#include <garment/simulate/simulated_cloth.hpp>

#include <numeric>

namespace sloper::garment {

namespace {

constexpr double SEW_SEARCH = 0.75; // of the mesh edge: cloth nearer than this is watched while sewing
constexpr double SEW_BENDING = 30;  // times that of the fabric: panels travel as boards and do not crumple

} // namespace

SimulatedCloth::SimulatedCloth(Garment& garment, const DrapeSettings& settings, CollisionBody& body, Telemetry& telemetry)
    : m_garment(garment), m_settings(settings), m_body(body), m_telemetry(telemetry) {
  if (garment.panels.triangles.empty()) throw input_error("", "", "the garment has no triangles", "mesh a pattern with pattern-mesh first");
  check_garment(garment);
}

void SimulatedCloth::choose_effects() { m_telemetry.report.effects = garment::choose_effects(m_garment, m_body.body(), m_settings); }

void SimulatedCloth::remove_damping() {
  for (cloth::EdgeSpring& s : m_mesh->springs) s.damping_s = 0;
  for (cloth::Fabric& f : m_mesh->fabrics) f.damping_s = 0;
}

void SimulatedCloth::build(bool open_seams, bool keep_velocity) {
  tear_down();
  m_open_seams = open_seams;
  if (!keep_velocity) m_velocity.assign(m_garment.position.size(), Vec3::Zero());
  m_mesh = std::make_unique<cloth::ClothMesh>(cloth_mesh_of(m_garment));
  m_solver = std::make_unique<cloth::ClothSolver>(*m_mesh, m_garment.position, m_velocity);
  if (m_settings.solver == 1) m_solver->set_preconditioner(std::make_unique<cloth::BlockJacobi>());
  if (m_settings.solver == 2) m_solver->set_preconditioner(std::make_unique<cloth::Factorisation>());
  m_loaded = false;
  if (!is_active("damping")) remove_damping();
  if (open_seams)
    for (cloth::Hinge& hinge : m_mesh->hinges) hinge.stiffness *= SEW_BENDING;
  if (is_active("edge_springs")) m_solver->emplace<cloth::EdgeSpringEffect>(*m_mesh);
  if (is_active("shear")) m_solver->emplace<cloth::ShearEffect>(*m_mesh);
  if (is_active("bending")) m_solver->emplace<cloth::BendingEffect>(*m_mesh);
  add_scene_effects(*m_solver, *m_mesh, m_garment, m_body.body(), m_telemetry.report.effects, open_seams);
  if (open_seams) m_sewing = &m_solver->emplace<cloth::SewingSpringEffect>(open_stitches(m_garment), 1.0, SEW_REACH);
  if (m_body.collider() && is_active("body_contact")) {
    cloth::BodyContactOptions options;
    options.gap_m = m_settings.contact_gap_m;
    options.level = static_cast<cloth::ContactLevel>(m_settings.contact_level);
    m_body_contact = &m_solver->emplace<cloth::BodyContactEffect>(*m_mesh, *m_body.collider(), options);
  }
  if (is_active("self_contact")) {
    cloth::SelfContactOptions options;
    options.thickness_m = m_settings.self_thickness_m;
    if (open_seams) options.search_m = SEW_SEARCH * mean_edge();
    m_self_contact = &m_solver->emplace<cloth::SelfContactEffect>(*m_mesh, options, open_seams ? seam_classes(m_garment) : std::vector<int>{});
  }
}

void SimulatedCloth::tear_down() {
  if (!m_solver) return;
  report_effects();
  m_body_contact = nullptr;
  m_self_contact = nullptr;
  m_sewing = nullptr;
  m_solver.reset();
}

void SimulatedCloth::add_load() {
  if (m_loaded) return;
  m_loaded = true;
  if (is_active("gravity")) m_solver->emplace<cloth::GravityEffect>(*m_mesh, Vec3(0, -m_settings.gravity_m_s2, 0));
  if (!is_active("friction")) return;
  const Material& material = material_of(m_garment, "");
  if (m_body_contact) m_body_contact->set_friction(material.friction_body);
  if (m_self_contact) m_self_contact->set_friction(material.friction_self);
}

void SimulatedCloth::replace_rest_shape() {
  cloth::ClothMesh fresh = cloth_mesh_of(m_garment);
  bool all_take_it = true;
  *m_mesh = std::move(fresh);
  if (!is_active("damping")) remove_damping();
  for (const auto& effect : m_solver->effects()) all_take_it = effect->set_rest(*m_mesh) && all_take_it;
  if (all_take_it) return;
  const bool loaded = m_loaded;
  build(m_open_seams);
  if (loaded) add_load();
}

void SimulatedCloth::report_effects() {
  std::vector<EffectReport>& reports = m_telemetry.report.effects;
  for (const auto& effect : m_solver->effects())
    for (EffectReport& r : reports)
      if (r.name == effect->name()) {
        r.calls += effect->calls;
        r.wall_s += effect->wall_s;
      }
  for (EffectReport& r : reports) { // damping and friction live in the terms that they belong to
    if (r.name == "friction" && m_body_contact) r.calls += m_body_contact->friction_calls;
    else if (r.name == "layers" && r.active && m_self_contact) r.calls += m_self_contact->calls;
    else if (r.name == "damping" && r.active) r.calls = m_telemetry.report.steps;
  }
}

void SimulatedCloth::positions_changed() {
  m_solver->positions_changed();
  refresh_contacts();
}

void SimulatedCloth::refresh_contacts() {
  if (m_body_contact) m_body_contact->refresh();
  if (m_self_contact) m_self_contact->refresh();
}

double SimulatedCloth::mean_edge() const {
  double sum = 0;
  for (const cloth::EdgeSpring& s : m_mesh->springs) sum += s.rest_length;
  return sum / static_cast<double>(m_mesh->springs.size());
}

double SimulatedCloth::tension_ratio() const {
  double pull = 0;
  for (const cloth::EdgeSpring& s : m_mesh->springs) pull += s.stiffness * s.rest_length;
  const double mass = std::accumulate(m_mesh->mass.begin(), m_mesh->mass.end(), 0.0);
  return pull / static_cast<double>(m_mesh->springs.size()) / (mass * units::GRAVITY / m_mesh->n_particles);
}

std::string SimulatedCloth::crossing_text() const {
  if (!m_body_contact || m_body_contact->n_crossing() == 0) return "";
  return ", " + std::to_string(m_body_contact->n_crossing()) + " faces through the skin, one at " + place_text(m_body_contact->crossing_place());
}

} // namespace sloper::garment
