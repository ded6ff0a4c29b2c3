/// The part of a drape in which the body moves.
#include <cloth/motion/body_motion.hpp>
#include <collision/intersections.hpp>
#include <garment/simulate/drape_run.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace sloper::garment {

namespace {

/// m: pairs are kept this far beyond their reach, so that parts can be long.
constexpr double MOTION_SLACK = 0.008;
/// m: around the box of sleeping cloth; skin that moves in there wakes it.
constexpr double WAKES = 0.05;

/// For how long cloth has been at rest on a body that holds still: not by its speed or its force, since single particles between two states of
/// contact go to and fro for good, but by how far it came.
class Calm {
public:
  void end() { m_from.clear(); }
  void note(const std::vector<Vec3>& x, double frame_s) {
    bool same = m_from.size() == x.size();
    for (std::size_t i = 0; same && i < x.size(); ++i) same = (x[i] - m_from[i]).norm() <= FARTHEST;
    m_s = same ? m_s + frame_s : 0;
    if (!same) m_from = x;
  }
  bool lasts() const { return !m_from.empty() && m_s >= LONG_ENOUGH; }

private:
  static constexpr double FARTHEST = 1e-4, LONG_ENOUGH = 0.2; // m, s
  std::vector<Vec3> m_from;                                   // where the cloth was when the calm began; none: there is no calm
  double m_s = 0;
};

} // namespace

void DrapeRun::then_move(const BodyMoves& moves, OnMotionFrame on_frame) {
  m_moves = &moves;
  m_on_frame = std::move(on_frame);
}

/// Whether sleeping cloth must take part in a frame: skin near it moves, or wind blows.
bool DrapeRun::wakes(const std::vector<Vec3>& from, const std::vector<Vec3>& to) const {
  if (active("wind")) return true;
  Vec3 low = Vec3::Constant(std::numeric_limits<double>::infinity()), high = -low;
  for (const Vec3& p : m_solver->x()) {
    low = low.cwiseMin(p - Vec3::Constant(WAKES));
    high = high.cwiseMax(p + Vec3::Constant(WAKES));
  }
  for (std::size_t v = 0; v < from.size(); ++v) {
    if (from[v] == to[v]) continue;
    if ((from[v].cwiseMin(to[v]).array() <= high.array()).all() && (from[v].cwiseMax(to[v]).array() >= low.array()).all()) return true;
  }
  return false;
}

void DrapeRun::audit_frame(MotionFrame& frame) {
  const std::vector<Triangle> triangles = m_garment.particle_triangles();
  const collision::TriangleTree tree(m_garment.position, triangles);
  frame.vertices_inside = 0;
  frame.self_intersections = collision::self_intersections(m_garment.position, triangles, tree).size();
  frame.faces_through = m_collider->faces_through(m_garment.position, triangles).size();
  for (const Vec3& p : m_garment.position) {
    const collision::SignedDistance d = m_collider->signed_distance(p, 0.05);
    frame.vertices_inside += d.triangle >= 0 ? d.distance < 0 : m_collider->is_inside(p);
  }
}

