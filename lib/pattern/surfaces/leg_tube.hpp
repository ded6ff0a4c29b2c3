#pragma once
/// The surface that the panels of one trouser leg start on. Below the crotch it is a tube around
/// the leg; above, the half of the hips on the leg's side; between, one turns smoothly into the
/// other, always clear of the plane between the legs. Level rows of cloth lie along level curves,
/// from the inner end in front over the outer side to the inner end behind, unstretched where the
/// curve is long enough; where the cloth is wider the curve is grown.
#include <pattern/place/body_space.hpp>
#include <pattern/roles/panel_role.hpp>
#include <pattern/surfaces/section_ring.hpp>

#include <vector>

namespace sloper::pattern {

/// Cloth of one leg on a level row, m, counted outwards from the legs' inner sides: what the front,
/// the back and pieces that go all around cover. A side that is not there has in > out.
struct LegRow {
  struct Span {
    double in = 1e300, out = -1e300;
    double width() const { return out > in ? out - in : 0; }
  };
  Span front, back, ring; ///< ring: in is the inner end in front, out the one behind
};

/// The surface of one leg.
class LegTube {
public:
  /// The body's side of it: cost is one pass over the skin.
  LegTube(const BodySpace& space, bool left);

  /// Lays out the tube for the cloth of a leg.
  /// @param heights m, of each row in the world, descending or ascending
  /// @param rows    the cloth on each row
  /// @param gap     m, between skin and cloth
  void shape(const std::vector<double>& heights, const std::vector<LegRow>& rows, double gap);

  /// Point of a piece of cloth: `row` counts rows and may lie between two, `t` is in the row's own
  /// count, `out` is m further out.
  Vec3 at(Side side, double t, double row, double out) const;

  double crotch() const { return m_crotch; } ///< height of the body's, m

private:
  struct Curve {
    double y = 0, outer_gap = 0, inner_gap = 0, scale = 1, from = 0, to = 0, seam = 0;
    Vec2 center = Vec2::Zero();
    Ring radius{};
    LegRow cloth;
    std::vector<Vec2> points; ///< (outwards from the middle plane, forwards)
    std::vector<double> s;
  };
  std::size_t bin(double y) const;
  void outline(Curve& curve, double grown) const;
  Vec3 on(const Curve& curve, Side side, double t, double out) const;

  bool m_left;
  double m_low = 0, m_crotch = 0, m_middle = 0;
  std::vector<Ring> m_leg,
      m_trunk; ///< support functions by height: furthest skin in each direction, m from (0, 0)
  std::vector<Ring> m_skin; ///< of the leg alone, not smoothed
  std::vector<Vec2> m_center;
  std::vector<std::vector<Vec2>> m_arms;
  std::vector<Curve> m_curves;
};

} // namespace sloper::pattern
