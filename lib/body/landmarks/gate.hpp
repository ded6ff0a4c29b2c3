#pragma once
/// The last look at a measured body: is what was found a person who stands upright? Proportions,
/// order and posture of the landmarks, each within wide bounds; what lies outside is named, so that
/// nobody who squats and no statue is measured in silence.
#include <sloper/body/body.hpp>
namespace sloper::body {

/// @param strangeness of the shape to the bodies that the rules were learned from
/// (Corrections::strangeness)
/// @return findings of severity "error" for what cannot be right, with the place; "warning" for
/// what is doubtful. Landmarks that are missing are not asked
std::vector<Finding> doubts_of(const Body& body, double strangeness);

} // namespace sloper::body
