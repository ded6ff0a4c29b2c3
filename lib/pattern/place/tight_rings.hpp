#pragma once
/// Rings of cloth that are too short for what they go round: cuffs, leg bands, waistbands, hems.
/// Test: tests/pattern/place/test_tight_rings.cpp
#include <pattern/place/body_space.hpp>
#include <sloper/pattern/panel_mesh.hpp>
#include <sloper/pattern/pattern.hpp>

namespace sloper::pattern {

/// Edges that are sewn end to end to a ring, across the seams between their panels.
struct ClothRing {
  std::vector<std::array<int, 2>> edges; ///< panel and edge, in order
  double length = 0; ///< m around; of an edge that is sewn to a shorter one that one's
};

/// All rings of whole edges, each once. A ring goes straight on through a corner, or across the
/// seam that begins there; edges of two rings that are sewn together are two rings.
std::vector<ClothRing> cloth_rings(const Pattern& pattern);

/// Rings that are shorter than the arm, leg or trunk inside them where they start, as sentences
/// with centimetres; of rings one above the other on one panel the tightest.
/// @param mesh  placed around the body
std::vector<std::string> tight_rings(const Pattern& pattern, const PanelMesh& mesh,
                                     const BodySpace& space);

} // namespace sloper::pattern
