#pragma once
/// The shape of a body in numbers that need no landmark: the input of the learned
/// corrections (corrections.hpp).
#include <sloper/body/measure/arm_trace.hpp>
#include <string>
#include <vector>
namespace sloper::body {

/// One row of numbers a side, in the order of shape_feature_names(): lengths as shares of
/// stature, in a frame whose x points to that side, so that both sides share their
/// meaning; directions and ratios as they are. NaN where the body does not show it.
struct ShapeFeatures {
  std::array<std::vector<double>, 2> side; ///< left, right
};

/// Names of the columns of ShapeFeatures::side.
const std::vector<std::string>& shape_feature_names();

/// The features of one body.
/// @param levels  of a skin whose crotch is known; without one every number is NaN
/// @param arms  left, right
/// @param female  0 male .. 1 female proportions
ShapeFeatures shape_features(const LevelStack& levels, const std::array<ArmTrace, 2>& arms,
                             double female);

} // namespace sloper::body
