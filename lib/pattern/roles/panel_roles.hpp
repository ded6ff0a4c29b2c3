#pragma once
/// What each panel is on the body. From the pattern's hints where it gives them, else from names,
/// else from how panels are sewn together.
#include <pattern/roles/panel_role.hpp>
#include <pattern/seam_graph.hpp>
#include <sloper/pattern/pattern.hpp>

#include <vector>

namespace sloper::pattern {

std::vector<PanelRole> panel_roles(const Pattern& pattern, const PanelMesh& mesh,
                                   const SeamGraph& graph);

} // namespace sloper::pattern
