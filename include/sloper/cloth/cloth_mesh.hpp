#pragma once
/// Rest state of a cloth: particles, triangles with their flat rest shape, edge springs, hinges and
/// lumped masses.
#include <sloper/cloth/fabric.hpp>
#include <sloper/geometry/types.hpp>
#include <vector>

namespace sloper::cloth {

/// One triangle of cloth at rest, flat.
struct RestTriangle {
  Triangle particle;        ///< counter-clockwise seen from outside
  std::array<Vec2, 3> flat; ///< rest shape in pattern coordinates with warp along +y, m
  int fabric = 0;           ///< index into ClothMesh::fabrics
};

/// An edge of the mesh as a spring (forces/edge_spring.hpp).
struct EdgeSpring {
  int i, j;           ///< particles, i < j
  double rest_length; ///< l0, m; pattern edits change it, edge by edge
  double stiffness;   ///< N/m
  double damping_s;   ///< stiffness-proportional damping time
};

/// Two triangles over one edge: particles 0 and 1 on the edge, 2 and 3 opposite.
struct Hinge {
  std::array<int, 4> particle; ///< on the edge, then opposite
  /// Of the curvature vector sum_k c_k x_k, 1/m (Bergou et al. 2006)
  std::array<double, 4> coefficient;
  double stiffness; ///< N m times the weight of the hinge: E = 1/2 stiffness |sum_k c_k x_k|^2
  std::array<int, 2> triangle{-1, -1}; ///< whose opposite particles are 2 and 3
  std::array<int, 2> corner{0, 0};     ///< by triangle: the edge runs from this corner to the next
  bool pressed = false;                ///< a fold: no moment over it
  double firmness = 0; ///< N m as `stiffness`, beside it: of a crease that was pressed in
};

/// Rest state of a cloth; make_cloth_mesh() fills it. #P particles, #F triangles.
struct ClothMesh {
  int n_particles = 0;                   ///< #P
  std::vector<RestTriangle> triangles;   ///< #F
  std::vector<Fabric> fabrics;           ///< that triangles refer to
  std::vector<std::array<int, 2>> edges; ///< each once, sorted
  std::vector<EdgeSpring> springs;       ///< one per edge, in the order of `edges`
  std::vector<Hinge> hinges;             ///< interior edges
  double bend_scale = 1;    ///< factor on the rigidity of plates (cloth/bending_plates.hpp)
  std::vector<double> mass; ///< #P, kg; a third of the area density of every triangle around
  std::vector<double> area; ///< #P, m2
  std::vector<double> shortest_edge; ///< #P, m: shortest rest edge around
  double mean_edge() const;          ///< mean rest length of the edge springs, m
  /// Particles of each triangle, #F by 3.
  std::vector<Triangle> particle_triangles() const;
};

/// Derives springs, hinges, masses from the rest triangles.
///
/// Spring stiffness follows Van Gelder 1998: k = Y(direction) * (area of the triangles around) /
/// l0^2, which gives an equilateral mesh the tensile stiffness Y. An edge of two panels (a welded
/// seam) takes the mean of both rest lengths.
/// @param rest_scale  #F by 3 or empty: factor on the rest length of edge k -> k+1 of each triangle
/// (pattern edits)
/// @throws Error INPUT when a triangle has no area, or a particle no triangle
ClothMesh make_cloth_mesh(int n_particles, std::vector<RestTriangle> triangles,
                          std::vector<Fabric> fabrics,
                          const std::vector<std::array<double, 3>>& rest_scale = {});

} // namespace sloper::cloth
