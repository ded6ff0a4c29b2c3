#pragma once
/// Strain and contact pressure of cloth: the one definition behind reports, fit and maps.
///
/// Strain is l/l0 - 1 of a line in a triangle, with edited rest lengths: along warp, along weft,
/// and along the diagonal between them that is strained more. "The strain" of cloth is the larger
/// in size of warp and weft: a triangle that a gather presses together by more than it is drawn out
/// is not stretched. Quantiles are by rest area: p99 is what all but a hundredth of the cloth stays
/// below. Contact pressure is Laplace's law, T_warp k_warp + T_weft k_weft, with T the tension per
/// width (stretch stiffness times strain, none where the cloth is slack) and k the curvature of the
/// cloth along the thread, where the middle of the triangle is nearer to the skin than the drape's
/// contact gap and 3 mm; elsewhere it is 0. No unit but the ones named: strain is a plain ratio,
/// pressure is in Pa.
/// Test: tests/garment/fit/test_cloth_strain.cpp
#include <sloper/collision/body_collider.hpp>
#include <sloper/garment/garment.hpp>

#include <algorithm>
#include <cmath>
#include <optional>

namespace sloper::garment {

/// Strains of one triangle along the fabric's directions.
struct TriangleStrain {
  /// Ratio l/l0 - 1; bias is of the diagonal that is strained more.
  double warp = 0, weft = 0, bias = 0;
  double area = 0;  ///< m2 in the pattern; 0: degenerate, without a strain
  double least = 0; ///< in the direction in which it is pressed together most

  /// The larger in size of warp and weft, of crushed cloth the smaller and at most 0.
  double thread() const {
    if (std::max(warp, weft) > 0 && -least > std::max(warp, weft))
      return std::min({warp, weft, 0.0});
    return std::abs(warp) >= std::abs(weft) ? warp : weft;
  }
};

/// Strains of all triangles. O(#F).
/// @param position  #P by 3, m
/// @return #F
std::vector<TriangleStrain> triangle_strains(const Garment& garment,
                                             const std::vector<Vec3>& position);

/// Contact pressure of each triangle by Laplace's law (file comment). One distance to the
/// skin for each triangle that is strained.
/// @param strains  of triangle_strains()
/// @return #F, Pa
std::vector<double> contact_pressures(const Garment& garment,
                                      const std::vector<TriangleStrain>& strains,
                                      const collision::BodyCollider& skin);

/// A value and the area that has it.
struct Weighted {
  double value, area; ///< of any unit; m2
};
/// The least of the values that a share q of the area does not exceed; 0 of nothing. @param values
/// are put in order
double area_quantile(std::vector<Weighted>& values, double q);

/// Strain of places, #P: of the triangles in `list` around each particle the mean by area; nothing
/// where there are none. The strain of a single flat triangle may be too high by a third.
/// @param strains  #F, of triangle_strains()
/// @param list  indices of triangles
std::vector<std::optional<double>> strains_around(const Garment& garment,
                                                  const std::vector<TriangleStrain>& strains,
                                                  const std::vector<int>& list);

/// Distance beyond the drape's contact gap within which cloth still presses, m.
inline constexpr double TOUCHING_M = 0.003;

} // namespace sloper::garment
