#pragma once
/// How unlike a body's left and right are, against what a tailor grades.
#include <sloper/body/body.hpp>

namespace sloper::garment {

inline constexpr double GRADED_SIDES_M =
    0.02; ///< left and right may differ by so much, beside their uncertainty, before each has a
          ///< pattern of its own

/// A limb that is not as long, or as wide, on both sides.
struct SideDifference {
  std::string limb; ///< "arm", "leg" or "torso": the panels on it
  std::string text; ///< "the left arm is 3.1 cm longer than the right one"
};

/// Lengths of arms, shoulders and legs, girths of arms and legs whose left and right differ by more
/// than GRADED_SIDES_M and twice what their landmarks or girths are uncertain by. Nothing for what
/// the body lacks.
std::vector<SideDifference> uneven_sides(const body::Body& body);

} // namespace sloper::garment
