#pragma once
/// A state of cloth on another mesh of the same pattern, by panel and place in it. Test:
/// tests/garment/levels/test_levels.cpp
#include <sloper/garment/garment.hpp>

namespace sloper::garment {

/// Where the vertices of `mesh` lie on another mesh of the same pattern: linear in its triangles,
/// and on beyond its outline.
/// @param from  whose panels have the same names   @param at  #V of `from` by 3, m
/// @return #V of `mesh` by 3, m   @throws Error INPUT for a panel that `from` has not
std::vector<Vec3> interpolate(const pattern::PanelMesh& from, const std::vector<Vec3>& at,
                              const pattern::PanelMesh& mesh);

/// What another mesh of a pattern does not know of a given one by itself: where its panels were
/// placed, on which body, and their parts, materials, layers and open seams, each by its name.
/// @param mesh  in and out; its `placed` stays
void take_over(const pattern::PanelMesh& given, pattern::PanelMesh& mesh);

/// The same cloth on a finer mesh, as smooth as the coarse triangles are not (Phong tessellation,
/// Boubekeur and Alexa 2008). What is sewn stays sewn.
/// @param coarse  sewn   @param mesh  of the same pattern
/// @return with the materials and the scene of `coarse`
Garment on_finer_mesh(const Garment& coarse, const pattern::PanelMesh& mesh);

} // namespace sloper::garment
