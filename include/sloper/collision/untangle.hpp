#pragma once
/// Resolves self-intersections without history: intersection contour minimisation (Volino
/// and Magnenat-Thalmann 2006). Where an edge with direction E passes through a face with
/// normal N, and R_i are the directions in which the intersection contour leaves that
/// point inside the one or two faces of the edge, the contour shortens fastest as the
/// edge moves against the face along
///   G = sum_i ( R_i - 2 (E . R_i) / (E . N) N ).
/// Points of one contour are summed, so that a pocket of cloth is drawn out as a whole
/// (the paper's global scheme), except where a contour meets its own end and has no two
/// sides: there each point counts by itself. It fails where the contour's length does not
/// change with depth: a straight hem straight through a sheet. Test:
/// tests/collision/test_untangle.cpp
#include <sloper/collision/intersections.hpp>
namespace sloper::collision {

/// One edge-face intersection and the direction that resolves it.
struct UntanglePair {
  EdgeFaceIntersection at; ///< edge, triangle, weights
  Vec3 direction;          ///< unit or shorter: the edge should move along it against the face
  int contour; ///< number of the contour the point belongs to, from 0 in order of first appearance
};

/// One entry for each edge-face intersection, in the order of edge_face_intersections().
std::vector<UntanglePair> untangle_directions(const std::vector<Vec3>& x,
                                              const std::vector<Triangle>& triangles,
                                              const Topology& topology, const TriangleTree& tree);

/// Displacements (m, #V by 3, zero where nothing intersects) that move each edge against its face
/// by at most `step`.
/// @param inverse_mass #V, 1/kg, 0 for pinned vertices; empty: all alike   @param pairs from
/// untangle_directions()
std::vector<Vec3> untangle_displacements(const std::vector<UntanglePair>& pairs,
                                         const std::vector<Triangle>& triangles,
                                         const Topology& topology, std::size_t n_vertices,
                                         double step, const std::vector<double>& inverse_mass = {});

} // namespace sloper::collision
