#pragma once
/// What a panel is on the body: which region it covers, from which side, and how its drawing is
/// turned there.
#include <Eigen/Core>
#include <cmath>
#include <optional>
#include <sloper/geometry/types.hpp>
#include <string>

namespace sloper::pattern {

inline constexpr double PANEL_GAP = 0.01; ///< m: between neighbouring edges when panels are placed

/// Whether a seam goes more across than up. The sides of a quarter of a circle, which go as far up
/// as across but for rounding, are upright ones.
/// @param along (across, up) from one end to the other, any unit
inline bool goes_level(const Vec2& along) {
  return std::abs(along.x()) > 1.05 * std::abs(along.y());
}

/// Part of the body that a panel covers.
enum class Region {
  TRUNK,
  ARM_L,
  ARM_R,
  NECK
}; ///< TRUNK is everything about the vertical axis: bodice, skirt, trouser legs

/// From where it covers it.
enum class Side {
  FRONT,
  BACK,
  RING
}; ///< RING goes around: a one-piece sleeve, a waistband in one piece, side gores

/// What one panel is on the body.
struct PanelRole {
  Region region = Region::TRUNK;
  Side side = Side::FRONT;
  std::string part; ///< for PanelInfo: torso, arm_l, leg_l, lower_body, neck
  double theta = 0; ///< rad, RING only: where its middle looks (0 front, +pi/2 the wearer's left)
  Eigen::Matrix2d turn = Eigen::Matrix2d::Identity(); ///< pattern coordinates to (u, v): v up the
                                                      ///< trunk, or up the arm to the shoulder
  bool by_shape = false;                              ///< known by shape and seams alone
  bool unsure_front = false;                          ///< front and back fit nearly as well
  std::optional<double> du, dv; ///< m: (u, v) = turn p + (du, dv) where the pattern's hint says so;
                                ///< heights are those of its own body
};

/// Whether the panel goes around a leg of trousers.
inline bool is_leg(const PanelRole& role) {
  return role.part == "leg_l" || role.part == "leg_r";
}

} // namespace sloper::pattern
