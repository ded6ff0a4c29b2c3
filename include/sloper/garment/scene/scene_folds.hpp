#pragma once
/// Creases and roll lines of a scene on panels whose mesh has no edges along them.
/// Test: tests/garment/scene/test_scene_folds.cpp
#include <sloper/body/body.hpp>
#include <sloper/garment/garment.hpp>

#include <string>

namespace sloper::garment {

/// Meshes loose panels again so that edges run along the scene's creases and roll lines. Cloth
/// folds only along edges: across triangles a fold would be a zigzag that their stiffness holds
/// open. The lines are drawn into the pattern that the panels know, a roll line as one of kind
/// "roll", so that the drape is that of a pattern which draws them: what is turned over starts
/// turned, where the panels were placed around `body`. Unchanged where the mesh has such edges
/// already, where the garment is sewn, and where the panels do not know their pattern; there a fold
/// follows the edges nearest to its line.
/// @param body  that the garment is draped on, or null   @param skin  hash of its skin
/// @param file  the scene, for messages
/// @return what a user should know: folds that follow no line
/// @throws Error INPUT for a line that misses its panel, or leaves it and comes back
std::vector<Message> mesh_along_folds(Garment& garment, const body::Body* body,
                                      const std::string& skin, const std::string& file);

} // namespace sloper::garment
