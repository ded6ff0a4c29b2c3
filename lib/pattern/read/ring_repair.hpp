#pragma once
/// What drawing programs leave in a cut line and no cloth has: slits, overshoots, the seam
/// allowance.
#include <pattern/read/dxf_rings.hpp>

namespace sloper::pattern {

/// Takes off where the line goes out and comes back along itself: slit notches drawn as part of the
/// cut line, ends that overshoot.
/// @return where slits began on the outline, m; overshoots, shorter than 1 mm, are none
std::vector<Vec2> take_slits_off(PointRing& ring);

/// A counter-clockwise ring with each side moved inwards, corners mitred; sides that come to
/// nothing are left out.
/// @param by       #ring, m: how far the side from point k to the next one moves
/// @param corners  indices of points, brought to those of the result
PointRing inset(const PointRing& ring, const std::vector<double>& by,
                std::vector<std::size_t>& corners);

/// A cut line moved inwards by its seam allowance, m, but not where it lies on a mirror line (layer
/// 6): there it is cut on the fold.
/// @param unit  m per unit of the file
PointRing without_allowance(const PointRing& ring, const DxfBlock& block, double unit,
                            double allowance, std::vector<std::size_t>& corners);

/// Whether the ring is its own mirror image, about an upright or a level line through its middle.
bool is_symmetric(const PointRing& ring);

/// m along the axes.
Vec2 size_of(const PointRing& ring);

/// Whether it is a rectangle along the axes.
bool is_box(const PointRing& ring);

} // namespace sloper::pattern
