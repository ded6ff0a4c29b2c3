#pragma once
/// Where girths are measured on a body, and which cloth takes part there.
#include <sloper/body/body.hpp>
#include <sloper/garment/garment.hpp>

namespace sloper::garment {

inline constexpr double LEAST_GIRTH_SPREAD =
    0.002; ///< m, of a girth of the skin: the mesh of the scan

/// A plane, the axis that its girth goes round, and the body's own figure there.
struct FitPlace {
  std::string name, kind; ///< as in the body document; "level", "limb" or "neck"
  Vec3 center, normal;
  double body_m = 0, body_spread_m = 0, height_error_m = 0;
  std::vector<std::string>
      frames; ///< cloth whose weight is mostly on these; empty: all that is not mostly on the arms
  std::vector<Vec3> outside;     ///< axes that the line must not go round
  std::vector<Vec3> inside = {}; ///< axes that it must go round besides the centre's
};

/// Trunk levels are cut level, limbs square to the limb, legs level, the neck base through its four
/// landmarks, the neck where a section beside that plane is as long as its girth, calf and ankle
/// where a level section is.
std::vector<FitPlace> fit_places(const body::Body& body);

/// Taut girth of the skin of some parts in a plane, of the outline whose middle is nearest to
/// `center`, m; 0 where there is none.
double skin_girth(const body::Body& body, const std::vector<body::Part>& parts, const Vec3& center,
                  const Vec3& normal);

/// #F: triangles of the garment that belong to a place. @param garment bound
std::vector<char> cloth_of(const Garment& garment, const FitPlace& place);

/// Names that rows of a fit report may have, of limbs without _l or _r: levels and girths of
/// body.json(5) that have a place, and free edges (fit_measure.hpp).
const std::vector<std::string>& fit_row_names();
/// Whether rows of this name of fit_row_names() come for each side, with _l and _r behind it.
bool has_sides(const std::string& row);

/// "left thigh" for "thigh_l", "navel" for "omphalion".
std::string spoken_girth(const std::string& girth);

} // namespace sloper::garment
