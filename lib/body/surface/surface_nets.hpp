#pragma once
/// The zero surface of a node grid as a closed, manifold, outward-oriented mesh (dual method of
/// Gibson 1998).
#include <body/surface/poisson_grid.hpp>
namespace sloper::body {

/// Positive values are inside. Only the largest inside region is kept, cavities are filled, and
/// cells where the surface would pinch itself are filled too, so that every edge has exactly two
/// faces. Two triangles per crossed grid edge.
TriangleMesh zero_surface(NodeGrid grid);

} // namespace sloper::body
