#pragma once
/// Regrading: the flat pattern made over for another body.
#include <garment/garment.hpp>

namespace sloper::garment {

/// Changes the pattern coordinates of every panel so that the cloth has the strain at `after` that it had at `before`.
///
/// Each triangle's map from `before` to `after` gives a stretch along warp and along weft in the pattern plane; both are
/// smoothed over the panel (a pattern is graded, not moulded), and the panel is laid out again by least squares:
/// minimise sum of area |grad u' - S grad u|^2 per coordinate, S = diag(weft, warp) in the grain's axes. The panel keeps its
/// centroid and grain. Rest length edits (rest_scale) stay as factors. Both sides of a seam are then brought back to the ratio of
/// lengths that they had, mesh edge by mesh edge, each giving way half; the seams' stated lengths are measured again.
void regrade(Garment& garment, const std::vector<Vec3>& before, const std::vector<Vec3>& after);

} // namespace sloper::garment
