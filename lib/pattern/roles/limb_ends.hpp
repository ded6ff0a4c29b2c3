#pragma once
/// Panels that hang on sleeves and trouser legs, by what they are sewn to. Shape alone tells a cuff
/// of a sleeve from one of a leg badly, and its hand not at all.
/// Test: tests/pattern/place/test_limb_ends.cpp
#include <pattern/roles/shape_roles.hpp>
#include <pattern/seam_graph.hpp>

namespace sloper::pattern {

/// The trunk is what hangs together about the largest panel of a torso or skirt; sewn to it are
/// sleeves and legs; what is farther from it takes the part, the hand and the face of the limb that
/// it hangs on, by its longest seam. Pieces of one sleeve get one hand, and the face of the torso's
/// panel that they are sewn to.
/// @returns of each panel whether it hangs on a leg alone
std::vector<bool> follow_limbs(const PanelMesh& mesh, const SeamGraph& graph,
                               std::vector<ShapeRole>& roles);

} // namespace sloper::pattern
