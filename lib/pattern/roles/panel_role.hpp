#pragma once
/// What each panel is on the body: which region it covers, from which side, and how its drawing is turned there. From the pattern's
/// hints where it gives them, else from names, else from how panels are sewn together.
#include <cmath>
#include <pattern/panel_mesh.hpp>
#include <pattern/pattern.hpp>

namespace sloper::pattern {

inline constexpr double PANEL_GAP = 0.01; ///< m: between neighbouring edges when panels are placed

/// Whether a seam goes more across than up. The sides of a quarter of a circle, which go as far up as across but for rounding, are upright ones.
/// @param along (across, up) from one end to the other, any unit
inline bool goes_level(const Vec2& along) { return std::abs(along.x()) > 1.05 * std::abs(along.y()); }

enum class Region { TRUNK, ARM_L, ARM_R, NECK }; ///< TRUNK is everything about the vertical axis: bodice, skirt, trouser legs
enum class Side { FRONT, BACK, RING };           ///< RING goes around: a one-piece sleeve, a waistband in one piece, side gores

struct PanelRole {
  Region region = Region::TRUNK;
  Side side = Side::FRONT;
  std::string part;                                   ///< for PanelInfo: torso, arm_l, leg_l, lower_body, neck
  double theta = 0;                                   ///< rad, RING only: where its middle looks (0 front, +pi/2 the wearer's left)
  Eigen::Matrix2d turn = Eigen::Matrix2d::Identity(); ///< pattern coordinates to (u, v): v up the trunk, or up the arm to the shoulder
  std::optional<double> du, dv;                       ///< m: (u, v) = turn p + (du, dv) where the pattern's hint says so; heights are those of its own body
};

/// All seams of a mesh between panel p and panel q (p = q for tubes), as (seam, whether p is its side a).
struct SeamRef {
  int seam;
  bool first;
};

/// Panel-level view of a mesh's seams.
class SeamGraph {
public:
  explicit SeamGraph(const PanelMesh& mesh);
  int panel_of(int vertex) const { return m_panel_of[static_cast<std::size_t>(vertex)]; }
  /// Stitches between panels p and q: pairs (vertex of p, vertex of q), by seam. For p = q each stitch once.
  std::vector<std::vector<std::array<int, 2>>> between(int p, int q) const;
  const std::vector<int>& neighbours(int p) const { return m_neighbours[static_cast<std::size_t>(p)]; } ///< ascending, without p

private:
  const PanelMesh* m_mesh;
  std::vector<int> m_panel_of;
  std::vector<std::vector<int>> m_neighbours;
};

std::vector<PanelRole> panel_roles(const Pattern& pattern, const PanelMesh& mesh, const SeamGraph& graph);

} // namespace sloper::pattern
