#pragma once
/// Whether the crotch that the slices show is the body's: thighs that touch, and holes, put it too
/// low.
#include <sloper/body/body.hpp>
#include <sloper/body/landmarks/rules.hpp>
#include <sloper/body/measure/level_stack.hpp>
namespace sloper::body {

/// What tells of a crotch.
struct CrotchEvidence {
  /// The scan's own points about the height of a crotch, body frame, m.
  const std::vector<Vec3>& scan_points;
  /// Where the tree has "below_buttocks" off it is never moved, where it has it first always.
  const Rules& rules;
  bool rebuilt; ///< the skin is not the scan's own
  bool whole;   ///< the skin is the scan's own and had no holes: only touching thighs can hide the
                ///< crotch
};

/// Moves the crotch of `levels` where the scan does not show it, by the level of the buttocks.
/// @return true when it was moved; then a finding and a line of the trail say why
bool doubt_crotch(LevelStack& levels, const CrotchEvidence& evidence,
                  std::vector<Finding>& findings, std::vector<std::string>& trail);

} // namespace sloper::body
