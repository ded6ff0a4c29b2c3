#pragma once
/// What a body's shape tells before any landmark is known: the numbers that the learned corrections
/// of landmarks look at.
#include <sloper/body/measure/arm_trace.hpp>
#include <string>
#include <vector>
namespace sloper::body {

/// One row of numbers a side, in the order of shape_feature_names(): lengths as shares of stature,
/// in a frame whose x points to that side, so that both sides share what they mean; directions and
/// shares as they are. NaN where the body does not show it.
struct ShapeFeatures {
  std::array<std::vector<double>, 2> side;
};

const std::vector<std::string>& shape_feature_names();

/// @param female 0 male .. 1 female proportions
/// @param levels of a skin whose crotch is known; without one every number is NaN
ShapeFeatures shape_features(const LevelStack& levels, const std::array<ArmTrace, 2>& arms,
                             double female);

} // namespace sloper::body
