#pragma once
/// Which effects a scene calls for, and why: pay as you go.
#include <sloper/body/body.hpp>
#include <sloper/garment/garment.hpp>
#include <sloper/garment/scene/effect_report.hpp>
#include <sloper/garment/scene/effect_spec.hpp>
#include <sloper/garment/scene/settings.hpp>

namespace sloper::garment {

/// Every effect that there is, in the order of the report, each on or off with its reason.
///
/// With settings.effects == "auto" an effect is on only for a reason found in the scene;
/// "auto,wind,-friction" changes that choice; else exactly those named (joined by commas) are on.
/// Of the models of stretch (edge_springs, triangle_stretch, membrane) and of bending (bending,
/// dihedral_bending) one takes part. Calls and time are 0 until the drape fills them.
/// @throws Error USAGE for an unknown name or two models of one thing; INPUT for a scene that
/// contradicts itself
std::vector<EffectReport> choose_effects(const Garment& garment, const body::Body* body,
                                         const DrapeSettings& settings);

/// Lets all effects change the rest state: before any is added.
void prepare_mesh(cloth::ClothMesh& mesh, const Garment& garment,
                  const std::vector<EffectReport>& chosen);

/// Adds the effects of a stage that were chosen; those that were not are not built at all.
/// @throws Error INPUT for a panel or landmark that is not there
void add_effects(EffectStage stage, EffectBuild& build, const std::vector<EffectReport>& chosen);

} // namespace sloper::garment
