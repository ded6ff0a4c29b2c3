#pragma once
/// How the panels of trouser legs lie to each other before they go around the legs.
#include <pattern/layout/panel_layout.hpp>
#include <pattern/surfaces/leg_tube.hpp>

#include <functional>

namespace sloper::pattern {

/// Brings all panels about the trunk to the heights that agree best along all their seams at once
/// (least squares): level along upright seams, the upper panel clear of the lower along level ones.
void level_trunk(const PanelMesh& mesh, const SeamGraph& graph, const std::vector<PanelRole>& roles,
                 std::vector<PanelSpot>& spots);

/// Height below which the two legs of trousers are apart: the lowest stitch between panels of two
/// legs; none where there are no legs.
std::optional<double> legs_part(const PanelMesh& mesh, const SeamGraph& graph,
                                const std::vector<PanelRole>& roles,
                                const std::vector<PanelSpot>& spots);

/// The panels of one leg, and the level rows on which leg_rows() looks at them.
struct LegGrid {
  const std::vector<std::size_t>& panels;
  bool left = false;
  double top_m = 0;  ///< height of the first row
  double step_m = 0; ///< from a row down to the next
  std::size_t n_rows = 0;
};

/// What the panels of a leg cover on each row; see LegRow. Slanting ends (waist, hem) count as if
/// the sides went on.
std::vector<LegRow> leg_rows(const PanelMesh& mesh, const std::vector<PanelRole>& roles,
                             const std::vector<PanelSpot>& spots, const LegGrid& grid);

} // namespace sloper::pattern
