#pragma once
/// From a garment to the cloth that is simulated: which vertices are sewn to which, rest shapes,
/// welding.
#include <sloper/cloth/cloth_mesh.hpp>
#include <sloper/garment/garment.hpp>

namespace sloper::garment {

/// Weld class of each panel vertex: all vertices that seams bring together share one. Classes are
/// numbered by first vertex.
std::vector<int> weld_classes(const pattern::PanelMesh& panels);

/// One particle per panel vertex: the garment as it lies before sewing.
void unsew(Garment& garment);

/// One particle per weld class, at the mean of its vertices' positions. @param position #V by 3, m
void weld(Garment& garment, const std::vector<Vec3>& position);

/// Pairs of particles that the seams join, each once; pairs that are one particle already are left
/// out.
std::vector<std::array<int, 2>> open_stitches(const Garment& garment);

/// For each particle the weld class that it will belong to, -1 where no seam meets it.
std::vector<int> seam_classes(const Garment& garment);

/// Rest state for the solver. Materials by panel; rest lengths scaled by garment.rest_scale; folds
/// of pleats without bending stiffness, unless the scene has creases. @throws Error INPUT
cloth::ClothMesh cloth_mesh_of(const Garment& garment);

} // namespace sloper::garment
