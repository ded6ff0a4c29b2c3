#pragma once
/// The raw content of a garment DXF (R12 and later, text): per block its polylines, points and
/// texts by layer. No meaning yet.
#include <geometry/types.hpp>

#include <string>
#include <vector>

namespace sloper::pattern {

struct DxfLine {
  int layer = 0;
  bool closed = false;
  std::vector<Vec2> points; ///< file units
};
struct DxfPoint {
  int layer = 0;
  Vec2 p = Vec2::Zero();
};
struct DxfText {
  int layer = 0;
  Vec2 p = Vec2::Zero();
  std::string text; ///< UTF-8
};
struct DxfBlock {
  std::string name;
  std::vector<DxfLine> lines; ///< POLYLINE, LWPOLYLINE and LINE entities
  std::vector<DxfPoint> points;
  std::vector<DxfText> texts;
};
struct DxfFile {
  int insunits = -1, measurement = -1; ///< $INSUNITS, $MEASUREMENT; -1 when absent
  std::vector<DxfBlock> blocks;        ///< in file order; names may repeat
  std::vector<DxfText> texts;          ///< outside of blocks
};

/// @throws Error INPUT naming the line
DxfFile parse_dxf(const std::string& text, const std::string& file);

} // namespace sloper::pattern
