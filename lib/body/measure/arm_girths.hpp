#pragma once
/// Wrist and elbow by the arm's girth.
#include <optional>
#include <sloper/body/measure/arm_trace.hpp>
namespace sloper::body {

/// Where the wrist is: behind the widest of the hand the girth falls to its least. A fist is short,
/// and a stout forearm may be wider than it: there the widest before the deepest fall is the palm.
/// @param least_to_palm  a wrist's girth is at most this share of the palm's
/// @param s  stature, m
/// @return m along the arm from the hand's tip; empty where the girth does not fall
/// Test: tests/body/measure/test_arm_girths.cpp
std::optional<double> wrist_by_girth(const ArmTrace& arm, double least_to_palm, double s);

/// Where the upper arm starts to swell above the elbow: the steepest rise of girth past the
/// forearm's belly.
/// @param s  stature, m
/// @param wrist  m along the arm from the hand's tip
/// @return m along the arm; empty where the girth does not rise
std::optional<double> elbow_by_girth(const ArmTrace& arm, double s, double wrist);

/// Of the usual length from shoulder to wrist: a shorter arm without a hand ends in the forearm or
/// above it.
constexpr double SHORT_ARM = 0.95;

/// How far the elbow is from the shoulder joint of an arm without a hand, m: a share of the arm
/// where it ends about the wrist, and as far as people's where it is shorter than an arm.
/// @param reach  of the arm's end from the shoulder joint, m
/// @param usual  from the shoulder joint to the wrist, m
/// @param share  of the upper arm in that
double upper_arm_without_hand(double reach, double usual, double share);

} // namespace sloper::body
