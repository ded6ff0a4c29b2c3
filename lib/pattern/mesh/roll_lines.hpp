#pragma once
/// Lines over which a collar or a lapel is turned: where its cloth lies afterwards.
/// Test: tests/pattern/mesh/test_roll_lines.cpp
#include <optional>
#include <sloper/pattern/pattern.hpp>

namespace sloper::pattern {

/// The roll lines (kind "roll") of one panel.
class RollLines {
public:
  /// @param panel  its lines are sampled; it is not kept
  explicit RollLines(const Panel& panel);
  /// Whether there are none.
  bool empty() const { return m_lines.empty(); }
  /// Distance of a place from the nearest line, m: positive where the cloth is turned over, which
  /// is to the left of the line; and its mirror image across that line. Beyond its ends a line
  /// goes on straight. Cost: points of all lines.
  /// @pre not empty()
  std::pair<double, Vec2> across(const Vec2& x) const;

private:
  std::vector<std::vector<Vec2>> m_lines;
};

} // namespace sloper::pattern
