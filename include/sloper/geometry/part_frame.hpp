#pragma once
/// The cylindrical frame of a body part and its coordinates r, theta, z (Sul et al. 2010, Table 2
/// and Figure 3).
///
/// axis a = (U - L)/|U - L|; z = (p - L).a/|U - L|, 0 at L and 1 at U, unbounded; theta = angle
/// about a from `theta_zero`, right-handed about a, its sign turned where `mirrored`, so that left
/// and right parts share coordinates; r = distance from the axis, m.
/// Test: tests/geometry/test_part_frame.cpp
#include <sloper/geometry/types.hpp>
namespace sloper {

/// Cylindrical coordinates of a point in a PartFrame.
struct PartCoordinates {
  double r;     ///< m, from the axis
  double theta; ///< rad, (-pi, pi], 0 at theta_zero
  double z;     ///< fraction of |U - L|
};

/// The frame of one part.
struct PartFrame {
  Vec3 lower = Vec3::Zero();       ///< L, m
  Vec3 upper = Vec3(0, 1, 0);      ///< U, m
  Vec3 theta_zero = Vec3(0, 0, 1); ///< unit, square to the axis
  bool mirrored = false;           ///< right-hand parts

  /// |U - L|, m, and the unit axis from L to U.
  double length() const { return (upper - lower).norm(); }
  /// Unit axis from L to U.
  Vec3 axis() const { return (upper - lower) / length(); }
  /// Coordinates of a point, m.
  PartCoordinates coordinates(const Vec3& p) const;
  Vec3 point(const PartCoordinates& c) const; ///< inverse of coordinates()
};

/// A frame whose theta = 0 is `forward` made square to the axis (+y where forward is
/// along the axis).
/// @param lower, upper  L and U, m, not the same point
/// @param mirrored  theta runs in the opposite sense, as on right limbs
PartFrame make_part_frame(const Vec3& lower, const Vec3& upper, const Vec3& forward, bool mirrored);

} // namespace sloper
