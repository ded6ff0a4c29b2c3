#pragma once
/// How far a garment at rest is stretched, and whether that is what was meant by draping it.
#include <sloper/garment/drape/drape_job.hpp>
#include <sloper/garment/inputs.hpp>

namespace sloper::garment {

/// Along warp or weft, l/l0 - 1 (cloth_strain.hpp): of each triangle the larger; cloth that is
/// pressed together counts as 0.
struct Stretch {
  double p99 = 0;            ///< what all but a hundredth of the cloth stays below
  double max = 0;            ///< of one triangle
  Vec3 place = Vec3::Zero(); ///< of that triangle, m
  std::string panel;         ///< where it is stretched most, by its own p99
  double panel_p99 = 0;
  double bound = 0; ///< beyond which no fabric here is worn: a tenth, or what 100 N/m stretch it
                    ///< by, where it gives more
};
Stretch stretch_of(const Garment& garment);

/// Stretch::p99 of a garment as it hung on another body; nothing where it comes from panels or hung
/// on this skin. @param skin_sha256 of the body
std::optional<double> stretch_elsewhere(const Garment& garment, const std::string& skin_sha256);

/// Looks at a drape that has ended. Where the garment comes from another body and is now stretched
/// further than woven cloth bears (5 %) and by half as much again as it was there, it has not been
/// put on by draping it: that is a finding, and what came to rest counts as failed (converged is
/// false in garment, report and document, with the reason). Any other garment that came to rest
/// stretched beyond its bound is a finding alone: it may be meant.
/// @param before  of stretch_elsewhere()   @param findings  gets what is found, which is a warning
/// too
void judge_stretch(Garment& garment, DrapeOutcome& outcome, const Start& start,
                   std::optional<double> before, std::vector<std::string>& findings,
                   Reporter& reporter);

} // namespace sloper::garment
