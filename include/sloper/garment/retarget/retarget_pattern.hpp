#pragma once
/// The pattern of a garment as an outline again, and how a regraded one differs from the one
/// before.
/// Test: tests/garment/retarget/test_retarget.cpp
#include <sloper/garment/garment.hpp>
#include <sloper/pattern/pattern.hpp>

namespace sloper::garment {

/// Outlines, grain, materials and seams of a garment's panels. Panel edges are chains of
/// mesh edges, counter-clockwise. Where the garment knows the pattern that it was meshed
/// from, they have its edges' names (NAME_1, NAME_2 where a seam ends on one), its
/// notches, the reasons why sides of seams differ, and its placement hints, moved to the
/// present place of the cloth. Else they end at seam ends and at corners of more than 25
/// degrees, are named "e0", "e1", ..., and the only hint is the part that a panel was
/// placed on. `findings` names contents that are lost (sewing lines inside a panel, inner
/// lines, pleats, holes). Edges and seams of two garments of the same mesh are the same,
/// whatever their pattern coordinates.
/// @param shape  the garment before grading: its pattern coordinates decide where corners
/// are, its positions how far the cloth was moved
pattern::Pattern pattern_of(const Garment& garment, const Garment& shape);

/// CSV of both patterns' lengths, cm: "kind,panel,edge,before_cm,after_cm,delta_cm"; kinds are
/// width, height (of the panel, square to and along the grain), edge, seam (its name in the column
/// panel; side a) and mismatch (side a less side b).
std::string grade_table(const pattern::Pattern& before, const pattern::Pattern& after);

} // namespace sloper::garment
