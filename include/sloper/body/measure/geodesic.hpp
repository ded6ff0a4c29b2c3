#pragma once
/// Distances along the edges of a mesh. They separate limbs from the trunk where a plane
/// cannot.
#include <sloper/geometry/triangle_mesh.hpp>
#include <vector>
namespace sloper::body {

/// The edges of a mesh as a graph with their lengths, for shortest paths.
class EdgeGraph {
public:
  /// @param mesh  outlives this. O(V + E).
  explicit EdgeGraph(const TriangleMesh& mesh);
  /// Length of the shortest edge path from any of `sources` to every vertex, m; 1e300 where
  /// unreachable or beyond `limit`. Vertices with blocked[v] != 0 are not entered (blocked may be
  /// empty). O(E log V).
  std::vector<double> distances(const std::vector<int>& sources, double limit,
                                const std::vector<char>& blocked) const;

private:
  const TriangleMesh* m_mesh;
  std::vector<int> m_first, m_neighbour;
};

} // namespace sloper::body
