#pragma once
/// The edges of unsewn panels as sides that seams may join, with what their shape says.
#include <sloper/pattern/pattern.hpp>

#include <array>
#include <string>
#include <vector>

namespace sloper::pattern {

/// A run of consecutive edges of one loop, walked along the outline. Angles are those of the cloth
/// at the corners where it begins and ends.
struct SeamSide {
  static constexpr int SAMPLES = 7;
  int panel = 0, first = 0, count = 1; ///< edges first .. first + count - 1, around the loop
  int loop_begin = 0, loop_size = 0;   ///< of that loop, as Panel::edge counts
  double length = 0;                   ///< m
  Vec2 chord = Vec2::Zero();           ///< m, across the grain and along it
  Vec2 place = Vec2::Zero(); ///< of its middle in the panel's box along the grain, 0 to 1 by axis
  double share = 0;          ///< length over the half perimeter of the panel
  double corner_start = 0, corner_end = 0; ///< rad
  std::array<double, SAMPLES> offset{};    ///< from the chord to its left, over the length
  double bulge = 0;                        ///< mean of the offsets
  std::vector<double> notches;             ///< m from the start, ascending
  std::string name; ///< of a single edge without its side, empty where it is only numbered
  int hand = 0;     ///< side that the name of edge or panel tells: 1 left, -1 right
  int before = -1, after = -1; ///< indices of the sides next to it

  int last() const { return loop_begin + (first - loop_begin + count - 1) % loop_size; }
};

/// Where sides begin: edges by index, ascending, of each panel.
using SideCorners = std::vector<std::vector<int>>;

/// Every edge a side of its own.
SideCorners all_corners(const Pattern& pattern);

/// Corners at which the outline turns by `straight_on`, rad, or more; two of each loop at least.
/// CAD files cut sides up where curves were digitised. A side that no other one is as long as is
/// cut where both parts have their like: a sleeve cap at the shoulder.
SideCorners sharp_corners(const Pattern& pattern, double straight_on);

/// Sides that are no shorter than `shortest`, m, in pattern order.
std::vector<SeamSide> seam_sides(const Pattern& pattern, const SideCorners& corners,
                                 double shortest);

/// Measures a run of edges.
SeamSide measure_side(const Pattern& pattern, int panel, int first, int count);

/// Which panels are mirror images of each other about the grain.
struct PanelMirror {
  int panel = -1, sum = 0; ///< edge e is edge (sum - e) of the other, around the outer loop
  int image(int edge, int n) const { return ((sum - edge) % n + n) % n; }
};

/// All mirror images of each panel among the panels, itself too where it is symmetric.
std::vector<std::vector<PanelMirror>> panel_mirrors(const Pattern& pattern);

} // namespace sloper::pattern
