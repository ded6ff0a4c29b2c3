#pragma once
/// Rotations that need a singular value decomposition, kept in one source because it is
/// slow to compile.
#include <sloper/geometry/types.hpp>

namespace sloper {

/// The smallest rotation that takes the direction of `from` to that of `to`; for opposite ones any
/// half turn. Neither may be zero.
Eigen::Quaterniond rotation_between(const Vec3& from, const Vec3& to);

/// The rotation R nearest to a map that is known by its covariance sum_k a_k b_k^T: least sum |R
/// a_k - b_k|^2 (Sorkine and Alexa 2007, eq. 6).
Mat3 nearest_rotation(const Mat3& covariance);

/// The angle between two directions of any length but zero, 0 to 180 degrees.
double degrees_between(const Vec3& a, const Vec3& b);

} // namespace sloper
