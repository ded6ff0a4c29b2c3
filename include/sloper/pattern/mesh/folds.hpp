#pragma once
/// Inner lines and pleats as the mesher needs them: edges cut where lines end on them,
/// pleats sewn layer on layer, and the panels folded in their start position.
/// Test: tests/pattern/mesh/test_folds.cpp
#include <sloper/pattern/panel_mesh.hpp>
#include <sloper/pattern/pattern.hpp>

namespace sloper::pattern {

/// An end of a line nearer to the outline than this lies on it, m.
constexpr double LINE_ON_EDGE = 0.002;

/// Where a point lies on the outer loop of a panel: edge and fraction of its length; edge -1 where
/// it is further off than LINE_ON_EDGE.
struct OnOutline {
  int edge = -1; ///< of the outer loop
  double at = 0; ///< 0..1
};
/// The nearest place of the outer loop to p, m.
OnOutline on_outline(const Panel& panel, const Vec2& p);

/// The pattern as it is meshed. Panels without lines stay unchanged. On the others
/// - edges are cut where lines end on them (names get _1, _2), and the ends moved there;
/// - each pleat gets a line in the middle between its two, along which it is folded back.
/// The cloth under it is removed from the seams of the pleat's edges, and two seams of
/// kind "pleat" sew the three layers together.
/// With w the distance from target to fold along an edge, the upper layer's stretch
/// reaches w / 2 beyond the fold.
/// @throws Error INPUT naming the pleat where it does not fit on its edge, or meets
/// another
Pattern with_folds(const Pattern& pattern, const std::string& file);

/// Displacement of each vertex of a mesh that folds its pleats and turns collars and lapels over
/// their roll lines: the shift in the plane of the panel, and the depth behind it.
struct Folding {
  std::vector<Vec2> shift;   ///< #V or empty: m, in pattern coordinates
  std::vector<double> depth; ///< #V or empty: m, towards the body; turned lapels negative
};
/// The folding of all pleats and roll lines of a mesh.
/// @param pattern  the one that `mesh` was made from
Folding fold_panels(const Pattern& pattern, const PanelMesh& mesh);

/// Edge length at which the mesh of a panel has room for its roll lines: edges along them, which
/// the mesher leaves out near the outline, and two rows of triangles beyond them.
/// @param usual  m, of the mesh   @return m, from an eighth of `usual` to `usual`, which it is
/// for panels without roll lines and those that are turned whole. Cost: samples of lines times
/// samples of outline
double edge_length_for_rolls(const Panel& panel, double usual);

/// Whether all of a panel is turned over, as a collar's leaf whose roll line is its seam.
bool turned_whole(const Panel& panel);

/// Edges of a mesh along a path, as vertex pairs in rising order. Cost: vertices of the panel times
/// millimetres of the path.
std::vector<std::array<int, 2>> edges_along(const PanelMesh& mesh, const PanelInfo& panel,
                                            const Path& path);

/// Edges of a mesh along which it is folded, as vertex pairs in rising order: on the folds of its
/// pleats and the lines halfway to their targets, and on roll lines. Empty where no panel has any,
/// or the mesh does not know its pattern. Cost: lines times vertices.
std::vector<std::array<int, 2>> pleat_edges(const PanelMesh& mesh);

/// Rest length factors that elastic tapes (lines of kind "tape") give to the edges near them, by
/// how far these run along: #F by 3, edge k -> k+1 of each triangle; empty where no panel has a
/// tape.
std::vector<std::array<double, 3>> tape_scales(const PanelMesh& mesh);

} // namespace sloper::pattern
