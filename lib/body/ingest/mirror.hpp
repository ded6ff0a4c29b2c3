#pragma once
/// The plane in which a trunk is its own mirror image, from points in (about) the body frame.
#include <optional>
#include <sloper/geometry/types.hpp>
#include <vector>
namespace sloper::body {

/// Mean position and the 2x2 covariance of horizontal points, each occupied cell (of side `cell`,
/// in the points' unit) counted once.
struct Moments {
  Vec2 mean = Vec2::Zero();
  double xx = 0, xz = 0, zz = 0;
  int n = 0;
};
Moments moments_of(const std::vector<Vec2>& points, double cell);

/// An upright plane: its normal is (cos angle, 0, -sin angle), `offset` m from the origin.
struct MirrorPlane {
  double angle, offset;
};

/// The upright plane that mirrors the trunk below the shoulders best: the legs alone tell the
/// heading to a few degrees.
/// @param points of the body, body frame, m; nothing where they show no trunk
std::optional<MirrorPlane> mirror_plane(const std::vector<Vec3>& points, double stature);

/// By how much the plane that mirrors the trunk leans to the body's left, rad; nothing where the
/// trunk does not show it.
std::optional<double> mirror_roll(const std::vector<Vec3>& points, double stature);

} // namespace sloper::body
