#pragma once
/// Edits of a pattern that keep its topology: outlines move, edges and seams keep their names and places, so that a mesh made before
/// the edit can follow (its rest lengths and vt change, nothing else).
#include <io/json.hpp>
#include <pattern/panel_mesh.hpp>
#include <pattern/pattern.hpp>

namespace sloper::pattern {

/// Applies the edits of a document {"format": "edits", "version": 1, "length_unit", "edits": [...]}, in order:
///   move-point  {panel, edge, end: "start"|"end", by: [x, y]}     a corner; both edges that meet there follow
///   move-edge   {panel, edge, by: [x, y]}                         an edge as it is; its neighbours follow
///   set-length  {panel, edge, length, fixed: "start"|"end"|"middle"}   or {seam, length}: both its sides in proportion
///   take-in     {panel, edge, by}                                 the edge moves inwards square to its chord; let-out: outwards
///   lengthen    {panel, at: [x, y], along: [x, y], by}            what lies beyond the line through `at` square to `along` moves on by `by`
///   scale       {panel?, x, y}                                    about the panel's middle; all panels when none is named
///   shrink      {panel, warp, weft}                               as scale, along the grain and across it (elastic: below 1)
/// Coordinates are kept on a grid of 2^-30 m, so that move-point, move-edge, take-in and let-out are undone exactly by their opposite.
/// @throws Error INPUT naming the edit and what it names wrongly
void apply_edits(Pattern& pattern, const io::Json& json, const std::string& file);

/// Carries a mesh made from `before` over to `after` (the same pattern, edited): boundary vertices keep their fraction of their edge,
/// interior ones follow harmonically. @return false, with nothing changed, where a triangle would be worse than `least_angle_deg`:
/// then the edited pattern has to be meshed anew
bool follow_edits(const Pattern& before, const Pattern& after, PanelMesh& mesh, double least_angle_deg);

} // namespace sloper::pattern
