#pragma once
/// Start positions around a body: panels wrapped without stretch on cylinders about the
/// body's parts. Fronts lie in front, backs behind, sleeves around the arm's axis,
/// collars around the neck; nothing is inside the body, and no two panels cross.
/// Test: tests/pattern/place/test_placement.cpp
#include <sloper/body/body.hpp>
#include <sloper/pattern/panel_mesh.hpp>
#include <sloper/pattern/pattern.hpp>

namespace sloper::pattern {

/// Quality of a start; zeros are best.
struct PlacementReport {
  int crossings = 0;       ///< pairs of triangles of the start that cross, after pushing apart
  int vertices_inside = 0; ///< of the body
  int faces_through = 0;   ///< that cross the skin
  /// Mean and largest distance of the two vertices of a stitch, m.
  double seam_gap_mean = 0, seam_gap_max = 0;
  /// Places that cannot be intended, as sentences: a panel below the floor, whole or for
  /// the most part, or above the head, a seam a metre open.
  std::vector<std::string> impossible;
  /// Rings of cloth, such as cuffs and waistbands, that start around a limb or the trunk of more
  /// than 1.15 times their length, as sentences.
  std::vector<std::string> too_tight;
  /// No panel could be classified: all are placed as fronts, and the last finding says
  /// so.
  bool is_guess = false;
};

/// Places all panels: fills mesh.placed, mesh.placement and PanelInfo::part, and adds a
/// finding for each panel that could not be made free.
/// @param pattern  the one that `mesh` was made from
/// @throws Error INPUT when the body lacks the landmarks that a panel needs
PlacementReport place_panels(const Pattern& pattern, const body::Body& body, PanelMesh& mesh);

/// Places panels without a body: flat side by side, with a finding, where the pattern
/// states no 3D placement.
void lay_flat(const Pattern& pattern, PanelMesh& mesh);

} // namespace sloper::pattern
