#pragma once
/// Inside and outside of a surface known only by oriented samples: the indicator chi with
/// laplacian(chi) = div(V), V the smoothed field of inward normals (Kazhdan, Bolitho and Hoppe
/// 2006), on a uniform grid by multigrid.
#include <body/surface/oriented_points.hpp>
namespace sloper::body {

/// Values at the nodes of a uniform grid.
struct NodeGrid {
  Vec3 origin = Vec3::Zero();
  double h = 0;             ///< m
  std::array<int, 3> n{};   ///< nodes along x, y, z
  std::vector<float> value; ///< x fastest
  std::size_t at(int x, int y, int z) const {
    return (static_cast<std::size_t>(z) * n[1] + y) * n[0] + x;
  }
  Vec3 node(int x, int y, int z) const { return origin + h * Vec3(x, y, z); }
  /// Trilinear; p must lie inside.
  double sample(const Vec3& p) const;
};

/// chi - iso on a grid of spacing h around the samples: positive inside.
NodeGrid indicator(const OrientedPoints& samples, double h);

} // namespace sloper::body
