#pragma once
/// From what a scene adds to a garment (effect_inputs.hpp) to effects of the solver.
#include <garment/scene/effect_inputs.hpp>

namespace sloper::cloth {
class ClothSolver;
struct ClothMesh;
} // namespace sloper::cloth
namespace sloper::body {
struct Body;
}

namespace sloper::garment {

struct Garment;
struct EffectReport;

/// Panel vertices of a run, in order. @throws Error INPUT naming the panels when there is none of that name
std::vector<int> run_vertices(const Garment& garment, const PanelRun& run);

/// Adds the effects that the report says are active and that garment.scene describes: triangle_stretch, membrane,
/// dihedral_bending, pins, attachments, elastic_bands, wind, pressure. Those that are not active are not built at all.
/// @param body    for attachments to landmarks; nullptr for none
/// @param sewing  true while seams are open: only stretch, bending and pins take part
/// @throws Error INPUT for a panel or landmark that is not there
void add_scene_effects(cloth::ClothSolver& solver, const cloth::ClothMesh& mesh, const Garment& garment, const body::Body* body,
                       const std::vector<EffectReport>& effects, bool sewing);

} // namespace sloper::garment
