#include <garment/drape/motion.hpp>
#include <garment/levels/coarse_start.hpp>
#include <garment/levels/drape_levels.hpp>
#include <garment/simulate/session.hpp>

namespace sloper::garment {

namespace {

SessionInputs inputs_of(Garment& garment, const body::Body& body, const FollowedMotion& motion,
                        const DrapeRequest& request) {
  return {.garment = garment,
          .body = &body,
          .moves = motion.moves,
          .on_frame = motion.on_frame,
          .request = request};
}

/// Cloth that came to rest through levels of mesh then moves with the body. What came before is
/// part of the report, and of checkpoints.
DrapeReport go_on_in_motion(DrapeReport rest, SessionInputs inputs, const DrapeSettings& settings,
                            Reporter& reporter) {
  if (!rest.converged && rest.stop_reason != StopReason::AT_REST_UNCLEAN)
    return rest;
  LevelsProgress at{
      .settings = settings, .rung = "", .on_given_mesh = false, .sprung = false, .before = {}};
  at.before = rest;
  inputs.request.checkpoints.levels = &at;
  DrapeReport report = DrapeSession(inputs, settings, reporter).run();
  add_earlier(rest, report);
  report.levels = rest.levels;
  return report;
}

} // namespace

DrapeReport drape_in_motion(Garment& garment, const body::Body& body, const DrapeSettings& settings,
                            const FollowedMotion& motion, Reporter& reporter,
                            const DrapeRequest& request) {
  SessionInputs inputs = inputs_of(garment, body, motion, request);
  if (!inputs.request.checkpoints.motion)
    inputs.request.checkpoints.motion = motion.moves->input();
  const bool through_levels = settings.levels > 1 && garment.particle_of.empty() &&
                              refusal_of_levels(garment, &body, settings).empty();
  if (!through_levels)
    return DrapeSession(inputs, settings, reporter).run();
  DrapeReport rest = drape_through_levels(garment, &body, settings, reporter, inputs.request);
  return go_on_in_motion(std::move(rest), inputs, settings, reporter);
}

DrapeReport resume_in_motion(const DrapeCheckpoint& from, Garment& garment, const body::Body& body,
                             const FollowedMotion& motion, Reporter& reporter,
                             const Checkpoints& checkpoints) {
  SessionInputs inputs = inputs_of(garment, body, motion, {.checkpoints = checkpoints});
  inputs.request.checkpoints.motion = from.motion;
  if (!from.levels)
    return DrapeSession(inputs, from, reporter).run();
  if (!from.levels->rung.empty()) {
    from.check_moves(motion.moves);
    DrapeReport rest = resume_through_levels(from, garment, &body, reporter, checkpoints);
    inputs.request.bounds = from.bounds;
    inputs.request.checkpoints.renew = true;
    inputs.request.checkpoints.every_steps = from.every_steps;
    return go_on_in_motion(std::move(rest), inputs, from.levels->settings, reporter);
  }
  inputs.request.checkpoints.levels = &*from.levels;
  DrapeReport report = DrapeSession(inputs, from, reporter).run();
  add_earlier(from.levels->before, report);
  report.levels = from.levels->before.levels;
  return report;
}

} // namespace sloper::garment
