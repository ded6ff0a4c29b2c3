#pragma once
/// Cusick's drape test (BS 5058, ISO 9073-9), simulated: a round specimen lies between two discs
/// and hangs over their rim; the drape coefficient is the share of the free ring's area that its
/// shadow from above covers.
#include <sloper/cloth/cloth_mesh.hpp>

#include <cstdint>

namespace sloper::garment {

struct DrapemeterSetup {
  double disc_radius_m = 0.09, specimen_radius_m = 0.15;
  double edge_m = 0.009;        ///< mean edge of the mesh
  const char* membrane = "fem"; ///< "fem", or "springs", whose own shear drapes limp cloth stiffer
};

struct DrapemeterResult {
  bool at_rest = false;
  int steps = 0;
  double coefficient = 0; ///< 0..1
  int folds = 0;          ///< of the rim, by count_folds()
  double largest_strain = 0;
  std::vector<Vec3> rim; ///< in order, m; the disc's middle is the origin, warp runs along z
  std::vector<Triangle> triangles; ///< of the free ring
  std::vector<Vec3> position;
};

/// Drapes one specimen. Only the ring outside the disc is meshed; three rings of particles are
/// held, the outermost half a cell beyond the disc's rim.
/// @param setup  radii above 0, the specimen's larger; edge_m below half the free width
/// @param seed   of how the specimen comes down: another one is another drape of the same cloth
/// @throws Error INPUT for a setup that is none. About 1 CPU second at 9 mm
DrapemeterResult drape_specimen(const cloth::Fabric& fabric, const DrapemeterSetup& setup,
                                std::uint64_t seed);

} // namespace sloper::garment
