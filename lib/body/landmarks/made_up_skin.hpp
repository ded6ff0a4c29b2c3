#pragma once
/// Landmarks on skin that the scan does not show: a hole that was closed, or a gap that a rebuilt
/// skin spans.
#include <sloper/body/body.hpp>
namespace sloper::body {

/// Warns of each landmark of the skin that lies near a place of body.skin from which the scan's
/// points are far, where nothing has warned of it, and widens its spread to that distance: the arm
/// pits of a scan with holes there were 4 cm too low, where the closed skin has its fold. Crown and
/// feet are left out: what was cut off there changes them by millimetres.
/// @param points, on_faces  of the scan's body: its vertices, and points spread over its larger
/// faces, body frame, m
void doubt_made_up_skin(Body& body, const std::vector<Vec3>& points,
                        const std::vector<Vec3>& on_faces);

} // namespace sloper::body
