#pragma once
/// Outlines out of the loose lines of a garment DXF. Only for dxf.cpp.
#include <pattern/read/dxf_blocks.hpp>
#include <sloper/pattern/pattern.hpp>

namespace sloper::pattern {

using PointRing = std::vector<Vec2>; ///< m, closed implicitly

/// Signed: positive counter-clockwise.
double ring_area(const PointRing& ring);
double distance_to_ring(const PointRing& ring, const Vec2& p);

/// Closed rings out of a layer's closed polylines and of open ones whose ends meet within `join` m,
/// the largest first.
/// @param unit  m per unit of the file
std::vector<PointRing> rings_of(const DxfBlock& block, int layer, double unit, double join);

/// Whether a sew line runs along a cut line throughout: no allowance or hem is wider than 7 cm.
bool follows(const PointRing& sew, const PointRing& cut);

/// PointRing vertices at which edges begin: turn points of layer 2, or corners of more than 30
/// degrees where there are none.
std::vector<std::size_t> corners_of(const PointRing& ring, const std::vector<Vec2>& turn_points);

/// The edges of a ring from corner to corner, named prefix0, prefix1, ...
std::vector<PanelEdge> edges_of(const PointRing& ring, const std::vector<std::size_t>& corners,
                                const std::string& prefix);

} // namespace sloper::pattern
