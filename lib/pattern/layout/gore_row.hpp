#pragma once
/// Panels that stand one beside the other around the trunk, with flare in the seams between them:
/// gores, godets, princess panels. Laid flat side by side only their widest rows touch; here each
/// row of cloth is joined at the seams and goes around the body as a whole.
#include <pattern/layout/panel_layout.hpp>

namespace sloper::pattern {

/// One of them, by rows that meet both of its sides squarely: arcs about the point in which the
/// sides would meet, so that a sector of a ring has its own arcs. Rows are known by the height v at
/// which they pass the middle.
class Gore {
public:
  /// @param left, right (u, v) of the seams at its sides
  Gore(std::size_t panel, std::vector<Vec2> left, std::vector<Vec2> right);

  struct Place {
    double row, along; ///< m: height of the row at the panel's middle; along the row from there, to
                       ///< the right as seen from outside
  };
  Place at(const Vec2& uv) const;
  double half_width(double row)
      const; ///< m along the row, between the side seams: armholes above these are bridged

  std::size_t panel;
  bool godet = false; ///< let in between two that are sewn together above it
  Side side = Side::FRONT;
  double theta = 0; ///< rad, where its middle looks if its side is RING

private:
  struct Row {
    double middle = 0, half = 0, flare = 0; ///< m; growth of half for each metre down
  };
  Row row_at(double v) const;
  double m_top, m_step;
  std::vector<Row> m_rows; ///< from m_top down
};

/// Gores one after the other as u runs: from the wearer's right to the left in front, and back
/// again behind.
struct GoreRow {
  std::vector<Gore> gores;
  double top = 0, bottom = 0; ///< heights of the first and the last row, m

  /// Rings, and open rows, that have flare in seams other than those between front and back.
  static std::vector<GoreRow> find(const PanelMesh& mesh, const SeamGraph& graph,
                                   const std::vector<PanelRole>& roles,
                                   const std::vector<PanelSpot>& spots);
};

} // namespace sloper::pattern
