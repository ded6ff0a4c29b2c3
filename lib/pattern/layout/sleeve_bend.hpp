#pragma once
/// Sleeves cut in one with front or back (kimono, dolman, batwing): drawn level or nearly so, they
/// would start beside hanging arms and never close around them. The drawing is bent at the shoulder
/// until they lie along the arm; what is below the arm is drawn together and what is above spread,
/// evenly enough that no part of the panel comes to lie on another. The drape takes it from there.
#include <sloper/geometry/types.hpp>

#include <optional>
#include <vector>

namespace sloper::pattern {

/// The bend of one such sleeve.
class SleeveBend {
public:
  /// @param outlines  of the panels on one side of the trunk, closed, m: x along the cloth from the
  /// middle, y the height
  /// @param sign      +1 for the sleeve at large x, -1 for the other
  /// @param shoulder  where the arm's joint lies under the cloth, in the same plane
  /// @param elevation rad, of the arm above the level, seen from the front: negative for arms that
  /// hang
  /// @return nothing where there is no sleeve: where the cloth at the arm's height reaches no
  /// farther out than below it or than the shoulder
  static std::optional<SleeveBend> find(const std::vector<std::vector<Vec2>>& outlines, double sign,
                                        const Vec2& shoulder, double elevation);
  Vec2 at(const Vec2& p) const; ///< where a point of the drawing goes, m, in the same plane

private:
  double m_sign = 1, m_axis = 0, m_angle = 0,
         m_crook =
             0; // rad, the sleeve's own elevation and its turn; m, height where it leaves the trunk
  Vec2 m_shoulder = Vec2::Zero();
};

} // namespace sloper::pattern
