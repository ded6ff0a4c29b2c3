#pragma once
/// The skin on which cloth lies: the scan's own faces where they are sound, else a closed surface
/// rebuilt from samples.
#include <body/surface/mesh_repair.hpp>
#include <sloper/body/body.hpp>
namespace sloper::body {

/// The skin of a scan, and where its vertices come from.
struct SkinSurface {
  TriangleMesh mesh; ///< outward
  std::vector<int>
      of_scan; ///< skin vertex of every scan vertex, -1 where there is none; empty when rebuilt
  bool rebuilt = false;
  bool whole = false; ///< the scan's own faces, and no hole had to be closed
  double noise_m = 0; ///< roughness of the scan, m
  int border_edges = 0, crowded_edges = 0,
      flipped_edges = 0;   ///< of the scan's own faces: one face, more than two, two that disagree
  std::vector<Hole> holes; ///< of the scan's own faces, where they were asked: the widest ones,
                           ///< frame of `positions`
  std::vector<Finding> findings;
};

/// @param positions #V by 3, body frame, m
/// @param stature   m
/// @param rebuild_why not empty: the scan's own faces are not enough, for this reason
SkinSurface make_skin(const std::vector<Vec3>& positions, const std::vector<Triangle>& triangles,
                      const std::vector<char>& is_body, double stature,
                      const std::string& rebuild_why = "");

/// A closed surface near the samples of any scan, about 60k triangles.
TriangleMesh rebuild_surface(const std::vector<Vec3>& positions,
                             const std::vector<Triangle>& triangles,
                             const std::vector<char>& is_body, double stature, double& noise_m);

} // namespace sloper::body
