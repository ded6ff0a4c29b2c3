#pragma once
/// Strain and contact pressure of cloth: the one definition behind reports, fit and maps.
///
/// Strain is l/l0 - 1 of a line in a triangle, with edited rest lengths: along warp, along weft,
/// and along the diagonal between them that is strained more. "The strain" of cloth is the larger
/// in size of warp and weft. Quantiles are by rest area: p99 is what all but a hundredth of the
/// cloth stays below. Contact pressure is Laplace's law, T_warp k_warp + T_weft k_weft, with T the
/// tension per width (stretch stiffness times strain, none where the cloth is slack) and k the
/// curvature of the cloth along the thread, where the middle of the triangle is nearer to the skin
/// than the drape's contact gap and 3 mm; elsewhere it is 0. No unit but the ones named: strain is
/// a plain ratio, pressure is in Pa.
#include <sloper/collision/body_collider.hpp>
#include <sloper/garment/garment.hpp>

namespace sloper::garment {

struct TriangleStrain {
  double warp = 0, weft = 0, bias = 0;
  double area = 0; ///< m2 in the pattern; 0: no strain can be told

  double thread() const {
    return std::abs(warp) >= std::abs(weft) ? warp : weft;
  } ///< the larger in size of warp and weft
};

/// @param position  #P by 3, m   @return #F
std::vector<TriangleStrain> triangle_strains(const Garment& garment,
                                             const std::vector<Vec3>& position);

/// @return #F, Pa; cost: one distance to the skin a triangle that is strained
std::vector<double> contact_pressures(const Garment& garment,
                                      const std::vector<TriangleStrain>& strains,
                                      const collision::BodyCollider& skin);

/// A value and the area that has it.
struct Weighted {
  double value, area;
};
/// The least of the values that a share q of the area does not exceed; 0 of nothing. @param values
/// are put in order
double area_quantile(std::vector<Weighted>& values, double q);

inline constexpr double TOUCHING_M =
    0.003; ///< beyond the drape's contact gap, at which cloth still presses

} // namespace sloper::garment
