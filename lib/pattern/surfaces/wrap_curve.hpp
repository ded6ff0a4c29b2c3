#pragma once
/// The curve that panels are wrapped along: a line in a plane square to a part's axis, measured by
/// arc length, so that a panel laid on the cylinder over it keeps its shape. Plane coordinates are
/// (x, z): z is where the middle of the curve looks.
#include <sloper/geometry/types.hpp>

#include <vector>

namespace sloper::pattern {

/// A curve around a part of the body, by arc length u, m.
class WrapCurve {
public:
  /// Around the front of some points: the convex hull grown by `gap`, its hollows towards the wings
  /// filled with radius `fillet`; where the hull falls behind z = wing the curve goes on straight
  /// to both sides. u = 0 at x = middle_x, u grows with x.
  static WrapCurve front_of(const std::vector<Vec2>& points, double gap, double wing, double fillet,
                            double middle_x);
  /// All around: the hull grown by `gap`, and on until it is at least `length` long. u = 0 at the
  /// front (largest z on x = centre), u grows towards +x.
  static WrapCurve around(const std::vector<Vec2>& points, double gap, double length);

  Vec2
  at(double u) const; ///< straight on beyond the ends of an open curve, periodic on a closed one
  double length() const { return m_s.back(); }
  bool closed() const { return m_closed; }

private:
  void measure();
  std::vector<Vec2> m_points;
  std::vector<double> m_s;
  double m_origin = 0; ///< arc length at u = 0
  bool m_closed = false;
};

} // namespace sloper::pattern
