#pragma once
/// From placed panels to cloth around the body, by way of a coarse mesh of their pattern: sewn and
/// relaxed there (soft_sewing.hpp), carried to the given mesh (finer_mesh.hpp), smoothed and moved
/// off the skin. Test: tests/garment/levels/test_levels.cpp
#include <sloper/base/progress.hpp>
#include <sloper/body/body.hpp>
#include <sloper/garment/garment.hpp>
#include <sloper/garment/scene/settings.hpp>
#include <sloper/garment/simulate/report.hpp>

#include <string>

namespace sloper::garment {

/// Why these panels are not sewn on a coarse mesh; empty: they are. Asks for the pattern that they
/// were made from, edges of at most 30 mm, a body, a garment without pleats, edited rest lengths
/// and scene effects other than creases and roll lines that its mesh has edges along, and effects
/// "auto" with none switched off.
std::string refusal_of_levels(const Garment& garment, const body::Body* body,
                              const DrapeSettings& settings);

/// What is done about cloth that crosses itself after it was carried to the given mesh.
enum class CarriedCrossings {
  KEPT,  ///< nothing: contact draws most of it apart
  SPRUNG ///< folds near it become so stiff for a while that they spring flat, through other cloth
};

/// @param garment  in: placed panels; out: sewn, on the given mesh, around the body and near its
/// rest. Few faces may still cross body or cloth. Forearms in the way of it may be inside cloth
/// (CollisionBody::find_arms_aside()).
/// @param report  in and out: steps, phases, levels
/// @return why it failed, and the garment is as it came; empty: done
std::string sew_on_coarse_mesh(Garment& garment, const body::Body& body,
                               const DrapeSettings& settings, CarriedCrossings crossings,
                               Reporter& reporter, DrapeReport& report);

/// Lets a garment that was placed around a body come near its rest on its own mesh, so that small
/// differences of the placement die out.
/// @param garment  in: sewn and placed, few millimetres in the body at most; out: near its rest
/// @param report  in and out: steps, phases
/// @return why it failed, and the garment is as it came; empty: done
std::string relax_where_placed(Garment& garment, const body::Body& body,
                               const DrapeSettings& settings, Reporter& reporter,
                               DrapeReport& report);

} // namespace sloper::garment
