#pragma once
/// Lumped mass and stiffness of a garment's surface, for smooth fields over it.
#include <sloper/geometry/types.hpp>

#include <Eigen/SparseCore>

#include <vector>

namespace sloper::garment {

/// Mass and stiffness, #P by #P.
struct SurfaceOperators {
  Eigen::VectorXd mass; ///< m2, a third of the area around each particle, never zero
  Eigen::SparseMatrix<double>
      stiffness; ///< cotangent weights, clamped to [0.05, 20] so that no field overshoots
};

SurfaceOperators surface_operators(const std::vector<Vec3>& positions,
                                   const std::vector<Triangle>& triangles);

} // namespace sloper::garment
