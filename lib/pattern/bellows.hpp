#pragma once
/// Cloth that is longer than the limb it starts on: a stretch of it laid in waves, so that its end lies where the limb ends. A wave
/// of a flat strip keeps every length; the slope at arc length s is phi sin(2 pi n s / S), so that S J0(phi) of the stretch S remains.
#include <geometry/types.hpp>

#include <vector>

namespace sloper::pattern {

class Bellows {
public:
  Bellows() = default; ///< none: y = v
  /// @param top      m, height in the panel below which waves begin
  /// @param stretch  m of cloth that is laid in waves
  /// @param excess   m to take up; at most 0.7 of the stretch is
  /// @param shortest m, of one wave along the cloth: several mesh edges
  Bellows(double top, double stretch, double excess, double shortest);

  /// For a height v in the panel: (height in the world, distance outwards from the surface), m.
  Vec2 at(double v) const;
  double excess() const { return m_excess; }
  double depth() const { return m_depth; } ///< m, of the waves

private:
  double m_top = 0, m_stretch = 0, m_excess = 0, m_depth = 0;
  std::vector<Vec2> m_table; ///< (fall, out) at equal steps of s
};

} // namespace sloper::pattern
