#pragma once
/// The work of place_panels(): groups of panels about one axis, the heights at which they hang
/// (anchor_panels.cpp), their surfaces around the body (wrap_panels.cpp), and what pushes them free
/// of each other and of the skin (place_panels.cpp).
#include <map>
#include <pattern/layout/panel_layout.hpp>
#include <pattern/layout/sleeve_bend.hpp>
#include <pattern/place/body_space.hpp>
#include <pattern/surfaces/gore_tube.hpp>
#include <pattern/surfaces/leg_tube.hpp>
#include <pattern/surfaces/wrap_curve.hpp>
#include <sloper/collision/body_collider.hpp>
#include <sloper/pattern/mesh/folds.hpp>

namespace sloper::pattern {

struct PlacementReport;

/// Panels that share one cylinder.
struct PanelGroup {
  Region region;
  Side side;
  std::vector<std::size_t> panels;
  double extra = 0; ///< m added to the gap while panels are pushed free
  double wing =
      0; ///< m added to the distance of the wings, where sleeves of hanging arms are in their way
  std::string leg; ///< of trousers: leg_l or leg_r, all around
};

/// A panel of a circle skirt as it is laid out: a sector of a ring, which opens downwards.
struct Sector {
  Vec2 tip; ///< of its sides
  double spread, inner,
      length; ///< rad between them; m from the tip to the waist, and from there to the hem
  double top() const {
    return tip.y() - inner * std::sin(0.5 * spread) / (0.5 * spread);
  } ///< mean height of the waist
  /// As it is placed in folds, on a cone. @param down m from the waist, along the cloth
  double height(double down) const { return top() - std::sqrt(1 - SLOPE * SLOPE) * down; }

  static constexpr double SLOPE = 0.45; ///< of that cone: sine of the angle to the vertical
};

/// Places the panels of one pattern on one body.
class Placer {
public:
  Placer(const Pattern& pattern, const body::Body& body, PanelMesh& mesh, const Folding& folding);
  PlacementReport run();

private:
  static std::string region_name(Region r) {
    if (r == Region::TRUNK)
      return "torso";
    if (r == Region::ARM_L)
      return "arm_l";
    return r == Region::ARM_R ? "arm_r" : "neck";
  }
  bool is_arm(std::size_t k) const {
    return m_roles[k].region == Region::ARM_L || m_roles[k].region == Region::ARM_R;
  }
  Vec2 uv(std::size_t panel, int vertex) const {
    return laid(m_mesh, m_roles[panel], m_spots[panel], vertex);
  }
  double area(std::size_t k) const { return static_cast<double>(m_mesh.panels[k].n_triangles); }

  // place_panels.cpp
  void make_groups();
  void make_rings();
  void place_all();
  std::map<std::pair<int, int>, int> crossings() const;
  /// Pushes what crosses apart, arms outwards along their axis, collars up, the smaller of two
  /// panels of one side outwards, and grows the gap of groups that meet the body.
  PlacementReport push_free();
  /// Whether it is a sleeve, and most of what is through the skin meets other parts than its arm:
  /// a wider tube does not leave the trunk, one farther out along the arm does.
  /// @param through  of `triangles`, which are the group's
  bool meets_trunk(const PanelGroup& group, const std::vector<Triangle>& triangles,
                   const std::vector<int>& through) const;
  void measure_gaps(PlacementReport& report) const;
  double share_below_floor(const PanelInfo& panel) const;
  void find_impossible(PlacementReport& report) const;
  /// Names panels of which neither name nor hint nor seams tell where they go, in the findings;
  /// their number.
  int find_unclassified();

