#pragma once
/// A second way to the acromion: where the top of the shoulder turns down into the arm.
#include <body/landmarks/landmark_finder.hpp>
namespace sloper::body {

/// The skin straight above (x, z), below the head.
std::optional<Vec3> top_of_shoulder(const TriangleMesh& skin, double stature, double x, double z);

/// Where, going inward, the outline of the shoulder in the frontal plane z = `depth` first falls as
/// little as it does at an acromion: the lower the arm hangs, the steeper (numbers
/// acromion.slope...).
/// @param middle  x of the neck's middle, m
/// @param outward 1 on the left, -1 on the right
/// @param raised  angle of the upper arm from hanging, degrees
/// @param lean    angle of the trunk to the left, degrees
/// @return distance from `middle`, m; nothing where the outline turns nowhere within reach
std::optional<double> acromion_aside_by_slope(const Finder& f, double depth, double middle,
                                              double outward, double raised, double lean);

/// Moves the acromion of a side, which is found, towards where the slope puts it: mostly for a
/// hanging arm, not at all for a level one. What both say of each other becomes part of the
/// confidence; where they are far apart, a warning.
void weigh_acromion_by_slope(const Finder& f, int side, double raised);

} // namespace sloper::body
