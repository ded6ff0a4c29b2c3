#pragma once
/// Where the boundary vertices of all panels go, decided for all seams together: both sides of a
/// seam get the same number of vertices by construction, linear in arc length, and a corner on one
/// side has its partner on the other.
#include <sloper/pattern/pattern.hpp>

namespace sloper::pattern {

struct Boundary {
  struct PanelBoundary {
    std::vector<std::vector<Vec2>> loops; ///< as Panel::loops, sampled
    std::vector<int>
        edge_of; ///< panel edge that starts at or runs through each boundary vertex, in loop order
    std::vector<char> must_split; ///< vertices between two edges that are sewn to each other
  };
  struct SeamStitches {
    std::vector<std::array<int, 2>> a, b; ///< (panel, boundary vertex of that panel)
  };
  std::vector<PanelBoundary> panels;
  std::vector<SeamStitches> seams; ///< as Pattern::seams
  std::vector<std::string> findings;
};

/// @param h      edge length aimed at, m
/// @param seam_h the same along seams and darts, from where it grows along free edges; 0 for h
/// @throws Error INPUT where an outline is too small for its edge length to leave three vertices,
/// or a run is sewn twice
Boundary sample_boundary(const Pattern& pattern, double h, const std::string& file,
                         double seam_h = 0);

} // namespace sloper::pattern