void DrapeRun::follow_motion() {
  if (m_stopped || !m_body_contact) return;
  MotionState& at = m_at.motion;
  const double began = elapsed() - at.elapsed_s;
  m_report.converged = false;
  m_settling = false;
  if (m_at.phase != DrapePhase::MOVE) { // it begins; else it goes on from a checkpoint
    m_at.phase = DrapePhase::MOVE;
    m_solver->stop();
  }
  std::optional<cloth::BodyMotion> motion;
  const auto take_up = [&] {
    m_body_contact->set_slack(MOTION_SLACK);
    motion.emplace(*m_solver, *m_body_contact, *m_collider);
    motion->parts = at.parts, motion->forced = at.forced, motion->largest_way_m = at.largest_way_m, motion->wall_s = at.wall_s;
  };
  take_up();
  const std::size_t substeps = static_cast<std::size_t>(std::max(1.0, std::ceil(m_moves->frame_s / m_settings.motion_step_s - 1e-9)));
  cloth::StepOptions options;
  options.h = m_moves->frame_s / static_cast<double>(substeps);
  options.inertia = 1;
  options.largest_move_m = 1;
  options.cg_tolerance = std::min(m_settings.cg_tolerance, 1e-3);
  options.cg_max_iterations = m_settings.cg_max_iterations;
  options.newton_iterations = m_settings.newton_iterations;
  options.guard_energy = true;
  Calm calm;
  MotionFrame last;
  std::vector<Vec3> skin = at.frame > 0 ? m_moves->skin(at.frame - 1) : m_body->skin.positions, target = skin;
  while (at.frame < m_moves->n_frames && !m_stopped) {
    if (renews() && at.parts - at.noted >= m_checkpoints.every_steps) {
      at.noted = at.parts;
      at.velocity = m_solver->v();
      at.elapsed_s = elapsed() - began;
      renew();
      take_up();
      calm.end(); // a run that goes on from here knows nothing of it
    }
    m_reporter.progress("body motion", static_cast<double>(at.frame) / static_cast<double>(m_moves->n_frames));
    const std::vector<Vec3> from = skin;
    skin = m_moves->skin(at.frame);
    MotionFrame frame = last; // counts of an audit hold while nothing moves
    frame.speed_m_s = 0;
    if (wakes(from, skin)) calm.end();
    const bool asleep = calm.lasts();
    if (asleep) {
      ++at.asleep_frames;
      m_body_contact->move_body(as_met(skin), m_solver->x());
    }
    for (std::size_t s = 1; !asleep && s <= substeps && !m_stopped; ++s) {
      const double t = static_cast<double>(s) / static_cast<double>(substeps);
      for (std::size_t v = 0; v < skin.size(); ++v) target[v] = s < substeps ? Vec3((1 - t) * from[v] + t * skin[v]) : skin[v];
      m_at.last = motion->advance(as_met(target), options);
      note_solves();
      frame.speed_m_s = std::max(frame.speed_m_s, m_at.last.largest_move_m / options.h);
      if (m_at.last.finite) continue;
      m_at.rejected.push_back("frame " + std::to_string(at.frame + 1) + " of the motion: not finite, undone");
      m_solver->stop();
      m_stopped = true;
      m_report.stop_reason = "diverged";
    }
    if (!asleep) calm.note(m_solver->x(), m_moves->frame_s);
    if (!asleep && calm.lasts()) m_solver->stop();
    at.simulated_s += m_moves->frame_s;
    frame.number = static_cast<int>(++at.frame);
    frame.pose = std::max(0, frame.number - static_cast<int>(m_moves->lead_in));
    frame.time_s = at.simulated_s;
    frame.parts = motion->parts - at.parts;
    frame.forced = motion->forced > at.forced;
    at.parts = static_cast<int>(motion->parts), at.forced = static_cast<int>(motion->forced);
    at.largest_way_m = motion->largest_way_m, at.wall_s = motion->wall_s;
    at.forced_frames += frame.forced;
    m_garment.position = m_solver->x();
    if (!asleep) audit_frame(frame);
    last = frame;
    const std::size_t found[3] = {frame.faces_through, frame.vertices_inside, frame.self_intersections};
    for (int i = 0; i < 3; ++i) {
      at.bad_frames[i] += found[i] > 0;
      at.most[i] = std::max(at.most[i], static_cast<int>(found[i]));
    }
    if (m_on_frame) m_on_frame(frame, m_garment);
    if (!m_stopped && m_settings.max_seconds > 0 && elapsed() > m_settings.max_seconds) m_stopped = true, m_report.stop_reason = "time limit";
    if (!m_stopped && m_reporter.stop_requested()) m_stopped = true, m_report.stop_reason = "stopped by the user";
  }
  at.elapsed_s = elapsed() - began;
  at.velocity.clear();
  at.over = true;
  add_phase_time("body motion", at.elapsed_s);
  m_report.simulated_s += at.simulated_s;
  m_report.steps += at.parts;
  for (EffectReport& e : m_report.effects)
    if (e.name == "body_motion") e.calls = at.parts, e.wall_s = at.wall_s;
  stand_in(skin);
  m_solver->stop();
  m_at.disturbed = false;
  m_at.phase = DrapePhase::START; // settles once more
  m_at.calm = m_at.pushed = m_at.best_at = 0;
  m_at.best = std::numeric_limits<double>::infinity();
  m_body_contact->set_slack(cloth::BodyContactOptions{}.slack_m);
  if (!m_stopped) settle();
}

void DrapeRun::stand_in(const std::vector<Vec3>& skin) {
  m_end_body = *m_body;
  m_end_body.skin.positions = skin;
  m_body = &m_end_body;
  m_settings.max_steps += m_at.motion.parts; // the limit is on the way to rest
}

io::Json DrapeRun::motion_report() const {
  const MotionState& m = m_at.motion;
  const auto count = [&](int k) { return io::Json{{"frames", m.bad_frames[k]}, {"most", m.most[k]}}; };
  return {{"frames", m.frame},
          {"lead_in", std::min(m_moves->lead_in, m.frame)},
          {"frame_s", m_moves->frame_s},
          {"parts", m.parts},
          {"forced_frames", m.forced_frames},
          {"asleep_frames", m.asleep_frames},
          {"largest_way_m", m.largest_way_m},
          {"ms_per_frame", 1000 * m.elapsed_s / static_cast<double>(std::max<std::size_t>(m.frame, 1))},
          {"faces_through_body", count(0)},
          {"vertices_inside_body", count(1)},
          {"self_intersections", count(2)}};
}

DrapeReport drape_in_motion(Garment& garment, const body::Body& body, const BodyMoves& moves, const DrapeSettings& settings, const OnMotionFrame& on_frame,
                            Reporter& reporter, Checkpoints checkpoints) {
  if (!checkpoints.motion) checkpoints.motion = moves.input();
  DrapeRun run(garment, &body, settings, reporter);
  run.set_checkpoints(checkpoints);
  run.then_move(moves, on_frame);
  return run.run();
}

DrapeReport resume_in_motion(const DrapeCheckpoint& c, Garment& garment, const body::Body& body, const BodyMoves& moves, const OnMotionFrame& on_frame,
                             Reporter& reporter, Checkpoints checkpoints) {
  garment = c.garment;
  DrapeRun run(garment, &body, c.report.settings, reporter);
  checkpoints.motion = c.motion;
  run.set_checkpoints(checkpoints);
  run.then_move(moves, on_frame);
  run.resume(c);
  return run.run();
}

} // namespace sloper::garment
