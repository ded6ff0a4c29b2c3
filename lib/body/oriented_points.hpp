#pragma once
/// Surface samples with outward normals from any scan: mesh or bare points, noisy, holed, with flipped faces.
#include <geometry/triangle_mesh.hpp>
#include <vector>
namespace sloper::body {

struct OrientedPoints {
  std::vector<Vec3> position, normal; ///< m; unit, outward
  std::vector<double> area;           ///< m2 that each sample stands for
  double spacing = 0;                 ///< m
  double noise_m = 0;                 ///< rms distance of the scan's points from the local surface
};

/// Averages the scan's points (and points on faces longer than `spacing`) in cells of `spacing`, fits planes for the
/// normals, and turns them outward: the side from which more of the open air is seen. Face orientation is not trusted.
/// @param positions #V by 3, m; only those with use[v] != 0 count
OrientedPoints sample_surface(const std::vector<Vec3>& positions, const std::vector<Triangle>& triangles, const std::vector<char>& use, double spacing);

} // namespace sloper::body
