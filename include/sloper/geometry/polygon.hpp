#pragma once
/// Polygons in the plane.
/// Test: tests/geometry/test_polygon.cpp
#include <sloper/geometry/types.hpp>

#include <vector>

namespace sloper {

/// Area of a polygon, m2, clockwise or counterclockwise.
/// @param points  #P by 2, m
/// @param loop    indices of its corners in order, closed implicitly; fewer than 3 have none
double polygon_area(const std::vector<Vec2>& points, const std::vector<int>& loop);

} // namespace sloper
