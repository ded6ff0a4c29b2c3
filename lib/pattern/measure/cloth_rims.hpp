#pragma once
/// Where the cloth of a sewn garment ends, walked edge by edge over its seams, and how much cloth
/// lies around each vertex of it. Test: tests/pattern/measure/test_half_sewn.cpp
#include <sloper/pattern/panel_mesh.hpp>
#include <sloper/pattern/pattern.hpp>

#include <string>
#include <vector>

namespace sloper::pattern {

/// A vertex of a rim. The walk keeps the cloth to its left.
struct RimVertex {
  int arriving = 0, leaving = 0; ///< vertices of the mesh: of the edges before and after it
  double cloth = 0;              ///< rad of cloth around it; pi where the rim runs straight on
  double cloth_arriving = 0, cloth_leaving = 0; ///< rad of the pieces of those two edges alone
  int pieces = 1;                               ///< of cloth, from the one edge to the other
  double to_next = 0;                           ///< m, along the edge that leaves
};

/// A closed line on which cloth ends.
struct ClothRim {
  std::vector<RimVertex> vertices; ///< in order, the first after the last
  double length = 0;               ///< m
};

/// All rims of the mesh with every seam closed, those that are left open too. A line that meets an
/// edge where three layers are sewn together is left out.
std::vector<ClothRim> cloth_rims(const PanelMesh& mesh);

/// The panel that owns a vertex of the mesh.
int panel_of_vertex(const PanelMesh& mesh, int vertex);

/// Name of the edge of a panel that is nearest to a point of its outline.
std::string edge_nearest_to(const Panel& panel, const Vec2& p);

} // namespace sloper::pattern
