#pragma once
/// Which panels go around a leg: PanelRole::part leg_l or leg_r.
#include <pattern/roles/panel_role.hpp>
#include <pattern/roles/shape_roles.hpp>
#include <pattern/seam_graph.hpp>
#include <sloper/pattern/pattern.hpp>

namespace sloper::pattern {

/// Whether a seam (as SeamGraph::between(k, q) has it) lies at the side of both panels: farther out
/// from the middle, for their width, than up or down, for their height. The sides of gores do,
/// however flat they lean; waists and shoulders do not.
bool at_their_sides(const PanelMesh& mesh, const std::vector<PanelRole>& roles, std::size_t k,
                    std::size_t q, const std::vector<std::array<int, 2>>& seam);

/// A seam between the two panels that rises more than it goes across, or lies at their sides.
bool upright_seam(const PanelMesh& mesh, const SeamGraph& graph,
                  const std::vector<PanelRole>& roles, std::size_t k, std::size_t q);

/// Trouser legs, in four pieces or in one piece a leg, and what is sewn to their ends: cuffs,
/// flounces.
void assign_legs(const Pattern& pattern, const PanelMesh& mesh, const SeamGraph& graph,
                 std::vector<PanelRole>& roles);

/// Whether what was taken for legs, with nothing on the trunk, ends in more rims than trousers,
/// which have a waist and two hems: a shirt of four pieces has neck, hem and two sleeves or
/// armholes. Its neck curves look like a crotch.
bool more_rims_than_trousers(const Pattern& pattern, const PanelMesh& mesh,
                             const std::vector<ShapeRole>& shapes);

} // namespace sloper::pattern
