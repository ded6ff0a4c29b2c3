#pragma once
/// Surface samples with outward normals from any scan: mesh or bare points, noisy, holed, with
/// flipped faces.
#include <sloper/geometry/triangle_mesh.hpp>
#include <vector>
namespace sloper::body {

/// Samples of a surface, #S each.
struct OrientedPoints {
  std::vector<Vec3> position, normal; ///< m; unit, outward
  std::vector<double> area;           ///< m2 that each sample stands for
  double spacing = 0;                 ///< m
  double lonely_share =
      0;              ///< of samples with too few neighbours for a normal: the spacing is too fine
  double noise_m = 0; ///< rms distance of the scan's points from the local surface
};

/// Averages the scan's points (and points on faces longer than `spacing`) in cells of `spacing`,
/// fits planes for the normals, and turns them outward: the side from which more of the open air is
/// seen. Face orientation is not trusted. Stops before turning the normals when more than
/// max_lonely_share of the samples stand alone.
/// @param positions #V by 3, m; only those with use[v] != 0 count
OrientedPoints sample_surface(const std::vector<Vec3>& positions,
                              const std::vector<Triangle>& triangles, const std::vector<char>& use,
                              double spacing, double max_lonely_share = 1.0);

} // namespace sloper::body
