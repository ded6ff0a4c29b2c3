#pragma once
/// Keeps smooth cloth clear of what it is drawn with: other cloth, itself, and meshes that are no
/// cloth. Touching counts as crossing. Triangles that share a vertex, or a place where panels are
/// sewn together, do not cross. Results are the same whatever the number of threads.
/// Test: tests/render/test_cloth_surface.cpp
#include <sloper/collision/triangle_tree.hpp>
#include <sloper/render/scene.hpp>

namespace sloper::render {

/// One triangle of a strip along a free border.
struct RimTriangle {
  int mesh;
  std::array<int, 2> border;   ///< the vertices of the mesh between which the strip hangs
  std::array<int, 2> own;      ///< those that are corners of it; twice the same where one is
  std::array<Vec3, 3> corners; ///< m
};

/// Finds and moves smooth cloth that would cross.
class ClothClearance {
public:
  /// Cost: O(n log n) in the draped triangles and in those of other meshes, O(n) in the smooth
  /// ones.
  /// @param meshes smooth cloth is what has a `flat`; its triangles stand as
  /// smooth_cloth() makes them: the pieces of one draped triangle follow each other
  explicit ClothClearance(const std::vector<DrawMesh>& meshes);

  /// Moves smooth cloth that crosses something towards the draped triangles, `flat`, until it does
  /// not, or lies on them. Neighbours follow, so that no step is seen; vertices of different panels
  /// that were sewn together stay together.
  /// Cost: one search over all triangles, then up to MAX_ROUNDS over those that moved.
  /// @param meshes of the constructor; positions are changed
  /// @return count of the triangles that still cross something: their draped triangles do
  int keep_clear(std::vector<DrawMesh>& meshes);

  /// Which triangles of rims cross smooth cloth, other meshes or other rims; 1: crosses.
  std::vector<char> crossing_rims(const std::vector<RimTriangle>& rims) const;

private:
  std::vector<int> all_crossing() const; ///< ascending triangles that cross something
  std::vector<int> crossing(const std::vector<int>& asked) const; ///< those of `asked` that do
  void weld(const std::vector<DrawMesh>& meshes);
  void build_tree(const std::vector<DrawMesh>& meshes);

  std::vector<std::vector<int>> m_vertex_of; ///< by mesh and vertex; empty for other meshes
  std::vector<Vec3> m_positions, m_flat;     ///< m; vertices at one place on a seam are one
  std::vector<Triangle> m_triangles;         ///< smooth cloth, mesh by mesh
  collision::TriangleTree m_tree;            ///< over them
  TriangleMesh m_obstacle_mesh;              ///< what is no cloth
  collision::TriangleTree m_obstacles;       ///< empty without
};

} // namespace sloper::render
