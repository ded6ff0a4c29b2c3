#pragma once
/// Where panels lie relative to each other on the developed (unrolled) surface of their region: (u,
/// v) = turn p + (du, dv).
#include <pattern/roles/panel_role.hpp>
#include <pattern/seam_graph.hpp>
#include <sloper/pattern/pattern.hpp>

namespace sloper::pattern {

/// Where a panel lies on the unrolled surface.
struct PanelSpot {
  Vec2 offset = Vec2::Zero(); ///< (du, dv), m
};

/// Lays the panels of each region and side beside each other, seam to seam, 1 cm apart; heights of
/// front and back agree along their seams. Hints that a pattern gives are kept. u = 0 is the middle
/// of the side; v is relative until anchored to a body. Regions other than TRUNK have v = 0 at
/// their upper end.
std::vector<PanelSpot> lay_out(const Pattern& pattern, const PanelMesh& mesh,
                               const SeamGraph& graph, std::vector<PanelRole>& roles);

/// (u, v) of a vertex.
Vec2 laid(const PanelMesh& mesh, const PanelRole& role, const PanelSpot& spot, int vertex);
/// Bounds of a panel's outline in (u, v): low and high.
std::array<Vec2, 2> laid_bounds(const PanelMesh& mesh, const PanelRole& role, const PanelSpot& spot,
                                int panel);

/// How much of the level line at height v a panel covers, m.
double covered(const PanelMesh& mesh, const PanelRole& role, const PanelSpot& spot, int panel,
               double v);

} // namespace sloper::pattern
