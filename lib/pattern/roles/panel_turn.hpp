#pragma once
/// How pieces about the trunk stand upright, where the pattern does not say: CAD files often lay
/// them along x, or turn them to nest.
#include <pattern/roles/panel_role.hpp>
#include <pattern/seam_graph.hpp>
#include <sloper/pattern/pattern.hpp>

namespace sloper::pattern {

/// Sets PanelRole::turn of TRUNK and NECK panels without a placement hint. The largest piece that
/// is sewn to others stands as it is drawn where its grain is upright, else along its grain with
/// its longest free edges down; pieces sewn to it follow, by quarter turns from their grain: cloth
/// continues over a seam, and runs the other way over the shoulders and between the legs. Pieces
/// about the neck stand on the seam to what is below them.
void turn_trunk_panels(const Pattern& pattern, const PanelMesh& mesh, const SeamGraph& graph,
                       std::vector<PanelRole>& roles);

/// The same of panels about the arms, of all: v runs along the seams that close the tube, however
/// these lean, towards what is sewn on nearer to the trunk: of a cuff's flounce its cuff.
void turn_arm_panels(const Pattern& pattern, const PanelMesh& mesh, const SeamGraph& graph,
                     std::vector<PanelRole>& roles);

} // namespace sloper::pattern
