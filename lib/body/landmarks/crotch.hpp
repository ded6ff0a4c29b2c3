#pragma once
/// Whether the crotch that the slices show is the body's: thighs that touch, and holes, put it too
/// low.
#include <sloper/body/body.hpp>
#include <sloper/body/landmarks/corrections.hpp>
#include <sloper/body/landmarks/rules.hpp>
#include <sloper/body/measure/level_stack.hpp>
namespace sloper::body {

/// Where the height of a crotch is from.
enum class CrotchSource { SKIN, BUTTOCKS, REST_OF_BODY };

/// What tells of a crotch.
struct CrotchEvidence {
  /// The scan's own points about the height of a crotch, body frame, m.
  const std::vector<Vec3>& scan_points;
  /// Where the tree has "below_buttocks" off it is never moved, where it has it first always.
  const Rules& rules;
  bool rebuilt; ///< the skin is not the scan's own
  bool whole;   ///< the skin is the scan's own and had no holes: only touching thighs can hide the
                ///< crotch
  /// Corrections::crotch_at_an_end()
  double at_an_end = 0;
};

/// Moves the crotch of `levels` where the scan does not show it, by the level of the buttocks.
/// @return true when it was moved; then a finding and a line of the trail say why
bool doubt_crotch(LevelStack& levels, const CrotchEvidence& evidence,
                  std::vector<Finding>& findings, std::vector<std::string>& trail);

/// The second way: where the crotch was estimated, or lies under thin skin that spans the gap
/// between thighs, it is put at the height that the rest of the body lets expect. How far back it
/// lies there is decided between both ends of the trunk's underside, by the seat; on rebuilt skin
/// that shows it far from there a warning says so. Of a body whose crotch lies at an end, skin that
/// shows it between both is rounded: a warning says so, and on rebuilt skin it is drawn to the end.
/// @param source in and out
/// @return true when the crotch was moved; then a finding and a line of the trail say why
bool expect_crotch(LevelStack& levels, const Corrections::Expected& expected,
                   const CrotchEvidence& evidence, CrotchSource& source,
                   std::vector<Finding>& findings, std::vector<std::string>& trail);

} // namespace sloper::body
