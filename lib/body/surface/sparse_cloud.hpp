#pragma once
/// Bare points that lie far apart on the trunk and near on hands and face: points between them, on
/// the surface they suggest.
#include <sloper/geometry/types.hpp>
#include <vector>
namespace sloper::body {

/// Adds points halfway between neighbours that are farther apart than `spacing` and lie on one
/// side of the body: where both normals agree and the line between is along the surface. A new
/// point is the middle of the cubic through both that is square to their normals (Vlachos et al.
/// 2001, "Curved PN triangles"), so that round limbs stay round. Up to three rounds, each halving
/// the distance.
/// @param points m   @param spacing m wanted   @return the points given, in their order, and those
/// added Cost: a few neighbour searches for each point that stands alone; nothing where the cloud
/// is dense.
std::vector<Vec3> fill_thin_cloud(const std::vector<Vec3>& points, double spacing);

} // namespace sloper::body
