/// The part of a drape in which the body moves.
#include <cloth/body_motion.hpp>
#include <collision/intersections.hpp>
#include <garment/drape_run.hpp>

#include <algorithm>
#include <cmath>

namespace sloper::garment {

/// s: with inertia, longer steps damp the swing of cloth away.
static constexpr double LONGEST_MOTION_STEP = 1.0 / 60;
/// m: pairs are kept this far beyond their reach, so that parts can be long.
static constexpr double MOTION_SLACK = 0.008;

void DrapeRun::then_move(const BodyMoves& moves, OnMotionFrame on_frame) {
  m_moves = &moves;
  m_on_frame = std::move(on_frame);
}

void DrapeRun::audit_frame(MotionFrame& frame) {
  const std::vector<Triangle> triangles = m_garment.particle_triangles();
  const collision::TriangleTree tree(m_garment.position, triangles);
  frame.self_intersections = collision::self_intersections(m_garment.position, triangles, tree).size();
  frame.faces_through = m_collider->faces_through(m_garment.position, triangles).size();
  for (const Vec3& p : m_garment.position) {
    const collision::SignedDistance d = m_collider->signed_distance(p, 0.05);
    frame.vertices_inside += d.triangle >= 0 ? d.distance < 0 : m_collider->is_inside(p);
  }
}

void DrapeRun::follow_motion() {
  if (m_stopped || !m_body_contact) return;
  const double began = elapsed();
  m_report.converged = false;
  m_settling = false;
  const double slack = cloth::BodyContactOptions{}.slack_m;
  m_body_contact->set_slack(MOTION_SLACK);
  cloth::BodyMotion motion(*m_solver, *m_body_contact, *m_collider);
  const std::size_t substeps = static_cast<std::size_t>(std::max(1.0, std::ceil(m_moves->frame_s / LONGEST_MOTION_STEP - 1e-9)));
  cloth::StepOptions options;
  options.h = m_moves->frame_s / static_cast<double>(substeps);
  options.inertia = 1;
  options.largest_move_m = 1;
  options.cg_tolerance = std::min(m_settings.cg_tolerance, 1e-3);
  options.cg_max_iterations = m_settings.cg_max_iterations;
  std::size_t bad_frames[3] = {}, most[3] = {};
  int frames = 0, forced_frames = 0;
  double simulated = 0;
  std::vector<Vec3> skin = m_body->skin.positions, target = skin;
  m_solver->stop();
  for (std::size_t k = 0; k < m_moves->n_frames && !m_stopped; ++k) {
    m_reporter.progress("body motion", static_cast<double>(k) / static_cast<double>(m_moves->n_frames));
    const std::vector<Vec3> from = skin;
    skin = m_moves->skin(k);
    MotionFrame frame;
    const long parts = motion.parts, forced = motion.forced;
    for (std::size_t s = 1; s <= substeps && !m_stopped; ++s) {
      const double t = static_cast<double>(s) / static_cast<double>(substeps);
      for (std::size_t v = 0; v < skin.size(); ++v) target[v] = s < substeps ? Vec3((1 - t) * from[v] + t * skin[v]) : skin[v];
      m_at.last = motion.advance(m_mitten ? m_mitten->positions(target) : target, options);
      m_at.cg_iterations.push_back(m_at.last.cg.iterations);
      frame.speed_m_s = std::max(frame.speed_m_s, m_at.last.largest_move_m / options.h);
      if (m_at.last.finite) continue;
      m_at.rejected.push_back("frame " + std::to_string(k + 1) + " of the motion: not finite, undone");
      m_solver->stop();
      m_stopped = true;
      m_report.stop_reason = "diverged";
    }
    simulated += m_moves->frame_s;
    frame.number = ++frames;
    frame.time_s = simulated;
    frame.parts = motion.parts - parts;
    frame.forced = motion.forced > forced;
    forced_frames += frame.forced;
    m_garment.position = m_solver->x();
    audit_frame(frame);
    const std::size_t found[3] = {frame.faces_through, frame.vertices_inside, frame.self_intersections};
    for (int i = 0; i < 3; ++i) {
      bad_frames[i] += found[i] > 0;
      most[i] = std::max(most[i], found[i]);
    }
    if (m_on_frame) m_on_frame(frame, m_garment);
    if (!m_stopped && m_settings.max_seconds > 0 && elapsed() > m_settings.max_seconds) m_stopped = true, m_report.stop_reason = "time limit";
    if (!m_stopped && m_reporter.stop_requested()) m_stopped = true, m_report.stop_reason = "stopped by the user";
  }
  const double wall = elapsed() - began;
  add_phase_time("body motion", wall);
  m_report.simulated_s += simulated;
  m_report.steps += static_cast<int>(motion.parts);
  for (EffectReport& e : m_report.effects)
    if (e.name == "body_motion") e.calls = motion.parts, e.wall_s = motion.wall_s;
  m_motion = {{"frames", frames},
              {"lead_in", std::min<std::size_t>(m_moves->lead_in, static_cast<std::size_t>(frames))},
              {"frame_s", m_moves->frame_s},
              {"parts", motion.parts},
              {"forced_frames", forced_frames},
              {"largest_way_m", motion.largest_way_m},
              {"ms_per_frame", 1000 * wall / std::max(frames, 1)},
              {"faces_through_body", {{"frames", bad_frames[0]}, {"most", most[0]}}},
              {"vertices_inside_body", {{"frames", bad_frames[1]}, {"most", most[1]}}},
              {"self_intersections", {{"frames", bad_frames[2]}, {"most", most[2]}}}};
  m_end_body = *m_body;
  m_end_body.skin.positions = skin;
  m_body = &m_end_body;
  m_solver->stop();
  m_settings.max_steps += static_cast<int>(motion.parts); // the limit is on the way to rest
  m_at.disturbed = false;
  m_at.phase = DrapePhase::START; // settles once more
  m_at.calm = m_at.pushed = m_at.best_at = 0;
  m_at.best = std::numeric_limits<double>::infinity();
  m_body_contact->set_slack(slack);
  if (!m_stopped) settle();
}

DrapeReport drape_in_motion(Garment& garment, const body::Body& body, const BodyMoves& moves, const DrapeSettings& settings, const OnMotionFrame& on_frame,
                            Reporter& reporter) {
  DrapeRun run(garment, &body, settings, reporter);
  run.then_move(moves, on_frame);
  return run.run();
}

} // namespace sloper::garment
