#pragma once
/// The raw content of a garment DXF (R12 and later, text): per block its polylines, points and
/// texts by layer. No meaning yet.
#include <sloper/geometry/types.hpp>

#include <string>
#include <vector>

namespace sloper::pattern {

/// A polyline.
struct DxfLine {
  int layer = 0;
  bool closed = false;
  std::vector<Vec2> points; ///< file units
};

/// A POINT: notches, drill holes and turn points are such.
struct DxfPoint {
  int layer = 0;
  Vec2 p = Vec2::Zero();
};

/// A TEXT with the place where it begins.
struct DxfText {
  int layer = 0;
  Vec2 p = Vec2::Zero();
  std::string text; ///< UTF-8
};

/// A block, which a garment DXF has for each piece.
struct DxfBlock {
  std::string name;
  std::vector<DxfLine> lines; ///< POLYLINE, LWPOLYLINE and LINE entities
  std::vector<DxfPoint> points;
  std::vector<DxfText> texts;
};

/// A file.
struct DxfFile {
  int insunits = -1, measurement = -1; ///< $INSUNITS, $MEASUREMENT; -1 when absent
  std::vector<DxfBlock> blocks;        ///< in file order; names may repeat
  std::vector<DxfText> texts;          ///< outside of blocks
  DxfBlock loose;                      ///< lines and points outside of blocks
};

/// A file without blocks that have lines is a flat drawing: it comes back with `blocks` empty.
/// @throws Error INPUT naming the line
DxfFile parse_dxf(const std::string& text, const std::string& file);

/// The pieces of a flat drawing, as programs without blocks write it: outlines that close, and lie
/// in no other. A text inside names a piece.
std::vector<DxfBlock> pieces_of_drawing(const DxfFile& drawing);

} // namespace sloper::pattern
