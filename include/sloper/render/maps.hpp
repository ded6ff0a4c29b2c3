#pragma once
/// Maps: numbers on cloth, with a colour scale that colour-blind people can read.
/// Test: tests/render/test_maps.cpp
#include <sloper/render/scene.hpp>
namespace sloper::render {

/// Strains and PRESSURE are those of the reports (garment/fit/cloth_strain.hpp), area-weighted at
/// vertices, the legend's quantiles by area: STRAIN the larger in size of warp and weft; WARP, WEFT
/// along the threads; BIAS the larger in size of the two diagonals. LIMIT: warp or weft strain,
/// whichever is more of its fabric's limit, in per cent of it. A fabric's limit is its extension
/// under 100 gf/cm, FAST's E100 (De Boos and Tester 1994): 98.07 N/m over its stretch stiffness;
/// what is shortened has none. GAP: distance to the skin, mm. PENETRATION: depth inside the skin,
/// mm. PRESSURE: contact pressure by Laplace's law, Pa. EASE: garment girth - body girth, cm, of
/// the trunk levels, linear in height between them; none on sleeves. DIFFERENCE: distance of two
/// drapes of one pattern at equal stable ids, mm; shown on the first one. SPREAD: standard
/// deviation of a place over re-drapes (drape --redrapes), mm. PARTS: the body's parts.
enum class Map {
  NONE,
  STRAIN,
  WARP,
  WEFT,
  BIAS,
  LIMIT,
  GAP,
  PRESSURE,
  EASE,
  PENETRATION,
  DIFFERENCE,
  PARTS,
  SPREAD
};
/// "none", "strain", "warp" ... in the order of Map.
const std::vector<std::string>& map_names();

/// The range and name of a map, for its colour bar.
struct Legend {
  std::string title, unit;                                 ///< as the colour bar shows them
  double low = 0, high = 0;                                ///< ends of the scale
  double least = 0, p1 = 0, p50 = 0, p99 = 0, largest = 0; ///< of the values
  bool diverging = false;                                  ///< the scale has a neutral middle at 0
  bool has_gaps = false; ///< some cloth has no value: it is drawn in no_value_color()
  /// Shares under `low` and over `high`, 0..1, weighted as the quantiles are.
  double below = 0, beyond = 0;
  std::vector<Vec3> steps; ///< eight colours, linear, low to high; empty: no colour bar
};

/// Computes a map: fills the values of the scene's cloth (for PARTS the body's colours)
/// and returns their legend.
/// @param limit  top of the scale in the map's unit; 0 picks one of a few fixed ranges,
/// so that pictures can be compared
/// @throws Error USAGE when the scene lacks data that the map needs
Legend apply_map(Scene& scene, Map map, double limit = 0);

/// The grey of cloth on which a map has no value, linear RGB: darker than the middle of the
/// diverging scale, without its hues.
Vec3 no_value_color();

/// Colour of a value scaled to 0..1 (or -1..1 for diverging), linear RGB; scales that colour-blind
/// people can read.
Vec3 scale_color(double t, bool diverging);

/// Distance of each panel vertex of `a` to the same place in `b`, m; NO_VALUE where `b`
/// has no such place. Panels are matched by name; places of another mesh are found in the
/// triangles of b's panel by (s, t).
/// @throws Error USAGE where no panel has the same name
std::vector<double> drape_difference(const garment::Garment& a, const garment::Garment& b);

/// The values of a map, one row per panel vertex: document, panel, s, t, x, y, z (m),
/// value. CSV with a header line.
std::string values_csv(const Scene& scene, const Legend& legend);

} // namespace sloper::render
