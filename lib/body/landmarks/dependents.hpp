#pragma once
/// Landmarks that rest on others share their doubts.
#include <sloper/body/body.hpp>
#include <vector>
namespace sloper::body {

/// Lowers the confidence of landmarks that depend on one named in a warning, and of those that two
/// rules put in different places:
/// - bust_prominent rests on bust_point, neck_side and neck_center on neck_back and neck_front,
///   olecranon on elbow, axilla_merge on axilla: their confidence is at most that of what they rest
///   on, and a warning names them too;
/// - where level sections of arm and trunk join well below the arm pit, both touch there;
/// - where the scan's own skin has grown together between the legs, it may have at the arm pits.
/// Where the shape is farther from the bodies learned from than 97 of 100 of them, landmarks other
/// than terminal points have a lower confidence.
/// @param body with its findings and the final confidence of its landmarks; changed
/// @param strangeness Corrections::strangeness()
/// @param pits_are_low pits_are_low(), made_up_skin.hpp
void doubt_dependents(Body& body, double strangeness, bool pits_are_low = false);

} // namespace sloper::body
