#pragma once
/// Landmarks on skin that the scan does not show: a hole that was closed, or a gap that a rebuilt
/// skin spans.
#include <sloper/body/body.hpp>
#include <sloper/body/landmarks/corrections.hpp>
namespace sloper::body {

/// Warns of each landmark of the skin that lies near a place of body.skin from which the scan's
/// points are far, where nothing has warned of it, and widens its spread to that distance: the arm
/// pits of a scan with holes there were 4 cm too low, where the closed skin has its fold. Crown and
/// feet are left out: what was cut off there changes them by millimetres.
/// @param points, on_faces  of the scan's body: its vertices, and points spread over its larger
/// faces, body frame, m
/// @param confirmed  landmarks that a second method confirms: they are not warned of
void doubt_made_up_skin(Body& body, const std::vector<Vec3>& points,
                        const std::vector<Vec3>& on_faces,
                        const std::vector<std::string>& confirmed);

/// The arm pits, with their folds, that are as high as head and shoulders let expect
/// ("axilla_by_shoulders" of the corrections), which no closed gap beside the arm changes.
/// @param features of the same body
std::vector<std::string> confirmed_pits(const Body& body, const Corrections& corrections,
                                        const ShapeFeatures& features);

} // namespace sloper::body
