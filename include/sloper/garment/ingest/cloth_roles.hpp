#pragma once
/// What each part of a garment's mesh is to a simulation: cloth that moves by itself, or something
/// that goes along with cloth.
#include <sloper/collision/body_collider.hpp>
#include <sloper/garment/ingest/mesh_surface.hpp>

namespace sloper::garment {

/// Role of one triangle.
enum class ClothRole : unsigned char {
  CLOTH, ///< simulated, as one layer
  LAYER, ///< the outer side and the rim of a shell that has thickness; its inner side is CLOTH
  PATCH, ///< a piece of its own that lies on other cloth everywhere: a pocket, a label, a lining
  RIGID  ///< a small loose part: a button, a buckle
};

/// Roles of all triangles, and how many pieces have them.
struct ClothRoles {
  std::vector<ClothRole> of_triangle;           ///< #F of the surface
  double thickness_m = 0;                       ///< of shells, the median; 0: there is none
  int shells = 0, patches = 0, rigid_parts = 0; ///< connected pieces
};

/// A piece no larger than RIGID_SIZE_M is RIGID, unless it is all that there is. A piece is a shell
/// where most of its area has, within SHELL_DEPTH_M behind it, a side that faces the other way. The
/// side nearer to the skin is simulated: the body meets it, and its girth is the garment's. A piece
/// that lies within PATCH_REACH_M of a larger one is a PATCH; where both are so near, the one
/// nearer to the skin is CLOTH.
/// @param skin  of the body that wears it
/// Cost: one distance to the skin a place, one ray a triangle.
ClothRoles cloth_roles(const MeshSurface& surface, const collision::BodyCollider& skin);

inline constexpr double RIGID_SIZE_M = 0.06;   ///< diagonal of the bounding box
inline constexpr double SHELL_DEPTH_M = 0.025; ///< thicker is no shell, but two sides of a sleeve
inline constexpr double PATCH_REACH_M = 0.008; ///< distance from the larger piece, at most

} // namespace sloper::garment
