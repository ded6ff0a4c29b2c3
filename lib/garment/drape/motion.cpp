#include <garment/drape/motion.hpp>
#include <garment/levels/drape_levels.hpp>
#include <garment/simulate/session.hpp>

namespace sloper::garment {

namespace {

/// Cloth that came to rest through levels of mesh then moves with the body.
DrapeReport go_on_in_motion(DrapeReport rest, const SessionInputs& inputs,
                            const DrapeSettings& settings, Reporter& reporter) {
  const bool moves = rest.converged || rest.stop_reason == StopReason::AT_REST_UNCLEAN;
  if (!moves) return rest;
  DrapeReport report = DrapeSession(inputs, settings, reporter).run();
  add_earlier(rest, report);
  report.levels = rest.levels;
  return report;
}

} // namespace

DrapeReport drape_in_motion(Garment& garment, const body::Body& body, const BodyMoves& moves,
                            const DrapeSettings& settings, const OnMotionFrame& on_frame,
                            Reporter& reporter, const DrapeRequest& request) {
  SessionInputs inputs{
      .garment = garment, .body = &body, .moves = &moves, .on_frame = on_frame, .request = request};
  if (!inputs.request.checkpoints.motion) inputs.request.checkpoints.motion = moves.input();
  if (settings.levels > 1 && garment.particle_of.empty())
    return go_on_in_motion(
        drape_through_levels(garment, &body, settings, reporter, inputs.request), inputs, settings,
        reporter);
  return DrapeSession(inputs, settings, reporter).run();
}

DrapeReport resume_in_motion(const DrapeCheckpoint& from, Garment& garment, const body::Body& body,
                             const BodyMoves& moves, const OnMotionFrame& on_frame,
                             Reporter& reporter, const Checkpoints& checkpoints) {
  SessionInputs inputs{.garment = garment,
                       .body = &body,
                       .moves = &moves,
                       .on_frame = on_frame,
                       .request = {.checkpoints = checkpoints}};
  inputs.request.checkpoints.motion = from.motion;
  if (from.levels) {
    const DrapeSettings settings = from.levels->settings;
    DrapeReport rest = resume_through_levels(from, garment, &body, reporter, checkpoints);
    inputs.request.bounds = from.bounds;
    inputs.request.checkpoints.renew = true;
    inputs.request.checkpoints.every_steps = from.every_steps;
    return go_on_in_motion(std::move(rest), inputs, settings, reporter);
  }
  return DrapeSession(inputs, from, reporter).run();
}

} // namespace sloper::garment
