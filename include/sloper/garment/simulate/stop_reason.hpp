#pragma once
/// Why a drape ended.
#include <string>

namespace sloper::garment {

/// Why a drape ended. stop_text() makes the sentence of the report.
enum class StopReason {
  NONE,            ///< it has not ended, or the caller ended it
  AT_REST,         ///< forces, speed and shape are within their tolerances
  AT_REST_COARSE,  ///< at rest on a coarser mesh, and clear of body and cloth on the given one
  AT_REST_UNCLEAN, ///< at rest, but the audit found cloth in the body or through itself
  AT_REST_AFTER_UNCLEAN_FRAMES, ///< the same in earlier frames of a motion
  /// At rest, but stretched beyond what the fabric bears: see DrapeReport::stop_detail.
  AT_REST_STRETCHED,
  /// At rest, but a roll line is not turned over: see DrapeReport::stop_detail.
  AT_REST_UNTURNED,
  /// At rest, but of panels that are at fault: see DrapeReport::stop_detail.
  AT_REST_AT_FAULT,
  STEP_LIMIT,       ///< DrapeSettings::max_steps
  TIME_LIMIT,       ///< DrapeSettings::max_seconds
  INTERRUPTED,      ///< the user asked for it
  NOT_FINITE,       ///< a step gave a value that is not finite; it was undone
  STALLED,          ///< the residual has not improved for STALLED_STEPS
  STUCK,            ///< nothing could move for UNMOVED_STEPS
  MISFIT,           ///< beyond FitBounds: see DrapeReport::misfit
  NOTHING_CROSSED,  ///< untangle_only(): there was nothing to do
  NOTHING_CROSSES,  ///< untangle_only(): done
  CROSSINGS_REMAIN, ///< untangle_only(): not all could be drawn apart
  PLACED_ONLY,      ///< retarget-garment --no-drape
  NOT_DRAPED,       ///< no drape could make it fit: see DrapeReport::stop_detail
};

/// Which of FitBounds a garment is beyond.
enum class Misfit {
  NONE,
  SLIDES_DOWN,
  STAYS_STRETCHED,
};

/// Without a residual that is a tenth less, and more than the weight.
inline constexpr int STALLED_STEPS = 400;
inline constexpr int UNMOVED_STEPS = 25; ///< one after the other in which nothing can move at all

/// "slides down", "stays stretched", or nothing
std::string misfit_text(Misfit misfit);

} // namespace sloper::garment
