#pragma once
/// The free edges of a garment on its body: heights of hems, reach of sleeves and legs,
/// balance.
#include <sloper/body/body.hpp>
#include <sloper/garment/garment.hpp>
#include <sloper/garment/simulate/roll_line_states.hpp>

#include <array>
#include <optional>

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

/// Where a hem, a sleeve or a leg ends on the limb that it hangs on.
struct FitLength {
  std::string name;  ///< "hem", "sleeve_l", "sleeve_r", "leg_l" or "leg_r"
  std::string place; ///< nearest joint or level: wrist, elbow, ankle, knee, crotch, hip or waist
  /// Along the limb, m: how far above that place it ends; negative: below it, or beyond the wrist.
  double above_m = 0, uncertainty_m = 0;
  /// The same on the body that the garment comes from; nothing where that is not known.
  std::optional<double> source_above_m = {};
  /// Against that body: "same", "shorter" or "longer" by more than 2 cm and the uncertainty; empty
  /// where it is not known.
  std::string verdict = {};
};

/// "ends 3.1 cm above the wrist, 2.9 cm higher than on the body that it comes from".
std::string length_text(const FitLength& length);

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

/// Whether the greater part of the neck's edge is that of a collar or lapel that is turned over its
/// roll line: its length is that of the leaf, and does not go round the neck.
/// @param rolled  roll_line_states() of the garment
bool lies_on_turned_leaf(const Garment& garment, const FitHem& hem,
                         const std::vector<RollLineState>& rolled);

/// Where hems, sleeves and legs end against the limb that they hang on, and against the body that
/// the garment comes from. Both are read from the binding: coordinates of the edge's particles
/// along the frames of arm, leg and trunk, in m from the joint that these frames share (wrist;
/// crotch), less those of the nearest joint or level. Test: tests/garment/fit/test_fit_lengths.cpp
/// @param hems    of fit_lines(); those of neck and top edge are left out
/// @param bind    of the garment on `body`
/// @param source  of the same particles on the body that the garment comes from; null: not known
/// @param convergence_m  how far the garment may still move, m
std::vector<FitLength> fit_lengths(const std::vector<FitHem>& hems, const Bind& bind,
                                   const Bind* source, const body::Body& body,
                                   double convergence_m);

} // namespace sloper::garment
