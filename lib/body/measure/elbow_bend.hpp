#pragma once
/// Where and how much an arm is bent at its elbow, by its centre line.
/// Test: tests/body/landmarks/test_gate.cpp
#include <optional>
#include <sloper/body/measure/arm_trace.hpp>
namespace sloper::body {

/// Bend of an elbow that tells nothing: 15 degrees, as the length of the bend's vector.
constexpr double STRAIGHT_ELBOW = 0.26;

/// Where the arm is bent most near `around`, with how much it is bent there; nothing where it is
/// straight.
/// @param arm  traced
/// @param s  stature, m
/// @param around  m from the hand along the centre line
/// @return m along the centre line, and twice the sine of half the angle
std::optional<Vec2> elbow_by_bend(const ArmTrace& arm, double s, double around);

/// The direction in which the elbow's point lies, unit: the outer side of the bend, of a straight
/// arm the rear. Arguments as above.
Vec3 elbow_faces(const ArmTrace& arm, double along, double s);

} // namespace sloper::body
