#pragma once
/// Small relief of the skin: bumps and dimples of about a centimetre, such as nipples and the
/// navel.
#include <optional>
#include <sloper/geometry/triangle_mesh.hpp>
#include <vector>
namespace sloper::body {

/// The tip of a bump or the bottom of a dimple.
struct ReliefPoint {
  Vec3 p = Vec3::Zero();
  double height = 0; ///< m, above (below when negative) the ring around it
};

/// Where the skin inside `box` with normals facing +z stands out most (sign +1) or lies deepest
/// (sign -1) against the ring of skin between 0.55 and 1 `radius` around it. The place is the
/// middle of what reaches 0.7 of the most, weighted by what it has beyond that.
std::optional<ReliefPoint> strongest_relief(const TriangleMesh& skin, const Box3& box,
                                            double radius, double sign);

/// The places of the same kind, each higher (deeper) than all within `apart`, m, of it, that are
/// over `least` high, m; the highest first.
/// @param most this many at most
std::vector<ReliefPoint> tallest_reliefs(const TriangleMesh& skin, const Box3& box, double radius,
                                         double sign, double apart, double least, std::size_t most);

} // namespace sloper::body
