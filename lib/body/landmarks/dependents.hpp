#pragma once
/// Landmarks that rest on others share their doubts.
#include <sloper/body/body.hpp>
#include <vector>
namespace sloper::body {

/// Doubts what rests on a landmark that is named in a warning, and what two ways put apart:
/// - bust_prominent rests on bust_point, neck_side and neck_center on neck_back and neck_front,
///   olecranon on elbow, axilla_merge on axilla: their confidence is at most that of what they rest
///   on, and a warning names them too;
/// - where level sections of arm and trunk join well below the arm pit, both touch there.
/// Where the shape is stranger than the bodies learned from, what is not a terminal point is
/// believed less.
/// @param body with its findings and the final confidence of its landmarks; changed
/// @param strangeness Corrections::strangeness()
void doubt_dependents(Body& body, double strangeness);

} // namespace sloper::body
