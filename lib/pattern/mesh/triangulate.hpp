#pragma once
/// Quality triangulation of a polygon whose boundary points are given and stay all there is on the
/// boundary.
#include <pattern/mesh/size_field.hpp>

#include <string>
#include <vector>

namespace sloper::pattern {

/// A triangulated polygon, m.
struct FlatMesh {
  std::vector<Vec2> points;        ///< the loops' points in the order given, then interior points
  std::vector<Triangle> triangles; ///< counter-clockwise
  int n_boundary = 0;
};

/// Triangulates a polygon: constrained Delaunay triangulation of the boundary (GEOS), a hexagonal
/// lattice of interior points inserted with Delaunay flips, interior edges between two boundary
/// points split (they could be welded onto one another, and a triangle with no free corner cannot
/// bend), then smoothing and local search for the smallest angle. Corners below 50 degrees keep
/// their ear: splitting it would make angles below 25.
/// @param loops      [0] outer, counter-clockwise; the rest holes, clockwise; no repeated points
/// @param size       edge length aimed at
/// @param lines      chains of points inside that become edges where they can; an end may be a
/// boundary point
/// @param must_split boundary points whose ear must go whatever the angle (their two edges are sewn
/// together)
/// @throws Error INPUT when the polygon crosses itself; deterministic. About 25 us per point.
FlatMesh triangulate(const std::vector<std::vector<Vec2>>& loops, const SizeField& size,
                     const std::vector<char>& must_split, const std::string& panel,
                     const std::vector<std::vector<Vec2>>& lines = {});

} // namespace sloper::pattern
