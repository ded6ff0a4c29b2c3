#pragma once
/// The few implicit shapes that the mannequin is made of, and how they are blended.
/// Every shape answers a length that is negative inside, zero on the surface and near it about the
/// distance, m.
#include <sloper/geometry/types.hpp>
#include <vector>
namespace sloper::samples {

/// One cross-section of a tube: a superellipse in the local x-z plane with a radius of its own on
/// each of four sides.
struct TubeKnot {
  double y;                  ///< place along the tube
  double center_x, center_z; ///< of the section
  double left, right;        ///< radii toward +x and -x, > 0
  double front, back;        ///< radii toward +z and -z, > 0
  double exponent = 2;       ///< 2 is an ellipse, larger is squarer
};

/// A tube along local y through cross-sections, with rounded ends. Sections are interpolated by
/// monotone cubics (Fritsch and Carlson 1980), so that a girth never overshoots between two knots.
class Tube {
public:
  Tube() = default;
  /// @param knots       two or more, y ascending
  /// @param round_low, round_high  radius of the rounding of the two ends, m
  Tube(const std::vector<TubeKnot>& knots, double round_low, double round_high);
  double distance(const Vec3& p) const;
  TubeKnot section(double y) const; ///< clamped at the ends

private:
  std::vector<TubeKnot> m_table; ///< equally spaced in y
  double m_low = 0, m_high = 1, m_step = 1, m_round_low = 0, m_round_high = 0;
};

/// Monotone cubic through (x, y), constant outside.
class MonotoneCurve {
public:
  MonotoneCurve(std::vector<double> x, std::vector<double> y);
  double at(double x) const;

private:
  std::vector<double> m_x, m_y, m_slope;
};

/// An ellipsoid along the axes (first-order distance).
double ellipsoid_distance(const Vec3& p, const Vec3& center, const Vec3& radii);

/// A cone from a (radius ra) to b (radius rb) with round ends.
double round_cone_distance(const Vec3& p, const Vec3& a, const Vec3& b, double ra, double rb);

/// Union rounded over a width k: the polynomial smooth minimum. k = 0 is the plain minimum.
double smooth_union(double a, double b, double k);

/// Intersection rounded with radius r.
double round_intersection(double a, double b, double r);

/// 0 below low, 1 above high, smooth between.
double smooth_step(double low, double high, double x);

} // namespace sloper::samples
