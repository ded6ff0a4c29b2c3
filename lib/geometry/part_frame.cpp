#include <sloper/geometry/part_frame.hpp>

#include <cmath>

namespace sloper {

PartCoordinates PartFrame::coordinates(const Vec3& p) const {
  const Vec3 a = axis(), d = p - lower, side = a.cross(theta_zero);
  const double z = d.dot(a), x = d.dot(theta_zero), y = d.dot(side);
  return {std::hypot(x, y), mirrored ? std::atan2(-y, x) : std::atan2(y, x), z / length()};
}

Vec3 PartFrame::point(const PartCoordinates& c) const {
  const Vec3 a = axis(), side = a.cross(theta_zero);
  const double theta = mirrored ? -c.theta : c.theta;
  return lower + c.z * length() * a + c.r * (std::cos(theta) * theta_zero + std::sin(theta) * side);
}

PartFrame make_part_frame(const Vec3& lower, const Vec3& upper, const Vec3& forward,
                          bool mirrored) {
  PartFrame frame{lower, upper, Vec3::UnitZ(), mirrored};
  const Vec3 a = frame.axis();
  Vec3 zero = forward - forward.dot(a) * a;
  if (zero.norm() < 1e-6)
    zero = Vec3::UnitY() - a.y() * a;
  frame.theta_zero = zero.normalized();
  return frame;
}

} // namespace sloper
