#pragma once
/// A scan that lies or leans: which turn sets the person upright.
#include <Eigen/Core>
#include <body/ingest/segmentation.hpp>
namespace sloper::body {

inline constexpr double SOLE_HEIGHT =
    0.06; ///< of stature: the feet below it are what a person rests on

/// The turn that makes +y the direction in which a person stands up in the scan; nothing where one
/// of the file's axes is that direction (`sorted` reads them), or where no direction shows a
/// person. The line from the calves to the head tells the direction roughly, the plane on which
/// both feet rest exactly; a person who only leans by less than 5 degrees is left as it is. Cost:
/// linear for an upright scan; else some 200 readings of a thinned copy, half a second.
std::optional<Eigen::Matrix3d> upright_turn(const TriangleMesh& scan, const SegmentedScan& sorted);

/// The plane y = a x + b z + c that lies under all points and is highest above (x, z) = `at`: what
/// stands there rests on it.
/// @return (a, b, c); nothing for fewer than three points
std::optional<Vec3> resting_plane(const std::vector<Vec3>& points, const Vec2& at);

} // namespace sloper::body
