#pragma once
/// Start positions around a body: panels wrapped without stretch on cylinders about the body's
/// parts, fronts in front, backs behind, sleeves around the arm's own axis, collars around the
/// neck; nothing inside the body, no two panels crossing.
#include <sloper/body/body.hpp>
#include <sloper/pattern/panel_mesh.hpp>
#include <sloper/pattern/pattern.hpp>

namespace sloper::pattern {

struct PlacementReport {
  int crossings = 0;       ///< pairs of triangles of the start that cross, after pushing apart
  int vertices_inside = 0; ///< of the body
  int faces_through = 0;   ///< that cross the skin
  double seam_gap_mean = 0, seam_gap_max = 0; ///< m
  std::vector<std::string> impossible; ///< what cannot be meant, in words: a panel below the floor
                                       ///< or above the head, a seam a metre open
  bool is_guess = false; ///< of no panel is it told where it goes: all are taken for fronts, and
                         ///< the last finding says so
};

/// Fills mesh.placed, mesh.placement and PanelInfo::part; adds to mesh.findings what could not be
/// made free.
/// @param pattern the one that `mesh` was made from
/// @throws Error INPUT when the body lacks the landmarks a panel needs
PlacementReport place_panels(const Pattern& pattern, const body::Body& body, PanelMesh& mesh);

/// Without a body: where the pattern states no 3D placement of its own, panels lie flat side by
/// side, with a finding.
void lay_flat(const Pattern& pattern, PanelMesh& mesh);

} // namespace sloper::pattern
