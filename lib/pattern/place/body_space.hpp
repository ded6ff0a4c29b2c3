#pragma once
/// What placement asks of a body: its skin points by part, the axes of arms, and the heights at
/// which garments hang.
#include <sloper/body/body.hpp>

namespace sloper::pattern {

/// A part's axis with plane coordinates (x, z) square to it: point = origin + x right + v up + z
/// front.
struct Axis {
  Vec3 origin = Vec3::Zero(), up = Vec3::UnitY(), front = Vec3::UnitZ();
  Vec3 right() const { return up.cross(front); } ///< where u grows, seen from outside
  Vec3 point(const Vec2& plane, double v) const {
    return origin + plane.x() * right() + v * up + plane.y() * front;
  }
  Vec2 plane(const Vec3& p) const { return {(p - origin).dot(right()), (p - origin).dot(front)}; }
  double height(const Vec3& p) const { return (p - origin).dot(up); }
};

/// One body, as placement sees it.
class BodySpace {
public:
  explicit BodySpace(const body::Body& body);
  const body::Body& body() const { return m_body; }
  double stature() const { return m_stature; }                    ///< m
  const std::vector<body::Part>& parts() const { return m_part; } ///< of each skin vertex

  /// Skin points of some parts with axis heights in [low, high], in the axis's plane; thinned to
  /// the points that matter for a hull.
  std::vector<Vec2> points(const Axis& axis, const std::vector<body::Part>& parts, double low,
                           double high) const;

  Axis trunk(bool back) const; ///< vertical through the torso
  Axis neck() const;
  /// Along the arm from the shoulder joint to the elbow, or to the wrist for sleeves longer than
  /// the upper arm.
  /// @param facing 0 front, 1 back, 2 the outer, upper side
  Axis arm(bool left, int facing, double sleeve_length) const;

  bool has_arm(bool left) const; ///< whether arm() has the landmarks that it needs

  double shoulder_height(double x) const; ///< of the skin at |x| from the middle, m
  double girth(double y) const; ///< taut, of the trunk (torso and, below it, both legs) with 2 mm
                                ///< of cloth around; 0 where there is none
  /// Height at which the top edge of a skirt or trousers comes to sit, m: slid down from the
  /// narrowest place between bust and hip as far as nothing is stretched; where all is too tight,
  /// where it is stretched least.
  /// @param around m around the garment at every centimetre below its top edge
  /// @param limit  m, no higher than this: where trousers' crotch meets the body's
  double hang_height(const std::vector<double>& around, double limit) const;
  double level(const std::string& name,
               double fallback_fraction) const; ///< y of a level, or that fraction of the stature

private:
  const body::Body& m_body;
  std::vector<body::Part> m_part; ///< of each skin vertex
  double m_stature;
  std::vector<int> m_trunk; ///< triangles of torso and legs
};

} // namespace sloper::pattern
