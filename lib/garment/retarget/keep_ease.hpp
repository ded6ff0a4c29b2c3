#pragma once
/// The ease that keep-fit keeps: by how much a garment exceeds its body at close girths.
#include <sloper/body/body.hpp>
#include <sloper/garment/fit/fit_report.hpp>
#include <sloper/garment/garment.hpp>

namespace sloper::garment {

/// A girth of the body with the cloth around it, on both bodies.
struct EaseAtGirth {
  std::string name;    ///< of the girth, as in fit.json(5)
  std::string limb;    ///< "torso", "leg_l", "arm_r"
  Vec3 center;         ///< m, of the girth, in the body frame
  Vec3 axis;           ///< unit, square to the girth
  double ease_m = 0;   ///< garment less body, on the first body
  double wanted_m = 0; ///< garment girth that keeps the ease
  double has_m = 0;    ///< garment girth, by where its particles lie
};

/// The close girths, in the order of the body's places: of limbs all, of the trunk those whose ease
/// is at most 15 % of the girth. More is cloth that hangs past a hollow: it follows what holds it
/// above, and no level of it has an ease of its own.
/// @param placed  bound to the first body, its particles where they lie on the other one
/// @param source  #P by 3, m: where they lay on the first body, whose girths are
/// Garment::body_girths_m
/// @param to  the other body
std::vector<EaseAtGirth> ease_at_girths(const Garment& placed, const std::vector<Vec3>& source,
                                        const body::Body& to);

/// What regrade() is to lengthen threads of sleeves by: the logarithm of wanted over present girth,
/// linear between girths of an arm, along the line from the first to the last, and constant beyond
/// them; each thread takes the share in which it runs around that line. Trouser legs and the trunk
/// are left alone (docs/decisions/keep-fit.md). @param placed, girths  of ease_at_girths()
/// @return  #F: of weft and warp
std::vector<Vec2> lengthening_for_ease(const Garment& placed,
                                       const std::vector<EaseAtGirth>& girths);

/// Close girths whose ease is not that of the first body, to 2 cm and to twice the uncertainty, the
/// most changed first and at most three: "has 14.4 cm more ease at the bust than on the body that
/// it comes from: 22.6 cm, there 8.2 cm"; empty where there is none. Keep-fit warns of it.
std::string changed_ease_text(const FitReport& fit);

} // namespace sloper::garment
