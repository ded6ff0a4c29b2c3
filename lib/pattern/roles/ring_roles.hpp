#pragma once
/// Which panels go around: tubes, sleeves in one piece, gores all around the body.
#include <pattern/panel_words.hpp>
#include <pattern/roles/panel_role.hpp>
#include <pattern/seam_graph.hpp>
#include <sloper/pattern/pattern.hpp>

#include <vector>

namespace sloper::pattern {

/// How far the panel reaches across, as it is turned, m.
double width_around(const PanelMesh& mesh, const std::vector<PanelRole>& roles, std::size_t k);

/// Side::RING and theta of panels that close on themselves, of sleeves without a partner, and of
/// rows of gores with their godets.
/// @param words  of each panel's name
/// @param roles  with their regions, sides and turns; in and out
void assign_rings(const Pattern& pattern, const PanelMesh& mesh, const SeamGraph& graph,
                  const std::vector<Words>& words, std::vector<PanelRole>& roles);

} // namespace sloper::pattern
