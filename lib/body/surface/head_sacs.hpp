#pragma once
/// A mouth that is modelled hollow is a sac of skin behind closed lips; so are eye sockets behind
/// lids. No scanner sees them and no cloth belongs there, but a collar that comes near the chin can
/// be caught in them.
/// Test: tests/body/surface/test_head_sacs.cpp
#include <sloper/body/body.hpp>
#include <sloper/geometry/triangle_mesh.hpp>

namespace sloper::body {

/// What was closed.
struct ClosedSacs {
  int sacs = 0;        ///< of the head
  int faces = 0;       ///< of the skin that were left out
  double area_m2 = 0;  ///< of those
  Vec3 place{0, 0, 0}; ///< m: the middle of the largest sac
};

/// Leaves out the skin of the head that cannot be seen from outside, and closes what is left with a
/// fan each.
///
/// A face is seen if it lies no more than 2 mm behind the foremost skin in one of 26 directions
/// that it faces (depth maps of 2 mm). Connected faces that are not seen are a sac from 10 cm2 on:
/// folds of ears and nostrils are smaller. Skin whose rim does not close stays as it is.
/// Cost: about 1 us for each face of the head.
/// @param skin  m, outward, closed or not; in and out
/// @param face_part  one per face; in and out
ClosedSacs close_head_sacs(TriangleMesh& skin, std::vector<Part>& face_part);

} // namespace sloper::body
