#pragma once
/// Where the trunk stands out most, in front or behind, by level sections.
#include <body/landmarks/landmark_finder.hpp>
namespace sloper::body {

/// The place of a trunk that stands out most.
struct Foremost {
  Vec3 p;           ///< on the skin, body frame
  double spread_m;  ///< root mean square height of what is as far out, about p: the place is no
                    ///< better known than that
  double low, high; ///< heights between which the skin is as far out, m
};

/// Heights, or places across, between which it is searched, m.
struct Span {
  double low, high;
};

/// The middle of what is as far out as the farthest, the farther the heavier: the single farthest
/// sample of a flat front is anywhere on it, and half a degree or a coarser mesh moves it from one
/// end to the other. Where the trunk only runs out towards an end of the heights, the belly under a
/// chest or the chest over a belly, the farthest place inside of them is the better answer, if
/// there is one and it stands out hardly less.
/// @param heights,across y and x within which the skin is asked, body frame, m
/// @param sign 1 for the front, -1 for the back
/// @param flat of stature, > 0: how much less far out still counts
/// @param inside of stature: how much less far out a place inside of the heights may be than the
/// end that the trunk runs out to
/// @return nothing where there is no trunk
std::optional<Foremost> foremost_place(const Finder& finder, Span heights, Span across, double sign,
                                       double flat, double inside = 0.0036);

/// Heights, m, of all skin that would be as far out as `place` if the body leaned by up to `lean`
/// more: which of them is foremost is a matter of how the body stands.
/// @param heights,across,sign,flat as of foremost_place()
/// @param lean rad
Span as_far_if_leaning(const Finder& finder, Span heights, Span across, double sign,
                       const Vec3& place, double flat, double lean);

} // namespace sloper::body
