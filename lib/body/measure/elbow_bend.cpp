#include <body/measure/elbow_bend.hpp>

#include <algorithm>

namespace sloper::body {

namespace {

/// How far the arm's centre line is bent at `along`: towards the bend's outer side, twice the sine
/// of half the angle long.
Vec3 bend_at(const ArmTrace& arm, double along, double s) {
  constexpr double BESIDE = 0.06; // of stature
  const Vec3 p = arm.at(along);
  return (p - arm.at(along + BESIDE * s)).normalized() +
         (p - arm.at(along - BESIDE * s)).normalized();
}

} // namespace

std::optional<Vec2> elbow_by_bend(const ArmTrace& arm, double s, double around) {
  constexpr double NEAR = 0.035, STEP = 0.003; // of stature
  double sum = 0, weight = 0, most = 0;
  for (double off = -NEAR; off <= NEAR; off += STEP)
    most = std::max(most, bend_at(arm, around + off * s, s).norm());
  if (most < STRAIGHT_ELBOW)
    return std::nullopt;
  for (double off = -NEAR; off <= NEAR; off += STEP)
    if (const double w = bend_at(arm, around + off * s, s).norm() - 0.8 * most; w > 0) {
      sum += w * (around + off * s);
      weight += w;
    }
  return Vec2(sum / weight, most);
}

Vec3 elbow_faces(const ArmTrace& arm, double along, double s) {
  constexpr double WHOLLY = 0.42; // 24 degrees
  const Vec3 bend = bend_at(arm, along, s);
  const double share =
      std::clamp((bend.norm() - STRAIGHT_ELBOW) / (WHOLLY - STRAIGHT_ELBOW), 0.0, 1.0);
  return ((1 - share) * -Vec3::UnitZ() + share * bend.normalized()).normalized();
}

} // namespace sloper::body
