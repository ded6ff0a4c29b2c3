#pragma once
/// From a pattern to a panel mesh: boundary sampled over all seams, panels triangulated, start positions from the pattern's own
/// placement (place_panels() brings them to a body).
#include <pattern/panel_mesh.hpp>
#include <pattern/pattern.hpp>

namespace sloper::pattern {

/// @param edge_length aimed at, m
/// @param file        for messages
/// @param seam_length aimed at along seams and darts, m, growing to edge_length away from them; 0 for edge_length everywhere
/// @throws Error INPUT where a panel cannot be meshed
PanelMesh mesh_pattern(const Pattern& pattern, double edge_length, const std::string& file, double seam_length = 0);

} // namespace sloper::pattern
