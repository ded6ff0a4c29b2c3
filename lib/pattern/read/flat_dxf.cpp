/// Drawings without blocks, as Inkscape, LibreCAD and drafting programs write them: loose lines of
/// any layer that close to outlines.
#include <pattern/read/dxf_rings.hpp>

#include <algorithm>

namespace sloper::pattern {
namespace {

constexpr double JOINS = 1e-3; // of the drawing's size, in which the ends of lines meet

bool encloses(const PointRing& ring, const Vec2& p) {
  bool inside = false;
  for (std::size_t k = 0; k < ring.size(); ++k) {
    const Vec2 &a = ring[k], &b = ring[(k + 1) % ring.size()];
    if ((a.y() > p.y()) != (b.y() > p.y()) &&
        p.x() < a.x() + (p.y() - a.y()) / (b.y() - a.y()) * (b.x() - a.x()))
      inside = !inside;
  }
  return inside;
}

double extent_of(const DxfBlock& block) {
  Vec2 low = Vec2::Constant(1e300), high = Vec2::Constant(-1e300);
  for (const DxfLine& line : block.lines)
    for (const Vec2& p : line.points) {
      low = low.cwiseMin(p);
      high = high.cwiseMax(p);
    }
  return block.lines.empty() ? 0 : (high - low).maxCoeff();
}

} // namespace

std::vector<DxfBlock> pieces_of_drawing(const DxfFile& drawing) {
  DxfBlock lines = drawing.loose;
  for (DxfLine& line : lines.lines)
    line.layer = 1;
  const std::vector<PointRing> rings =
      rings_of(lines, 1, 1, JOINS * extent_of(lines)); // the largest first
  std::vector<PointRing> outer;
  std::vector<DxfBlock> pieces;
  for (const PointRing& ring : rings) {
    if (std::any_of(outer.begin(), outer.end(),
                    [&](const PointRing& other) { return encloses(other, ring[0]); }))
      continue;
    outer.push_back(ring);
    DxfBlock& piece = pieces.emplace_back();
    piece.name = "piece" + std::to_string(pieces.size());
    piece.lines.push_back({1, true, ring});
    for (const DxfText& text : drawing.texts)
      if (encloses(ring, text.p)) {
        piece.texts.push_back(text);
        if (piece.name.rfind("piece", 0) == 0)
          piece.name = text.text;
      }
  }
  return pieces;
}

} // namespace sloper::pattern
