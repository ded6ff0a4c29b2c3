#pragma once
/// The foremost place of the belly, the rearmost of the seat, and the largest girth.
#include <body/landmarks/landmark_finder.hpp>
namespace sloper::body {

/// Puts abdomen_front, buttock_back and hip_section_center, and the levels "abdomen", "hip" and
/// "hip_girth_max".
/// @param crotch,waist heights between which they are, m
void find_seat_and_belly(const Finder& f, double crotch, double waist);

} // namespace sloper::body
