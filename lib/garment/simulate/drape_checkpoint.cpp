/// The part of a drape that notes where it is, and goes on from there.
#include <base/error.hpp>
#include <garment/simulate/drape_run.hpp>

namespace sloper::garment {

bool DrapeRun::renews() const { return !m_checkpoints.file.empty() || m_checkpoints.renew; }

bool DrapeRun::checkpoint() {
  const int steps = m_report.steps;
  if (!renews() || steps == m_checkpoint_step || steps % m_checkpoints.every_steps != 0) return false;
  renew();
  return true;
}

void DrapeRun::renew() {
  m_checkpoint_step = m_report.steps;
  m_garment.position = m_solver->x();
  if (m_body_contact) m_at.contact = m_body_contact->memory();
  m_at.shrunk = m_shrink.has_value();
  m_at.skin.clear();
  if (m_at.phase == DrapePhase::INFLATE) m_at.skin = m_collider->mesh().positions;
  if (m_at.free_steps > 0) m_at.velocity = m_solver->v();
  report_effects();
  m_solver.reset(); // reported, and not to be again
  if (!m_checkpoints.file.empty()) {
    m_report.wall_s = elapsed();
    DrapeCheckpoint c{m_garment, m_at, m_report, m_checkpoints.every_steps, m_body != nullptr, m_checkpoints.motion, {}, {}};
    if (m_checkpoints.layers) c.layers = *m_checkpoints.layers;
    write_checkpoint(m_checkpoints.file, c);
  }
  rebuild();
}

void DrapeRun::rebuild() {
  build_solver(m_at.phase == DrapePhase::SEW);
  hold_sleeves();
  let_tucks_pass();
  if ((m_at.phase == DrapePhase::SETTLE && m_at.step > glide()) || m_at.phase == DrapePhase::MOVE) add_load();
  if (m_body_contact) m_body_contact->recall(m_at.contact);
  const std::vector<Vec3>& velocity = m_at.phase == DrapePhase::MOVE ? m_at.motion.velocity : m_at.velocity;
  if (!velocity.empty()) m_solver->shift(std::vector<Vec3>(velocity.size(), Vec3::Zero()), velocity);
  m_at.velocity.clear();
}

void DrapeRun::resume(const DrapeCheckpoint& c) {
  c.check_body(m_body, "");
  const MotionState& motion = c.state.motion;
  if (!c.layers || c.layers->alone == c.layers->garments.size()) c.check_moves(m_moves); // the body stands still while a garment of several is alone
  m_at = c.state;
  m_report.settings = m_settings = c.report.settings;
  m_report.steps = m_checkpoint_step = c.report.steps;
  m_report.simulated_s = c.report.simulated_s;
  m_report.effects = c.report.effects;
  m_report.phases = c.report.phases;
  m_report.repairs = c.report.repairs;
  m_elapsed_before = c.report.wall_s;
  m_checkpoints.every_steps = c.every_steps;
  m_checkpoints.renew = true;
  if (m_body && !m_body->skin.triangles.empty()) {
    const Phase phase(*this, "prepare body");
    prepare_body(m_at.covered);
    if (m_at.shrunk) m_shrink.emplace(*m_body);
    if (m_at.arms_aside) take_forearms();
    if (motion.frame > 0) {
      const std::vector<Vec3> skin = m_moves->skin(motion.frame - 1);
      m_collider->set_positions(as_met(skin));
      if (motion.over) stand_in(skin);
    } else if (m_at.shrunk || m_at.arms_aside) {
      const bool inflating = m_at.phase == DrapePhase::INFLATE;
      if (inflating && m_at.skin.size() != m_collider->mesh().positions.size()) throw input_error(c.file, "", "belongs to another body");
      m_collider->set_positions(inflating ? m_at.skin : skin_at(m_at.scale));
    }
  }
  rebuild();
}

DrapeReport resume_drape(const std::string& checkpoint, Garment& garment, const body::Body* body, Reporter& reporter, const std::string& file) {
  const DrapeCheckpoint c = read_checkpoint(checkpoint);
  if (c.motion || c.layers) throw input_error(checkpoint, "", c.motion ? "is of a run in motion" : "is of a run with garments over each other");
  c.check_body(body, garment.body_sha256);
  Checkpoints checkpoints;
  checkpoints.file = file;
  return resume_drape(c, garment, body, reporter, checkpoints);
}

DrapeReport resume_drape(const DrapeCheckpoint& c, Garment& garment, const body::Body* body, Reporter& reporter, Checkpoints checkpoints) {
  garment = c.garment;
  DrapeRun run(garment, body, c.report.settings, reporter);
  run.set_checkpoints(checkpoints);
  run.resume(c);
  return run.run();
}

void DrapeCheckpoint::check_moves(const BodyMoves* moves) const {
  if (motion.has_value() == (moves != nullptr) && (!moves || state.motion.frame <= moves->n_frames)) return;
  throw input_error(file, "", motion ? "is of a run in another motion" : "is of a run in no motion", "give the same --motion as before");
}

void DrapeCheckpoint::check_body(const body::Body* body, const std::string& body_sha256) const {
  const std::string& began_on = layers ? layers->garments.back().body_sha256 : garment.body_sha256;
  const bool same = has_body == (body != nullptr) && (body_sha256.empty() || body_sha256 == began_on);
  if (same) return;
  throw input_error(file, "",
                    !has_body ? "this drape began without a body"
                    : !body   ? "this drape began on a body"
                              : "the body is not the one on which this drape began",
                    has_body ? "give the same --body as before" : "leave --body out");
}

} // namespace sloper::garment
