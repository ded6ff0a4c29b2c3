#pragma once
/// From a garment to the cloth that is simulated: welding of seams, and the rest state of
/// the cloth.
#include <sloper/cloth/cloth_mesh.hpp>
#include <sloper/garment/garment.hpp>

namespace sloper::garment {

/// Weld class of each panel vertex, #V: all vertices that seams bring together share one.
/// Classes are numbered by first vertex. Open seams do not weld.
std::vector<int> weld_classes(const pattern::PanelMesh& panels);

/// Gives each panel vertex a particle of its own: the garment as it lies before sewing,
/// at PanelMesh::placed.
void unsew(Garment& garment);

/// Gives each weld class one particle, at the mean of its vertices' positions.
/// @param position  #V by 3, m
void weld(Garment& garment, const std::vector<Vec3>& position);

/// Pairs of particles that the seams join, each once; pairs that are one particle already are left
/// out.
std::vector<std::array<int, 2>> open_stitches(const Garment& garment);

/// For each particle the weld class that it will belong to, -1 where no seam meets it.
std::vector<int> seam_classes(const Garment& garment);

/// Rest state for the solver: materials by panel, rest lengths scaled by
/// Garment::rest_scale, folds of pleats without bending stiffness unless the scene has
/// creases.
/// @throws Error INPUT for a triangle without area
cloth::ClothMesh cloth_mesh_of(const Garment& garment);

} // namespace sloper::garment
