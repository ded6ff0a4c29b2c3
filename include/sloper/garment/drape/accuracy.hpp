#pragma once
/// A drape as accurate as asked for, or as accurate as there is time for: preset after
/// preset, each started from the rest state of the one before, until the cloth moves less
/// than the goal.
///
/// The distance that the cloth moves from one preset to the next measures how far the
/// coarser one was from the finer. What remains after the finer one is of that size too:
/// on samples the moves of all presets that follow add up to 0.3 to 1.3 times the last
/// one, because a drape restarted from rest creeps (docs/accuracy-cost.md).
/// ACCURACY_MARGIN covers that; a goal needs two presets at least. Test:
/// tests/garment/drape/test_accuracy.cpp
#include <functional>
#include <sloper/garment/drape/drape.hpp>

namespace sloper::garment {

/// What to reach; the drape ends at the first of the two.
struct AccuracyGoal {
  /// Root mean square distance over the particles from the rest state of the preset
  /// "reference", restarted from the same state, m; 0: no such goal.
  double max_error_m = 0;
  double max_seconds = 0; ///< wall clock for all of it; 0: none
};

/// Result of drape_to_goal().
struct AccuracyReport {
  DrapeReport drape; ///< of the last preset, with steps, times, calls and repairs of all
  /// `accuracy` of report.json: goal, margin, the presets with wall seconds and
  /// displacements, error_estimate_m (null when only one preset ran), met.
  io::Json achieved;
  bool met = false; ///< at rest, and the estimate is within what was asked
};

/// Factor on the estimate before it is compared with the goal.
inline constexpr double ACCURACY_MARGIN = 2;

/// Drapes preset after preset until the goal is met or the time is over. Without
/// max_error_m: draft, and standard when there is time for it.
/// @param garment  in and out, as for drape()
/// @param adjust  called with each preset's settings, to set knobs that stay
/// @throws Error as drape()
AccuracyReport drape_to_goal(Garment& garment, const body::Body* body, const AccuracyGoal& goal,
                             const std::function<void(DrapeSettings&)>& adjust, Reporter& reporter);

} // namespace sloper::garment
