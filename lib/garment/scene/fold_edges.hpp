#pragma once
/// Where a crease or roll line of a scene runs on a garment: as a curve in its panel, and as edges
/// of its mesh. Test: tests/garment/scene/test_scene_folds.cpp
#include <sloper/garment/garment.hpp>
#include <sloper/pattern/path.hpp>

namespace sloper::garment {

/// The line in pattern coordinates, m, through all its places.
pattern::Path fold_path(const Garment& garment, const SceneCrease& crease);

/// Whether the mesh has edges along the line, over nearly all of it that is on the panel.
bool is_meshed(const Garment& garment, const SceneCrease& crease);

/// Pairs of particles (each in rising order, sorted) that the cloth is folded along: edges on the
/// line, or where the mesh has none there, the shortest path over edges from place to place.
std::vector<std::array<int, 2>> fold_edges(const Garment& garment, const SceneCrease& crease);

} // namespace sloper::garment
