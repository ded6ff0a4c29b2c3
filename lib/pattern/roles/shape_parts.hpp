#pragma once
/// The parts of a garment that shapes tell apart.
#include <cstddef>

namespace sloper::pattern {

inline constexpr std::size_t SHAPE_PARTS = 5;
inline constexpr const char* SHAPE_PART_NAMES[SHAPE_PARTS] = {"torso", "arm", "neck", "lower_body",
                                                              "leg"};
inline constexpr std::size_t TORSO_PART = 0, ARM_PART = 1, NECK_PART = 2, LOWER_BODY_PART = 3,
                             LEG_PART = 4; ///< of SHAPE_PART_NAMES

} // namespace sloper::pattern
