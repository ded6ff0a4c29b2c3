#pragma once
/// Outline curves: chains of straight and cubic Bezier segments, measured and sampled by arc
/// length.
/// Test: tests/pattern/test_path.cpp
#include <sloper/geometry/types.hpp>

#include <vector>

namespace sloper::pattern {

/// A straight line (p[0] to p[3]) or a cubic Bezier curve, m.
struct Segment {
  std::array<Vec2, 4> p; ///< control points; of a line the inner two are its thirds
  bool line = true;      ///< false: a cubic

  /// The line from a to b.
  static Segment straight(const Vec2& a, const Vec2& b);
  /// A quadratic Bezier curve, raised to a cubic.
  static Segment quadratic(const Vec2& a, const Vec2& control, const Vec2& b);
  /// A cubic Bezier curve.
  static Segment cubic(const Vec2& a, const Vec2& c1, const Vec2& c2, const Vec2& b);
  /// Point at the curve parameter t, clamped to 0..1.
  Vec2 at(double t) const;
  /// Derivative by the parameter, m.
  Vec2 derivative(double t) const;
  /// Arc length between two parameters by 5-point Gauss-Legendre, m; relative error about
  /// 1e-9 for a quarter turn.
  double length(double t0, double t1) const;
  /// The same curve walked from its end.
  Segment reversed() const;
};

using Path = std::vector<Segment>; ///< each segment starts where the one before ends

/// A circle arc as cubic Beziers of at most 15 degrees (radial error below 1e-8 of the radius).
/// @param radius m, raised to half the chord when smaller
/// @param large  the longer of the two arcs
/// @param ccw    turning counter-clockwise (x right, y up) from a to b
Path circle_arc(const Vec2& a, const Vec2& b, double radius, bool large, bool ccw);

/// The same path walked from its end.
Path reversed(const Path& path);

/// Arc length of a path, and points on it. Cost of at(): one binary search and three Newton steps.
class ArcLength {
public:
  /// Measures the path.
  /// @param path  not empty; outlives this
  explicit ArcLength(const Path& path);
  /// Length of the whole path, m.
  double length() const { return m_knots.back().s; }
  Vec2 at(double s) const; ///< s in m, clamped to [0, length]; both ends are returned exactly
  /// Unit tangent at arc length s, m, clamped.
  Vec2 tangent(double s) const;
  /// The stretch from arc length s0 to s1 > s0, m; both ends as at() gives them.
  Path between(double s0, double s1) const;

private:
  struct Knot {
    int segment;
    double t, s;
  };
  std::pair<int, double> locate(double s) const;
  const Path* m_path;
  std::vector<Knot> m_knots; ///< in order of s
};

/// Length of a path, m.
double length(const Path& path);

/// Total turn of the tangent along the stretch [s0, s1] of arc length (m), absolute
/// values of all bends added, rad; corners between segments count.
double turning(const ArcLength& arc, double s0, double s1);

/// Signed area of a closed chain of paths, m2, exact for Beziers; positive when
/// counter-clockwise.
double signed_area(const std::vector<Path>& loop);

} // namespace sloper::pattern
