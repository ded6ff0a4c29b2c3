#pragma once
/// Rest angles of the hinges that a scene's creases run along.
#include <sloper/cloth/cloth_mesh.hpp>
#include <sloper/garment/garment.hpp>

namespace sloper::garment {

/// Rest angle of each hinge, rad, in the sign of its own order of particles; 0 off the creases.
/// @param open_seams  panels are being sewn: firm creases are pressed in afterwards
/// @throws Error INPUT for a crease on a panel that is not there
std::vector<double> crease_angles(const cloth::ClothMesh& mesh, const Garment& garment,
                                  bool open_seams);

/// Gives the hinges along firm creases their firmness.
void firm_creases(cloth::ClothMesh& mesh, const Garment& garment);

} // namespace sloper::garment
