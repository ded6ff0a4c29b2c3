#pragma once
/// A panel that is laid out anew in the plane, and what its threads are to stretch by (see
/// retarget_grade.hpp). Test: tests/garment/retarget/test_regrade.cpp
#include <sloper/garment/garment.hpp>
#include <sloper/geometry/sparse_solver.hpp>

#include <array>
#include <vector>

namespace sloper::garment {

/// Area, m2, and gradients, 1/m, of the three hat functions of a triangle; area 0 for one that is
/// no triangle.
struct FlatTriangle {
  double area = 0;
  std::array<Vec2, 3> gradient;
};

/// A panel that is laid out anew, m, in the grain's axes (x weft, y warp); local vertex numbers
/// are global ones less the panel's first.
struct PanelLayout {
  const pattern::PanelInfo* panel;
  Eigen::Matrix2d to_grain; ///< rows: weft, warp
  std::vector<Vec3> flat;   ///< #V: the layout before, z = 0
  std::vector<Triangle> triangles;
  Eigen::MatrixX2d log_stretch;     ///< wanted, at vertices: weft, warp
  std::vector<Vec2> stretch;        ///< the same as a factor, of each triangle
  Eigen::MatrixX2d solved, seams;   ///< the layout; what the seams pull with
  std::vector<FlatTriangle> shapes; ///< #F
  std::vector<Eigen::Triplet<double>> entries;
  SparseSolver solver; ///< of `entries`

  double length_before(int i, int j) const { return (flat[i] - flat[j]).norm(); }
  double length_now(int i, int j) const { return (solved.row(i) - solved.row(j)).norm(); }
};

/// Adds the squared gradient of a function on a panel, its part along an axis of the grain (0:
/// weft, 1: warp) weighed by `along`, the other by `across`, both m2.
void add_gradients(const PanelLayout& layout, int axis, double along, double across,
                   std::vector<Eigen::Triplet<double>>& entries);

/// The symmetric matrix of some entries, n by n.
Eigen::SparseMatrix<double> matrix_of(const std::vector<Eigen::Triplet<double>>& entries, int n);

/// A panel as it is, with the stretch that its cloth is to follow.
/// @param before, after  #P by 3, m: where the cloth lay and lies
/// @param widen_strained_pieces  #F: by what warp and weft are to be longer besides, or empty
PanelLayout stretched_panel(const Garment& garment, const pattern::PanelInfo& panel,
                            const std::vector<Vec3>& before, const std::vector<Vec3>& after,
                            const std::vector<Vec2>& widen_strained_pieces);

} // namespace sloper::garment
