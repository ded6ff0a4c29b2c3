#pragma once
/// A drape as accurate as asked for, or as accurate as there is time for: from preset to preset,
/// each going on from the one before, until the cloth moves less than it may.
///
/// How far the cloth moves from one preset to the next says how far the coarser one was from the
/// finer. What remains after the finer one is of that size too: on samples the moves of all presets
/// that follow add up to 0.3 to 1.3 times the last one, because a drape that goes on from rest
/// creeps (docs/accuracy-cost.md). MARGIN, on top, covers that; a goal needs two presets at least.
/// Test: tests/garment/drape/test_accuracy.cpp
#include <functional>
#include <sloper/garment/drape/drape.hpp>

namespace sloper::garment {

struct AccuracyGoal {
  double max_error_m = 0; ///< root mean square over the particles, against the preset "reference"
                          ///< going on from the same state; 0: none
  double max_seconds = 0; ///< wall clock for all of it; 0: none
};

struct AccuracyReport {
  DrapeReport drape; ///< of the last preset, with steps, times, calls and repairs of all
  /// {"max_error_m", "max_seconds", "margin", "presets": [{"accuracy", "converged", "wall_s",
  /// "moved_rms_m", "moved_max_m"}],
  ///  "error_estimate_m" (null when only one preset ran), "met"}
  io::Json achieved;
  bool met = false; ///< at rest, and the estimate is within what was asked
};

/// What an estimate is multiplied with before it is compared.
inline constexpr double ACCURACY_MARGIN = 2;

/// Without max_error_m: draft, and standard when there is time for it. @param adjust  called with
/// each preset's settings, to set knobs that stay
/// @throws Error as drape()
AccuracyReport drape_to_goal(Garment& garment, const body::Body* body, const AccuracyGoal& goal,
                             const std::function<void(DrapeSettings&)>& adjust, Reporter& reporter);

} // namespace sloper::garment
