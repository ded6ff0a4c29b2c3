#pragma once
/// The free edges of a garment on its body: heights of hems, how far sleeves and legs reach,
/// whether it hangs level.
#include <sloper/body/body.hpp>
#include <sloper/garment/garment.hpp>

#include <array>

namespace sloper::garment {

struct FitHem {
  std::string name; ///< "hem", "top", "neck", "left sleeve", "left leg", with a number where there
                    ///< are several
  double height_m = 0, lowest_m = 0, highest_m = 0;
  double length_m = 0;           ///< along the edge, as it lies
  double front_minus_back_m = 0; ///< mean height of its front half less that of its back half
  double left_minus_right_m = 0;
  double uncertainty_m = 0;              ///< half a mesh edge
  std::vector<std::array<int, 2>> edges; ///< its particles, in no order
};

struct FitLines {
  std::vector<FitHem> hems;
  /// Share of the limb that is covered, 0..1: arm from shoulder to wrist, leg from crotch to ankle
  /// (inseam). By "sleeve_l", "inseam_r".
  std::map<std::string, double> coverage;
  std::map<std::string, double> coverage_m; ///< the same as lengths
};

/// @param garment bound to `body`
FitLines fit_lines(const Garment& garment, const body::Body& body);

} // namespace sloper::garment
