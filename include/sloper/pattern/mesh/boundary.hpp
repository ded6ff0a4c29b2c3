#pragma once
/// Places of the boundary vertices of all panels, decided for all seams together: both
/// sides of a seam get the same number of vertices by construction, linear in arc length,
/// and a corner on one side has its partner on the other.
/// Test: tests/pattern/mesh/test_boundary.cpp
#include <sloper/base/message.hpp>
#include <sloper/pattern/pattern.hpp>

namespace sloper::pattern {

/// The sampled outlines of all panels, and the vertex pairs of all seams.
struct Boundary {
  /// One panel's boundary; its vertices count through all loops.
  struct PanelBoundary {
    std::vector<std::vector<Vec2>> loops; ///< as Panel::loops, sampled
    /// Panel edge that starts at or runs through each boundary vertex, in loop order.
    std::vector<int> edge_of;
    std::vector<char> must_split; ///< vertices between two edges that are sewn to each other
  };
  /// One seam's vertices in sewing order; a[i] is sewn to b[i].
  struct SeamStitches {
    std::vector<std::array<int, 2>> a, b; ///< (panel, boundary vertex of that panel)
  };
  std::vector<PanelBoundary> panels; ///< as Pattern::panels
  std::vector<SeamStitches> seams;   ///< as Pattern::seams
  std::vector<Message> findings;     ///< sentences, for PanelMesh::findings
};

/// Samples all outlines.
/// @param h  edge length aimed at, m
/// @param file  for messages
/// @param seam_h  the same along seams and darts, from where it grows along free edges; 0
/// for h
/// @param of_panel  #panels, m: edge lengths of the single panels, instead of h; a seam takes the
/// shorter one of its two sides. Empty: h everywhere
/// @throws Error INPUT where an outline is too small for its edge length to leave three
/// vertices, or a run is sewn twice
Boundary sample_boundary(const Pattern& pattern, double h, const std::string& file,
                         double seam_h = 0, const std::vector<double>& of_panel = {});

} // namespace sloper::pattern
