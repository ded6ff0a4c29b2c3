#pragma once
/// The free edges of a garment on its body: heights of hems, reach of sleeves and legs,
/// balance.
#include <sloper/body/body.hpp>
#include <sloper/garment/garment.hpp>

#include <array>

namespace sloper::garment {

/// One free edge of the garment as it lies.
struct FitHem {
  /// "hem", "top", "neck", "left sleeve", "left leg", with a number where there are
  /// several.
  std::string name;
  /// Mean, least and greatest above the soles.
  double height_m = 0, lowest_m = 0, highest_m = 0;
  double length_m = 0;           ///< along the edge, as it lies
  double front_minus_back_m = 0; ///< mean height of its front half less that of its back half
  /// The same of its left and right half, the body's own sides.
  double left_minus_right_m = 0;
  double uncertainty_m = 0;              ///< half a mesh edge
  std::vector<std::array<int, 2>> edges; ///< its particles, in no order
};

/// All free edges, and how far sleeves and legs reach.
struct FitLines {
  std::vector<FitHem> hems; ///< one per free edge
  /// Share of the limb that is covered, 0..1, by "sleeve_l", "inseam_r", ...: arm from
  /// shoulder to wrist, leg from crotch to ankle.
  std::map<std::string, double> coverage;
  std::map<std::string, double> coverage_m; ///< the same as lengths
};

/// Measures the free edges.
/// @param garment  bound to `body`
FitLines fit_lines(const Garment& garment, const body::Body& body);

} // namespace sloper::garment
