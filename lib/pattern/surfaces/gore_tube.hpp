#pragma once
/// The surface that a ring of gores starts on: a tube around the trunk that widens as its cloth
/// does, no steeper than a skirt hangs; what is wider than that is laid in folds. Every row of
/// cloth goes around as a whole, seam to seam.
#include <pattern/layout/gore_row.hpp>
#include <pattern/surfaces/section_ring.hpp>

namespace sloper::pattern {

/// The tube of one ring of gores.
class GoreTube {
public:
  /// @param ring it is kept as a reference
  /// @param skin points of the trunk (x to the left, y up, z forwards)
  GoreTube(const GoreRow& ring, const std::vector<Vec3>& skin);

  /// Lays out the tube.
  /// @param gap        m, between skin and cloth
  /// @param upright_to m: rows above this height stay at it, those below rise where the tube
  /// widens, so that cloth is not stretched
  void shape(double gap, double upright_to);

  /// Whether cloth of the tube, as it was laid out last, is in folds.
  bool in_folds() const { return m_in_folds; }
  Vec3 at(std::size_t gore, const Gore::Place& place,
          double out) const; ///< out: m further off the body
  /// m along the level row from the middle of the front, or from that of the back.
  double across(std::size_t gore, const Gore::Place& place) const;
  /// Most that front or back reach to a side in rows above this height, m.
  double reach(Side side, double above) const;

private:
  struct Row {
    double y = 0, cloth = 0,
           length = 0;          ///< m: height, cloth with the least room between, and the curve
    double scale = 1;           ///< of the cloth, where no fold is deep enough
    std::vector<double> middle; ///< of each gore: m along the curve from the front
    std::vector<Vec2> points;   ///< closed, from the front towards the wearer's left; plane (x, z)
    std::vector<double> s;      ///< m to each point
  };
  double height(std::size_t row) const { return m_ring.top - static_cast<double>(row) * STEP; }
  std::vector<double> gaps(double height) const;
  void trace(Row& row, const Ring& radius, double out, double fold) const;
  void spread(Row& row, double height) const;
  Vec2 on(const Row& row, std::size_t gore, double along, double out) const;

  static constexpr double STEP = 0.01; ///< m between rows
  const GoreRow& m_ring;
  std::vector<Ring> m_skin; ///< support functions: all skin from the top down to each row
  Vec2 m_center = Vec2::Zero();
  std::vector<Row> m_rows;
  bool m_in_folds = false;
};

} // namespace sloper::pattern
