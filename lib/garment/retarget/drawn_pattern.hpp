#pragma once
/// The pattern that a garment was meshed from, beside its mesh: which edge each mesh point of an
/// outline lies on.
#include <sloper/garment/garment.hpp>
#include <sloper/pattern/pattern.hpp>

#include <optional>

namespace sloper::garment {

/// The outlines of a garment, and the edges of the pattern that they follow.
struct DrawnPattern {
  const pattern::Pattern* pattern = nullptr; ///< PanelMesh::source of the garment
  std::vector<std::vector<int>> edge_of; ///< by panel, as PanelInfo::outline: the edge that starts
                                         ///< at a vertex or runs through it, ascending
  std::vector<std::vector<Vec2>> outlines; ///< the same, m: the vertices as they were drawn
};

/// Nothing where the garment does not know its pattern, or its panels are meshed otherwise. A
/// regraded garment still knows the one before.
/// @param garment outlives the result
std::optional<DrawnPattern> drawn_pattern(const Garment& garment);

} // namespace sloper::garment
