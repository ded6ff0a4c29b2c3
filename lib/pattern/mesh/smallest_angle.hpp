#pragma once
/// How good a triangle in the plane is.
#include <sloper/geometry/types.hpp>

namespace sloper::pattern {

/// Smallest angle of a triangle, rad; 0 for one that has no area or is clockwise.
double smallest_angle(const Vec2& a, const Vec2& b, const Vec2& c);

} // namespace sloper::pattern
