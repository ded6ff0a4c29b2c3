#pragma once
/// Flat panels of a garment that has no pattern: of its texture coordinates where these are the
/// flat pattern, else of its own surface, unrolled.
#include <garment/ingest/unroll.hpp>
#include <sloper/garment/garment.hpp>

namespace sloper::garment {

/// Panels, rest lengths and which panel vertex is which particle. `panels` has no seams but those
/// between panels, as runs of edges; `placed` is empty.
struct FlatPanels {
  pattern::PanelMesh panels;
  std::vector<int> particle_of;                  ///< #V of the panels
  std::vector<std::array<double, 3>> rest_scale; ///< #F or empty, as Garment::rest_scale
  std::vector<int> triangle_of; ///< #F of the panels: the surface's triangle, which have another
                                ///< order
};

/// Unrolls the surface: a panel grows from its largest triangle, nearest first, each triangle laid
/// out beside those that are there, as long as its edges keep their lengths within
/// UNROLLED_STRETCH; what remains of it is in rest_scale, so that each edge has the length that it
/// has in space. Small leftovers share one panel. Cost: O(n log n).
FlatPanels unrolled_panels(const CurvedSurface& surface);

/// How far texture coordinates are from a flat pattern.
struct TextureIsometry {
  /// Length of a unit of u and of v: least squares of squared lengths; where both are within 2 % of
  /// a metre, centimetre, millimetre or inch, that, so that the strain in space is not lost in it.
  double u_m = 0, v_m = 0;
  double share = 0;        ///< of the area whose edges all have their length within TEXTURE_STRETCH
  bool is_pattern = false; ///< share of TEXTURE_SHARE or more, and no piece that is turned over
                           ///< within itself
};
/// @param texture  coordinates   @param corners  #F into them, -1 where a corner has none
TextureIsometry texture_isometry(const CurvedSurface& surface, const std::vector<Vec2>& texture,
                                 const std::vector<Triangle>& corners);

/// The panels that texture coordinates are: one for each connected piece of them, warp along v.
FlatPanels texture_panels(const CurvedSurface& surface, const std::vector<Vec2>& texture,
                          const std::vector<Triangle>& corners, const TextureIsometry& isometry);

inline constexpr double TEXTURE_STRETCH =
    0.06; ///< worn cloth is stretched by less, all but a little
inline constexpr double TEXTURE_SHARE = 0.9;

} // namespace sloper::garment
