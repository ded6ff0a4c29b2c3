#pragma once
/// The affine map of each triangle from its rest shape to space, the basis of every
/// triangle model of stretch: w_u = sum_k du_k x_k (image of one metre of weft), w_v =
/// sum_k dv_k x_k (of warp), Baraff and Witkin 1998, section 4.2.
#include <sloper/cloth/cloth_mesh.hpp>
#include <sloper/cloth/linear/block_matrix.hpp>

namespace sloper::cloth {

/// The map of one triangle.
struct TriangleMap {
  Triangle particle;                    ///< corners
  std::array<double, 3> du, dv;         ///< 1/m
  double area;                          ///< of the rest shape, m2
  int fabric;                           ///< index into ClothMesh::fabrics
  std::array<int, 3> slots = {0, 0, 0}; ///< blocks (0,1), (1,2), (2,0), after find_slots()
  /// Image of a metre of weft, w_u.
  Vec3 u(const std::vector<Vec3>& x) const {
    return du[0] * x[particle[0]] + du[1] * x[particle[1]] + du[2] * x[particle[2]];
  }
  /// Image of a metre of warp, w_v.
  Vec3 v(const std::vector<Vec3>& x) const {
    return dv[0] * x[particle[0]] + dv[1] * x[particle[1]] + dv[2] * x[particle[2]];
  }
};

/// One map per triangle of the mesh, in its order.
///
/// The rest shape is the triangle's flat shape with the rest lengths of its edge springs, so that
/// pattern edits and gathered seams, which change l0, hold for the triangle models as well: flat' =
/// sqrt(G) flat with the metric G for which e_k^T G e_k = l0_k^2 on its three edges. Lengths that
/// no triangle can have leave the flat shape scaled by their mean.
std::vector<TriangleMap> make_triangle_maps(const ClothMesh& mesh);

/// Appends the three pairs of each triangle.
void declare_pairs(const std::vector<TriangleMap>& maps, std::vector<std::array<int, 2>>& pairs);
/// Fills the slots from a matrix that has these pairs.
void find_slots(std::vector<TriangleMap>& maps, const BlockMatrix& matrix);

/// Adds block (k, l) of a triangle, l = (k + 1) % 3, to the half of the matrix that is stored.
inline void add_side(const TriangleMap& map, int k, const Mat3& block, BlockMatrix& stiffness) {
  if (map.particle[k] < map.particle[(k + 1) % 3])
    stiffness.add_off_diagonal(map.slots[k], block);
  else
    stiffness.add_off_diagonal(map.slots[k], block.transpose());
}

} // namespace sloper::cloth
