#pragma once
/// Bust points, the foremost places of the chest and the fold under the breast.
#include <body/landmarks/landmark_finder.hpp>
namespace sloper::body {

/// Puts bust_point and bust_prominent of both sides and the level "bust".
/// @param pit mean height of the arm pits, m; 0 where none was found
void find_bust(const Finder& f, double pit);
/// Height of the fold under the breast, m: below the bust point, where the front turns from
/// falling back to falling straight.
/// @param bust_y height of the bust, m
/// @param expected height, m, that a side without a fold is taken to have
std::optional<double> breast_fold(const Finder& f, double bust_y, double expected);

} // namespace sloper::body
