#pragma once
/// Outline curves: chains of straight and cubic Bezier segments, measured and sampled by arc
/// length.
#include <sloper/geometry/types.hpp>

#include <vector>

namespace sloper::pattern {

/// A straight line (p[0] to p[3]) or a cubic Bezier curve, m.
struct Segment {
  std::array<Vec2, 4> p;
  bool line = true;

  static Segment straight(const Vec2& a, const Vec2& b);
  static Segment quadratic(const Vec2& a, const Vec2& control, const Vec2& b);
  static Segment cubic(const Vec2& a, const Vec2& c1, const Vec2& c2, const Vec2& b);
  Vec2 at(double t) const;
  Vec2 derivative(double t) const;
  double length(double t0,
                double t1) const; ///< by Gauss-Legendre, about 1e-9 relative for a quarter turn
  Segment reversed() const;
};

using Path = std::vector<Segment>; ///< each segment starts where the one before ends

/// A circle arc as cubic Beziers of at most 15 degrees (radial error below 1e-8 of the radius).
/// @param radius m, raised to half the chord when smaller
/// @param large  the longer of the two arcs
/// @param ccw    turning counter-clockwise (x right, y up) from a to b
Path circle_arc(const Vec2& a, const Vec2& b, double radius, bool large, bool ccw);

Path reversed(const Path& path);

/// Arc length of a path, and points on it. Cost of at(): one binary search and three Newton steps.
class ArcLength {
public:
  explicit ArcLength(const Path& path);
  double length() const { return m_knots.back().s; }
  Vec2 at(double s) const; ///< s in m, clamped to [0, length]; both ends are returned exactly
  Vec2 tangent(double s) const;
  Path
  between(double s0,
          double s1) const; ///< the stretch from s0 to s1 > s0, m; both ends as at() gives them

private:
  struct Knot {
    int segment;
    double t, s;
  };
  std::pair<int, double> locate(double s) const;
  const Path* m_path;
  std::vector<Knot> m_knots; ///< in order of s
};

double length(const Path& path);

/// How far the tangent turns along the stretch [s0, s1] (m), all bends added, rad; corners between
/// segments count.
double turning(const ArcLength& arc, double s0, double s1);

/// Signed area of a closed chain of paths, m2, exact for Beziers; positive when counter-clockwise.
double signed_area(const std::vector<Path>& loop);

} // namespace sloper::pattern
