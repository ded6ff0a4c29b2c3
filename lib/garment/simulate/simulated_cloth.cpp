#include <garment/scene/effects.hpp>
#include <sloper/base/error.hpp>
#include <sloper/base/units.hpp>
#include <sloper/cloth/linear/factorisation.hpp>
#include <sloper/garment/sewing.hpp>
#include <sloper/garment/simulate/simulated_cloth.hpp>

#include <numeric>

namespace sloper::garment {

namespace {

constexpr double SEW_BENDING =
    30; // times that of the fabric: panels travel as boards and do not crumple

} // namespace

SimulatedCloth::SimulatedCloth(Garment& garment, const DrapeSettings& settings, CollisionBody& body,
                               Telemetry& telemetry)
    : m_garment(garment), m_settings(settings), m_body(body), m_telemetry(telemetry) {
  if (garment.panels.triangles.empty())
    throw input_error("garment.no-triangles"_id, "", "", "the garment has no triangles",
                      "mesh a pattern with pattern-mesh first");
  check_garment(garment);
}

void SimulatedCloth::choose_effects() {
  m_telemetry.report.effects = garment::choose_effects(m_garment, m_body.body(), m_settings);
}

void SimulatedCloth::build(bool open_seams, bool keep_velocity) {
  tear_down();
  m_open_seams = open_seams;
  if (!keep_velocity)
    m_velocity.assign(m_garment.position.size(), Vec3::Zero());
  m_mesh = std::make_unique<cloth::ClothMesh>(cloth_mesh_of(m_garment));
  m_solver = std::make_unique<cloth::ClothSolver>(*m_mesh, m_garment.position, m_velocity);
  if (m_settings.solver == 1)
    m_solver->set_preconditioner(std::make_unique<cloth::BlockJacobi>());
  if (m_settings.solver == 2)
    m_solver->set_preconditioner(std::make_unique<cloth::Factorisation>());
  m_loaded = false;
  prepare_mesh(*m_mesh, m_garment, m_telemetry.report.effects);
  if (open_seams) {
    for (cloth::Hinge& hinge : m_mesh->hinges)
      hinge.stiffness *= SEW_BENDING;
    m_mesh->bend_scale = SEW_BENDING;
  }
  for (EffectStage stage :
       {EffectStage::FABRIC, EffectStage::MODEL, EffectStage::SCENE, EffectStage::CONTACT})
    add_stage(stage);
}

void SimulatedCloth::add_stage(EffectStage stage) {
  EffectBuild build{.solver = *m_solver,
                    .mesh = *m_mesh,
                    .garment = m_garment,
                    .body = m_body.body(),
                    .settings = m_settings,
                    .collider = m_body.collider(),
                    .open_seams = m_open_seams,
                    .handles = m_handles};
  add_effects(stage, build, m_telemetry.report.effects);
}

void SimulatedCloth::tear_down() {
  if (!m_solver)
    return;
  report_effects();
  m_handles = {};
  m_solver.reset();
}

void SimulatedCloth::add_load() {
  if (m_loaded)
    return;
  m_loaded = true;
  add_stage(EffectStage::LOAD);
}

void SimulatedCloth::replace_rest_shape() {
  cloth::ClothMesh fresh = cloth_mesh_of(m_garment);
  bool all_take_it = true;
  *m_mesh = std::move(fresh);
  prepare_mesh(*m_mesh, m_garment, m_telemetry.report.effects);
  for (const auto& effect : m_solver->effects())
    all_take_it = effect->set_rest(*m_mesh) && all_take_it;
  if (all_take_it)
    return;
  const bool loaded = m_loaded;
  build(m_open_seams);
  if (loaded)
    add_load();
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
    if (r.name == "friction" && m_handles.body_contact)
      r.calls += m_handles.body_contact->friction_calls;
    else if (r.name == "layers" && r.active && m_handles.self_contact)
      r.calls += m_handles.self_contact->calls;
    else if (r.name == "damping" && r.active)
      r.calls = m_telemetry.report.steps;
  }
}

void SimulatedCloth::positions_changed() {
  m_solver->positions_changed();
  refresh_contacts();
}

void SimulatedCloth::refresh_contacts() {
  if (m_handles.body_contact)
    m_handles.body_contact->refresh();
  if (m_handles.self_contact)
    m_handles.self_contact->refresh();
}

double SimulatedCloth::tension_ratio() const {
  double pull = 0;
  for (const cloth::EdgeSpring& s : m_mesh->springs)
    pull += s.stiffness * s.rest_length;
  const double mass = std::accumulate(m_mesh->mass.begin(), m_mesh->mass.end(), 0.0);
  return pull / static_cast<double>(m_mesh->springs.size()) /
         (mass * units::GRAVITY / m_mesh->n_particles);
}

std::string SimulatedCloth::crossing_text() const {
  if (!m_handles.body_contact || m_handles.body_contact->n_crossing() == 0)
    return "";
  return ", " + std::to_string(m_handles.body_contact->n_crossing()) +
         " faces through the skin, one at " + place_text(m_handles.body_contact->crossing_place());
}

} // namespace sloper::garment