  // anchor_panels.cpp
  std::array<Vec2, 2> bounds(const PanelGroup& group) const;
  /// Of a skirt's front or back that is nearly half a circle or more; nothing for others.
  std::optional<Sector> sector_of(std::size_t k) const;
  /// As sector_of(), of whatever part the panel is.
  std::optional<Sector> sector_by_shape(std::size_t k) const;
  /// Circle skirts whose hints say torso and a height: without it they would be capes, since the
  /// sides of both are drawn level.
  void find_stated_skirts();
  /// Sectors of more than half a circle are drawn with their sides upwards, and were laid out so
  /// below what they hang from. Where one is, all are brought up to it, tier by tier.
  void hang_sectors();
  /// Height at which a sector's waist is to hang, below what it is sewn to; nothing where it is
  /// sewn to nothing.
  std::optional<double> hanging_height(std::size_t k, const Sector& sector) const;
  /// Whether the garment hangs on the shoulders: front and back are sewn together near their tops,
  /// or there are sleeves or a collar.
  bool hangs_on_shoulders(double top) const;
  /// Height for the top of what hangs on the chest without straps; 0 for skirts and trousers. Told
  /// by the pattern's own heights (they are those of its body, of about 1.7 m), else by words.
  double strapless_height(double top) const;
  void anchor_trunk();
  /// The innermost layer's panels about the trunk, by what is sewn together: of two skirts, one
  /// over the other, each is a piece.
  std::vector<std::vector<std::size_t>> hanging_pieces() const;
  /// Cloth around the uppermost 15 cm of such a piece, one length for every centimetre, m, and the
  /// mean height of its top edge; nothing where it ends below `top`.
  std::pair<std::vector<double>, double> lengths_around(const std::vector<std::size_t>& piece,
                                                        double top);
  /// Those of the piece that is narrowest at the top: it lies nearest to the body.
  std::pair<std::vector<double>, double> hanging_lengths(double top);
  /// How much of the level line v is covered by a piece's panels, m.
  double covered(const std::vector<std::size_t>& piece, double v) const;
  bool sewn(int vertex);
  /// PanelRole::theta of collars and hoods without hints, to an eighth of a turn: where what they
  /// are sewn to has the seam.
  void face_neck();
  /// Collars and hoods in pieces stand beside each other: their seams with the trunk at one height.
  void level_neck();
  void anchor_neck();

  // wrap_panels.cpp
  template<class Point> void put(std::size_t panel, Point point);
  /// Sum of the widths of the panels of a group that stand beside panel k, itself among them, with
  /// a little room between.
  double row_width(const PanelGroup& group, std::size_t k) const;
  /// z in front of which (or behind which, for backs) the wings must stay: past the arms that hang
  /// within the panels' reach.
  double wing_limit(const PanelGroup& group, const Axis& axis, const std::array<Vec2, 2>& b,
                    const std::vector<Vec2>& hull) const;
  void place_trunk(const PanelGroup& group);
  /// How many times as long as the way to its edge on one side (sign of x) the cloth of a front or
  /// back starts, below the arm pits: where it would stand before or behind a hanging arm beyond
  /// the arm's middle, its side seam would close around the arm. 1 where it does not.
  double folded_beside_arm(const PanelGroup& group, const Axis& axis, const WrapCurve& curve,
                           double sign) const;
  /// Around half the body on a cone, in folds that take up what is wider than the cone: level as it
  /// is drawn it would reach beyond the arms, and its side seams would close around them.
  void place_in_folds(const PanelGroup& group, std::size_t k, const Sector& sector,
                      const Axis& axis, const std::vector<Vec2>& hull);
  /// Of sleeves cut in one with the panels of a group that lies on this curve.
  std::vector<SleeveBend> sleeve_bends(const PanelGroup& group, const Axis& axis,
                                       const WrapCurve& curve) const;
  /// Panels with flare in the seams between them, row by row joined at the seams: a skirt on a tube
  /// that widens as they do, a dress above the waist on what its front and back lie on as others
  /// do.
  void place_gores(std::size_t ring);
  /// Height along the arm's axis at which a long sleeve may end: a little beyond the wrist.
  double arm_end(const Axis& axis, bool left) const;
  void place_arm(const PanelGroup& group);
  /// Legs start as smooth tubes around the legs. Longer than to the ankles they start shortened: a
  /// hem closes around an ankle, not around a foot.
  void place_leg(const PanelGroup& group);
  void place_neck(const PanelGroup& group);
  void place_group(const PanelGroup& g);

  const Pattern& m_pattern;
  PanelMesh& m_mesh;
  const Folding& m_folding;
  BodySpace m_space;
  SeamGraph m_graph;
  std::vector<PanelRole> m_roles;
  std::vector<PanelSpot> m_spots;
  std::vector<int>
      m_depth; ///< how many layers lie beneath: of the pattern, and of panels that would cross
  collision::BodyCollider m_collider;
  std::vector<PanelGroup> m_groups;
  std::vector<std::size_t> m_group_of;
  std::vector<int> m_panel_of_triangle;
  std::vector<char> m_sewn;
  double m_arm_shift[2] = {0.0, 0.0}; ///< m along the arm; right, left
  double m_raised = 0;
  int m_innermost = 0;               ///< layer
  std::optional<LegTube> m_tubes[2]; ///< right, left
  std::vector<GoreRow> m_rings;
  std::vector<GoreTube> m_ring_tubes;
  std::vector<char> m_in_ring; ///< of each panel
};

} // namespace sloper::pattern
