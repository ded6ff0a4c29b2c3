#pragma once
/// How far a garment at rest is stretched, and whether draping alone can have put it on.
/// Test: tests/garment/fit/test_stretch.cpp
#include <sloper/base/message.hpp>
#include <sloper/garment/drape/drape_job.hpp>
#include <sloper/garment/inputs.hpp>

namespace sloper::garment {

/// Strain along warp or weft, l/l0 - 1, as fit reports and maps have it (cloth_strain.hpp), and at
/// least 0: compressed cloth counts as 0, and cloth that a gather presses together is not
/// stretched.
struct Stretch {
  double p99 = 0;            ///< what all but a hundredth of the cloth stays below
  double max = 0;            ///< of a place, the triangles around one particle
  Vec3 place = Vec3::Zero(); ///< that particle, m
  std::string place_panel;   ///< its panel; at a seam the first of those sewn there
  std::string panel;         ///< where it is stretched most, by its own p99
  double panel_p99 = 0;      ///< of that panel
  /// Strain beyond which no fabric here is worn: a tenth, or the strain at 100 N/m of
  /// tension where that is more.
  double bound = 0;
};
/// Measures the garment at its present positions.
Stretch stretch_of(const Garment& garment);

/// The text of a finding on a garment that is stretched at one place alone: there by three times
/// its bound or more, while its p99 is within the bound.
/// @return empty for any other garment
std::optional<std::string> stretched_place(const Stretch& stretch);

/// Stretch::p99 of a garment as it hung on another body; nothing where it comes from panels or hung
/// on this skin. @param skin_sha256 of the body
std::optional<double> stretch_elsewhere(const Garment& garment, const std::string& skin_sha256);

/// Judges a drape that has ended. A garment that comes from another body and is now
/// stretched further than woven cloth bears (5 %), and by half as much again as it was
/// there, has not been put on by draping it: that is a finding, and the drape counts as
/// failed (converged is false in garment, report and document, with the reason). Any
/// other garment at rest that is stretched beyond its bound is a finding alone: it may be
/// meant. So is one place of any garment (stretched_place()).
/// @param before  of stretch_elsewhere()
/// @param findings  receives the findings, each of which is a warning too
/// @param outcome  of do_drape(), in and out
/// @param start  of the garment, for its files' names
void judge_stretch(Garment& garment, DrapeOutcome& outcome, const Start& start,
                   std::optional<double> before, std::vector<Message>& findings,
                   Reporter& reporter);

} // namespace sloper::garment
