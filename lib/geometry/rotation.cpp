#include <sloper/geometry/rotation.hpp>

#include <sloper/base/units.hpp>

#include <Eigen/SVD>
#include <algorithm>
#include <cmath>

namespace sloper {

Eigen::Quaterniond rotation_between(const Vec3& from, const Vec3& to) {
  return Eigen::Quaterniond::FromTwoVectors(from, to);
}

Mat3 nearest_rotation(const Mat3& covariance) {
  const Eigen::JacobiSVD<Mat3> svd(covariance, Eigen::ComputeFullU | Eigen::ComputeFullV);
  Mat3 v = svd.matrixV();
  if ((v * svd.matrixU().transpose()).determinant() < 0)
    v.col(2) *= -1;
  return v * svd.matrixU().transpose();
}

double degrees_between(const Vec3& a, const Vec3& b) {
  return units::degrees(std::acos(std::clamp(a.dot(b) / (a.norm() * b.norm()), -1.0, 1.0)));
}

} // namespace sloper
