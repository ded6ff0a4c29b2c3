/// The part of a drape that notes where it is, and goes on from there.
#include <base/error.hpp>
#include <garment/drape_run.hpp>

namespace sloper::garment {

bool DrapeRun::checkpoint() {
  const int steps = m_report.steps;
  if (m_checkpoints.file.empty() && !m_resumed) return false;
  if (steps == m_checkpoint_step || steps % m_checkpoints.every_steps != 0) return false;
  m_checkpoint_step = steps;
  m_garment.position = m_solver->x();
  if (m_body_contact) m_at.contact = m_body_contact->memory();
  m_at.shrunk = m_shrink.has_value();
  m_at.skin.clear();
  if (m_at.phase == DrapePhase::INFLATE) m_at.skin = m_collider->mesh().positions;
  report_effects();
  m_solver.reset(); // reported, and not to be again
  if (!m_checkpoints.file.empty()) {
    m_report.wall_s = elapsed();
    write_checkpoint(m_checkpoints.file, {m_garment, m_at, m_report, m_checkpoints.every_steps, m_body != nullptr});
  }
  rebuild();
  return true;
}

void DrapeRun::rebuild() {
  build_solver(m_at.phase == DrapePhase::SEW);
  if (m_at.phase == DrapePhase::SETTLE && m_at.step > glide()) add_load();
  if (m_body_contact) m_body_contact->recall(m_at.contact);
}

void DrapeRun::resume(const DrapeCheckpoint& c) {
  if (c.has_body != (m_body != nullptr))
    throw input_error("", "checkpoint", c.has_body ? "was on a body" : "was without a body", "give the same --body as before");
  m_at = c.state;
  m_report.settings = m_settings = c.report.settings;
  m_report.steps = m_checkpoint_step = c.report.steps;
  m_report.simulated_s = c.report.simulated_s;
  m_report.effects = c.report.effects;
  m_report.phases = c.report.phases;
  m_report.repairs = c.report.repairs;
  m_elapsed_before = c.report.wall_s;
  m_checkpoints.every_steps = c.every_steps;
  m_resumed = true;
  if (m_body && !m_body->skin.triangles.empty()) {
    const Phase phase(*this, "prepare body");
    prepare_body(m_at.mitten);
    if (m_at.shrunk) m_shrink.emplace(*m_body);
    const bool inflating = m_at.phase == DrapePhase::INFLATE;
    if (inflating && m_at.skin.size() != m_collider->mesh().positions.size()) throw input_error("", "checkpoint", "belongs to another body");
    if (m_at.shrunk) m_collider->set_positions(inflating ? m_at.skin : skin_at(m_at.scale));
  }
  rebuild();
}

DrapeReport resume_drape(const std::string& checkpoint, Garment& garment, const body::Body* body, Reporter& reporter, const std::string& file) {
  DrapeCheckpoint c = read_checkpoint(checkpoint);
  const std::string& hangs_on = garment.body_sha256;
  if (!hangs_on.empty() && hangs_on != c.garment.body_sha256)
    throw input_error(checkpoint, "", "the body is not the one on which this drape began", "give the same --body as before");
  garment = c.garment;
  DrapeRun run(garment, body, c.report.settings, reporter);
  run.set_checkpoints({file, c.every_steps});
  run.resume(c);
  return run.run();
}

} // namespace sloper::garment
