#pragma once
/// Cusick's drape test (BS 5058, ISO 9073-9), simulated: a round specimen lies between two discs
/// and hangs over their rim; the drape coefficient is the share of the free ring's area that its
/// shadow from above covers.
/// Test: tests/garment/drapemeter/test_drapemeter.cpp
#include <sloper/cloth/cloth_mesh.hpp>

#include <cstdint>

namespace sloper::garment {

/// Dimensions of the test and of the mesh.
struct DrapemeterSetup {
  /// Of the supporting disc and of the cloth.
  double disc_radius_m = 0.09, specimen_radius_m = 0.15;
  double edge_m = 0.008;        ///< mean edge of the mesh
  const char* membrane = "fem"; ///< "fem", or "springs", whose own shear drapes limp cloth stiffer
};

/// One draped specimen.
struct DrapemeterResult {
  bool at_rest = false;      ///< false: not within the step limit
  int steps = 0;             ///< of the solver
  double coefficient = 0;    ///< 0..1
  int folds = 0;             ///< of the rim, by count_folds()
  double largest_strain = 0; ///< of any mesh edge, l/l0 - 1
  std::vector<Vec3> rim;     ///< in order, m; the disc's middle is the origin, warp runs along z
  std::vector<Triangle> triangles; ///< of the free ring
  std::vector<Vec3> position;      ///< #P by 3, m, y up
};

/// Drapes one specimen. Only the ring outside the disc is meshed; three rings of
/// particles are held, the outermost half a cell beyond the disc's rim. About 1 CPU
/// second at 8 mm.
/// @param setup  radii above 0, the specimen's larger; edge_m below half the free width
/// @param seed  of the unevenness with which the specimen comes down: another one is
/// another drape of the same cloth
/// @throws Error INPUT for a setup outside these ranges
DrapemeterResult drape_specimen(const cloth::Fabric& fabric, const DrapemeterSetup& setup,
                                std::uint64_t seed);

} // namespace sloper::garment
