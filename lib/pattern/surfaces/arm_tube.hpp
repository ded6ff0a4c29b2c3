#pragma once
/// The surface that sleeves and cuffs of one piece start on: a tube along the arm's axis, around
/// the middle of the arm at each height, so that the two edges of a piece meet on the far side of
/// the arm and not before it.
#include <pattern/place/body_space.hpp>
#include <pattern/surfaces/section_ring.hpp>

namespace sloper::pattern {

/// The tube of one arm.
class ArmTube {
public:
  static constexpr double ROW = 0.01; ///< m between rows

  /// @param low, high  heights along the axis between which there will be cloth, m. Cost: one pass
  /// over the skin.
  ArmTube(const BodySpace& space, const Axis& axis, bool left, double low, double high);

  std::size_t n_rows() const { return m_section.size(); }
  double height(std::size_t row) const {
    return m_high - ROW * static_cast<double>(row);
  } ///< along the axis, m

  /// @param widths m of cloth on each row   @param gap m, between skin and cloth
  void shape(const std::vector<double>& widths, double gap);

  /// Point in the axis's plane of cloth at height v along it, u m along the tube from the middle of
  /// the side that the axis looks to.
  Vec2 at(double u, double v) const;

private:
  struct Curve {
    std::vector<Vec2> points; ///< closed, from the far side around
    std::vector<double> s;
    double middle = 0; ///< s of the side that the axis looks to
  };
  Curve trace(std::size_t row, double grown) const;
  static Vec2 on(const Curve& curve, double u);

  double m_high;
  std::vector<Ring> m_section;
  std::vector<Vec2> m_center;
  std::vector<Curve> m_curves;
};

} // namespace sloper::pattern
