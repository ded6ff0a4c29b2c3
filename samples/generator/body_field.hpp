#pragma once
/// The implicit surface of a mannequin: tubes, ellipsoids and round cones, blended.
#include "implicit_shapes.hpp"
#include "mannequin.hpp"
namespace sloper::samples {

/// Factors on the cross-sections, found by fit() so that the girths come out as asked.
struct GirthFactors {
  double neck = 1, chest = 1, underbust = 1, waist = 1, abdomen = 1, hip = 1;
  double thigh = 1, knee = 1, calf = 1, ankle = 1, upper_arm = 1, forearm = 1, wrist = 1;
  double breast_m = 0; ///< how far the breasts are pushed out, m
};

class BodyField {
public:
  BodyField(const Mannequin& shape, const GirthFactors& factors);

  double all(const Vec3& p) const;          ///< the whole figure
  double without_arms(const Vec3& p) const; ///< head, trunk and legs
  double arm(const Vec3& p) const;          ///< left arm alone; p in the figure's frame
  double trunk(const Vec3& p) const;        ///< trunk and shoulders, without legs, head, arms
  double trunk_tube(const Vec3& p) const {
    return m_trunk.distance(p);
  }                                ///< trunk alone, without breasts and buttocks
  double leg(const Vec3& p) const; ///< left leg and foot alone

  /// The figure's joints and heights, m.
  double stature, y_neck_back, y_neck_front, y_bust, y_chest, y_underbust, y_fold, y_waist,
      y_omphalion, y_hip, y_crotch_knot;
  Vec3 hip_joint, knee, ankle, shoulder_joint, elbow, wrist, hand_tip, breast_center,
      breast_radii; ///< left side
  double lift = 0;  ///< 0 arms hanging .. 1 arms level: how far the shoulders are raised
  double leg_slope; ///< x per metre down, of the leg
  Vec3 from_arm(const Vec3& q) const; ///< left arm's own frame (y toward the shoulder) -> figure
  Vec3 to_arm(const Vec3& p) const;
  Vec3 neck_axis_point(double y) const; ///< middle of the neck at height y
  Vec3 neck_front_direction()
      const; ///< in the plane square to the neck's axis, forward and a little down
  double upper_arm_length, forearm_length, hand_length;

private:
  void build_trunk(const GirthFactors& g);
  void build_head(const GirthFactors& g);
  void build_arm(const GirthFactors& g);
  void build_leg(const GirthFactors& g);
  double head(const Vec3& p) const;
  Mannequin m_shape;
  bool m_female;
  Tube m_trunk, m_neck, m_face, m_arm, m_leg, m_foot;
  Vec3 m_arm_x, m_arm_y; ///< axes of the arm's frame
  Vec3 m_buttock, m_buttock_radii;
  double m_foot_turn = 0;
};

} // namespace sloper::samples
