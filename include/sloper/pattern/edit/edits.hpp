#pragma once
/// Edits of a pattern. Most keep its topology: outlines move, edges and seams keep their
/// names and places, so that a mesh made before the edit can follow (only its rest
/// lengths and vt change).
/// Test: tests/pattern/edit/test_edits.cpp
#include <sloper/io/json_fwd.hpp>
#include <sloper/pattern/panel_mesh.hpp>
#include <sloper/pattern/pattern.hpp>

#include <memory>

namespace sloper::pattern {

/// Applies the edits of a document {"format": "edits", "version": 1, "length_unit", "edits": [...]}
/// in order. Keys in braces; `by`, lengths and points are in its length unit:
/// - move-point {panel, edge, end: "start"|"end", by: [x, y]}: a corner; both edges there follow
/// - move-edge {panel, edge, by: [x, y]}: an edge as it is; its neighbours follow
/// - bend {panel, edge, by: [x, y]}: the middle of an edge; its ends stay, a line becomes a curve
/// - add-point {panel, edge, at, names?: [first, second]}: a corner at a fraction of its length
/// - set-length {panel, edge, length, fixed: "start"|"end"|"middle"} or {seam, length}: both sides
///   in proportion
/// - take-in {panel, edge, by}: inwards, square to the edge's chord; {seam, by}: both sides, half
///   each; let-out: outwards
/// - lengthen {panel, at: [x, y], along: [x, y], by}: all beyond the line through `at` square to
///   `along` moves by `by`; shorten: back
/// - scale {panel?, x, y}: about the panel's middle; all panels when none is named
/// - grade {panel?, width, height}: each panel gets this much wider and higher
/// - shrink {panel, warp, weft}: scale along and across the grain (elastic: below 1);
///   {panel, edge, factor}: along an edge, about its middle; {panel, curve: [["M", x, y], ...],
///   factor, width?, name?}: elastic tape along a curve, rest lengths only; {panel, strip: {from:
///   [x, y], to: [x, y]}, factor}: between the lines through both points square to their connection
/// - split {panel, from: [x, y], to: [x, y], names?: [left, right], sew?: true}: along the line
///   through both points; cut {panel, from, to, names?}: the same, left open
/// - join {seam, name?}: panels along congruent edges become one; side a stays
/// - add-dart {panel, edge, at, width, tip: [x, y], name?}: cut out of an edge, legs sewn;
///   {panel, center: [x, y], length, width, along?, name?}: a fisheye
/// - rotate-dart {dart, edge, at}: closes a dart and opens it at another place of the outline
/// - open {seam}: placed together, not sewn; close: the opposite
/// - restore {order, panels, seams?}: panels to the last bit, as inverse_edits() writes them
///
/// add-point, split, cut, join, darts, open, close and restore change which edges or particles
/// there are, so the pattern must be meshed anew; the others keep the mesh. Coordinates are kept on
/// a grid of 2^-30 m, so that move-point, move-edge, take-in and let-out are undone exactly by
/// their opposite.
/// @throws Error INPUT naming the edit and the panel, edge or seam that it names wrongly
void apply_edits(Pattern& pattern, const io::Json& json, const std::string& file);

/// The document that undoes a log of edits: applied after it, every coordinate is as
/// before to the last bit (of the pattern on the edits' grid). Opposite edits where these
/// are exact, else restore edits with the panels that changed.
/// @param before  the pattern before the edits
io::Json inverse_edits(const Pattern& before, const io::Json& json, const std::string& file,
                       const std::string& tool);

/// Moves a mesh made from a pattern to edits of that pattern: boundary vertices keep
/// their fraction of their edge, interior ones follow harmonically. The factorisation is
/// done once, so that an edit of a garment of 3000 vertices costs a millisecond.
class MeshFollower {
public:
  /// @param before  the pattern as `mesh` has it
  MeshFollower(const Pattern& before, const PanelMesh& mesh);
  ~MeshFollower();
  MeshFollower(MeshFollower&&) noexcept;
  /// Distance of the furthest boundary vertex from the outlines, m: a mesh of this pattern has next
  /// to none.
  double off_outline() const;
  /// Moves mesh.pattern to `after`, whatever was followed before: the mesh depends on the
  /// first pattern and on this one only.
  /// @return false, with nothing changed, where panels, edges or seams differ, or where a
  /// triangle would be worse than `least_angle_deg` and worse than it was: then the
  /// edited pattern must be meshed anew
  bool follow(const Pattern& after, PanelMesh& mesh, double least_angle_deg) const;

private:
  struct State;
  std::unique_ptr<State> m_state;
};

/// MeshFollower for one edit; the mesh then names `after` as its pattern. Arguments and
/// result as of MeshFollower::follow().
bool follow_edits(const Pattern& before, const Pattern& after, PanelMesh& mesh,
                  double least_angle_deg);

} // namespace sloper::pattern
