#pragma once
/// Lines along which cloth of a panel is folded: drawn through places, taken where they run over
/// the panel.
/// Test: tests/pattern/mesh/test_fold_lines.cpp
#include <sloper/pattern/pattern.hpp>

namespace sloper::pattern {

/// A smooth curve through points: straight through two; through more a cubic spline whose tangent
/// at a point is that of the parabola through it and its neighbours.
/// @param points  m, at least two, no two in a row alike
Path curve_through(const std::vector<Vec2>& points);

/// The stretch of a path that lies on a panel. An end at the outline lies on it exactly, and in its
/// corner where the corner is nearer than `snap_m`.
/// @param file, place  for messages
/// @throws Error INPUT where the path misses the panel, or leaves it and comes back
Path on_panel(const Panel& panel, const Path& path, double snap_m, const std::string& file,
              const std::string& place);

/// A line of kind "roll", walked so that what is turned over lies at its left: the side with less
/// of sewn outline, as of a collar the one with its free edge; where both have alike, the left.
/// @param path  m, on the panel   @param panel  index
InnerLine roll_line(const Pattern& pattern, int panel, const std::string& name, const Path& path);

} // namespace sloper::pattern
