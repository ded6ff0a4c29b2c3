#include <garment/drape/motion.hpp>
#include <garment/simulate/session.hpp>

namespace sloper::garment {

DrapeReport drape_in_motion(Garment& garment, const body::Body& body, const BodyMoves& moves,
                            const DrapeSettings& settings, const OnMotionFrame& on_frame,
                            Reporter& reporter, const DrapeRequest& request) {
  SessionInputs inputs{
      .garment = garment, .body = &body, .moves = &moves, .on_frame = on_frame, .request = request};
  if (!inputs.request.checkpoints.motion) inputs.request.checkpoints.motion = moves.input();
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
  return DrapeSession(inputs, from, reporter).run();
}

} // namespace sloper::garment
