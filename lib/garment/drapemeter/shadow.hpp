#pragma once
/// What a drapemeter sees: the shadow of cloth from above, and the folds of its rim.
#include <sloper/geometry/types.hpp>
#include <vector>

namespace sloper::garment {

/// Area of the shadow of triangles on the floor, seen along y, m2; by square cells whose middles
/// are tested. @param cell_m  > 0   @param hole_radius_m  cells nearer than this to the y axis do
/// not count; 0 for none
double shadow_area(const std::vector<Triangle>& triangles, const std::vector<Vec3>& position,
                   double cell_m, double hole_radius_m = 0);

/// Folds of a closed line around its middle, seen along y: how often its distance from there swings
/// out of the mean by more than `swing_m` after it was inside by as much.
/// @param rim  at least 3 points, in order; level, or nearly so
int count_folds(const std::vector<Vec3>& rim, double swing_m = 0.002);

} // namespace sloper::garment
