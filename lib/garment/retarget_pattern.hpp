#pragma once
/// The pattern of a garment as an outline again, and how a regraded one differs from the one before.
#include <garment/garment.hpp>
#include <pattern/pattern.hpp>

namespace sloper::garment {

/// Outlines, grain, materials and seams of a garment's panels. Panel edges end at seam ends and at corners of more than 25 degrees and
/// are chains of mesh edges; they are named "e0", "e1", ...
/// counter-clockwise. What lies inside a panel and is no outline (an internal sewing line) is told in `findings`.
/// Edges and seams of two garments of the same mesh are the same, whatever their pattern coordinates.
/// @param shape the garment whose pattern coordinates decide where corners are: the one before grading
pattern::Pattern pattern_of(const Garment& garment, const Garment& shape);

/// CSV of both patterns' lengths, cm: "kind,panel,edge,before_cm,after_cm,delta_cm"; kinds are width, height (of the panel, square to
/// and along the grain), edge, seam (its name in the column panel; side a) and mismatch (side a less side b).
std::string grade_table(const pattern::Pattern& before, const pattern::Pattern& after);

} // namespace sloper::garment
