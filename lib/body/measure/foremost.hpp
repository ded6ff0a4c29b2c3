#pragma once
/// Where the trunk stands out most, in front or behind, by level sections.
#include <body/landmarks/landmark_finder.hpp>
namespace sloper::body {

/// The place of a trunk that stands out most.
struct Foremost {
  Vec3 p;            ///< on the skin, body frame
  double spread_m;   ///< root mean square height of what is as far out, about p: the place is no
                     ///< better known than that
  double low, high;  ///< heights between which the skin is as far out, m
  double median = 0; ///< of the heights of likely_foremost(), m
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

/// What is not known where the trunk's foremost place is sought: standard deviations.
struct Doubt {
  double low_m, high_m; ///< of either end of the heights
  double lean;          ///< rad, of the vertical
};

/// The mean of the foremost places over what is not known of the heights and of the vertical
/// (normal, by seven quantiles of each), `sign` before or behind by the likeliest vertical. Where a
/// millimetre decides between two places far apart the mean lies between them: it is never off by
/// their whole distance, and nothing jumps.
/// @param heights,across,sign,flat as of foremost_place(); of the heights the likeliest
/// @return `spread_m` the standard deviation of their heights, `low` and `high` the outermost of
/// them; nothing where there is no trunk
std::optional<Foremost> likely_foremost(const Finder& finder, Span heights, Span across,
                                        double sign, double flat, const Doubt& doubt);

} // namespace sloper::body
