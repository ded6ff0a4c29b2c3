#pragma once
/// Keeps what goes along with cloth from crossing more than it did on the first body. Test:
/// tests/garment/ingest/test_mesh_garment.cpp
#include <sloper/collision/intersections.hpp>
#include <sloper/garment/ingest/carried.hpp>

namespace sloper::garment {

/// Pairs of triangles that cross, ascending.
using CrossingPairs = std::vector<std::array<int, 2>>;

/// Moves carried places towards the cloth beneath them where triangles cross that did not, so that
/// the other side of a shell is thinner where cloth is folded more closely than twice its
/// thickness. Particles and rigid parts stay. Neighbours follow, so that no step is seen.
/// Cost: one search over all triangles, and MOST_ROUNDS more where some cross.
/// @param cloth, triangles  #P by 3, m, where the cloth is now, and its triangles
/// @param all  the mesh's triangles, by place   @param known  pairs that crossed before
/// @return pairs that cross now
CrossingPairs keep_carried_clear(const Carried& carried, const std::vector<Vec3>& cloth,
                                 const std::vector<Triangle>& triangles,
                                 const std::vector<Triangle>& all, const CrossingPairs& known,
                                 Moved& moved);

} // namespace sloper::garment
