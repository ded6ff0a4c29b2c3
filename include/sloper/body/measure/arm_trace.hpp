#pragma once
/// One arm followed from the hand to the trunk in sections square to it, whatever the stance.
#include <optional>
#include <sloper/body/landmarks/rules.hpp>
#include <sloper/body/measure/geodesic.hpp>
#include <sloper/body/measure/level_stack.hpp>
namespace sloper::body {

/// One section of an arm, square to its centre line.
struct LimbSection {
  Vec3 center = Vec3::Zero(); ///< centroid of the loop
  Vec3 axis = Vec3::UnitY();  ///< unit, towards the trunk
  Plane plane;                ///< of the cut
  Loop loop;                  ///< the arm's outline in that plane
  double girth = 0;           ///< taut, m
  double along = 0;           ///< m from the hand tip along the centres
};

/// An arm in sections from hand to trunk, with the arm pit beside it.
struct ArmTrace {
  bool left = true;                  ///< the body's own side
  Vec3 tip = Vec3::Zero();           ///< the point farthest from the trunk over the skin
  std::vector<LimbSection> sections; ///< from the hand to just before the trunk
  std::vector<int> triangles;        ///< of the arm and the shoulder's surroundings
  /// Distance of each skin vertex from the finger's end over the skin, m; 1e300 beyond
  /// the arm.
  std::vector<double> from_tip;
  Vec3 out = Vec3::UnitX();   ///< unit, from shoulder to hand, over the upper arm
  std::optional<Vec3> axilla; ///< roof of the arm pit
  bool is_stump = false;      ///< too short for an arm, but with a pit where people have it
  bool pit_hidden = false;    ///< no gap closes where an arm pit can be: it is placed by proportion
  bool pit_low = false;       ///< a gap closes there, lower than any arm pit
  bool pit_mirrored = false;  ///< hidden, and placed as the other arm's is
  /// Front and back fold beside the arm pit, m, body frame.
  std::optional<Vec3> axilla_front, axilla_back;
  double lifted_m = 0;         ///< m, rise of pit and folds towards those of the other arm
  double moved_to_merge_m = 0; ///< m, how far the pit was moved to `merge` from its gap's end
  std::optional<Vec3> merge;   ///< where, going up, the level sections of arm and trunk become one
  /// Point of the centre line at `along` m from the tip, extended straight beyond its
  /// ends.
  Vec3 at(double along) const;
  double length() const { return sections.empty() ? 0 : sections.back().along; }
};

/// Fills the arm pit's roof and the folds beside it: the place along the arm where the
/// gap between arm and trunk closes; else by proportion, `pit_hidden`.
/// @param arm  with its sections, in and out
/// @param rules  with the proportions
void find_axilla(ArmTrace& arm, const LevelStack& levels, const Rules& rules);

/// Both arm pits of a person are about as high; skin of arm and trunk that touches closes the gap
/// too low on one side. What is lower by more than people's pits are is lifted towards the other,
/// and wholly to it where it lies lower than any pit; one that is hidden is the other's mirror
/// image; two that are too low are both hidden.
/// @param arms  left and right after find_axilla(), in and out
/// @param rules  with the proportions
/// @param s  stature, m
void compare_pits(std::array<ArmTrace, 2>& arms, const Rules& rules, double s);

/// Fills `merge`: going up, the level at which the loops of a hanging arm and of the trunk become
/// one, by bisection to 0.02 mm: front and back fold often meet within a tenth of a millimetre of
/// each other.
void find_merge(ArmTrace& arm, const LevelStack& levels);

/// Where the merge lies by the arm pit: beside it where the arm hangs, farther outside and above
/// the more level the upper arm is.
/// @param pit  m, body frame
/// @param arm  its side and direction
/// @param rules  with the offsets
/// @param s  stature, m
Vec3 merge_by_pit(const Vec3& pit, const ArmTrace& arm, const Rules& rules, double s);

/// The merge, m, of skin that may span the gap between arm and trunk: as found where it is within
/// three standard deviations of merge_by_pit(), aside and in height, and beyond drawn to it by the
/// cube of how much farther it is. Depth as found. Arguments as above.
/// Test: tests/body/landmarks/test_shoulders.cpp
Vec3 drawn_to_pit(const Vec3& merge, const Vec3& pit, const ArmTrace& arm, const Rules& rules,
                  double s);

/// Traces both arms (left first); an arm that cannot be separated from the trunk has no
/// sections.
/// @param levels, graph  of the same skin
/// @param scan_points  the scan's own points where the skin was rebuilt and has lost the
/// fingers' ends; else empty
/// @param rules  with the numbers of the search
std::array<ArmTrace, 2> trace_arms(const LevelStack& levels, const EdgeGraph& graph,
                                   const std::vector<Vec3>& scan_points, const Rules& rules);

} // namespace sloper::body
