#pragma once
/// Elements of a moving cloth that are near each other: vertex-face and edge-edge pairs
/// within a radius, each once.
///
/// Every vertex asks the tree of the triangles, every edge that of the edges, once for
/// each unordered pair. Pairs somewhat beyond the radius are kept and measured again
/// while the cloth has moved little since; that changes the cost, never the answer. Test:
/// tests/collision/test_self_proximity.cpp
#include <cstdint>
#include <sloper/collision/topology.hpp>
#include <sloper/collision/triangle_tree.hpp>
namespace sloper::collision {

/// A vertex near a triangle.
struct VertexFacePair {
  int vertex, triangle; ///< indices
  double distance;      ///< m
  Vec3 barycentric;     ///< closest point in the triangle
  bool exempt; ///< a triangle of the vertex now passes through this triangle: nearness is no guide
};
/// Two edges near each other.
struct EdgeEdgePair {
  int edge_a, edge_b; ///< edge_a < edge_b, indices into topology().edges
  double distance;    ///< m
  double s, t;        ///< closest points (1 - s) x[a0] + s x[a1], (1 - t) x[b0] + t x[b1]
  bool exempt;        ///< the triangles of both edges cross now, as for VertexFacePair
};

/// The near pairs of one cloth.
class SelfProximity {
public:
  /// Builds the trees' shape. O(#F).
  /// @param never_collide  for each particle, particles it never collides with (the other
  /// side of an unsewn seam): a pair is left out when a particle of one feature is listed
  /// with one of the other, in either order. Empty, or n_particles lists.
  /// @param k  directions of the trees, see TriangleTree
  SelfProximity(std::size_t n_particles, const std::vector<Triangle>& triangles,
                const std::vector<std::vector<int>>& never_collide = {}, int k = 6);

  /// Finds all pairs at distance <= radius (m) that share no particle.
  /// @param x #particles by 3, m   @param intersecting what self_intersections() gave for x: pairs
  /// of those are marked exempt
  void update(const std::vector<Vec3>& x, double radius,
              const std::vector<std::array<int, 2>>& intersecting = {});

  /// Pairs of the last update, sorted by vertex, triangle.
  const std::vector<VertexFacePair>& vertex_face() const { return m_vertex_face; }
  /// Pairs of the last update, sorted by edge_a, edge_b.
  const std::vector<EdgeEdgePair>& edge_edge() const { return m_edge_edge; }
  /// Whether vertex_face() has this pair: vertex, triangle.
  bool has_vertex_face(const std::array<int, 2>& pair) const;
  /// Whether edge_edge() has this pair; the lower edge first.
  bool has_edge_edge(const std::array<int, 2>& pair) const;

  /// As given, and their topology.
  const std::vector<Triangle>& triangles() const { return m_triangles; }
  const Topology& topology() const { return m_topology; }
  /// Over triangles(), refitted to the x of the last update.
  const TriangleTree& tree() const { return m_tree; }
  /// Number of times that the kept pairs had to be found anew.
  int n_rebuilds() const { return m_rebuilds; }

private:
  struct Candidate {
    int a, b;
    float distance; ///< when it was found, rounded down
  };
  /// Four edges that follow each other in the edge tree: between which particles, and in float from
  /// p along d, by axis and lane.
  struct alignas(16) FourEdges {
    int first[4] = {}, second[4] = {};
    float p[3][4] = {}, d[3][4] = {};
  };
  bool candidates_hold(const std::vector<Vec3>& x, double radius);
  void find_candidates(const std::vector<Vec3>& x, double radius);
  void search_vertices(std::size_t begin, std::size_t end, std::vector<Candidate>& found) const;
  void search_edges(std::size_t begin, std::size_t end, std::vector<Candidate>& found) const;
  bool never_collide(int a, int b) const;
  void mark_exempt(const std::vector<std::array<int, 2>>& intersecting);

  std::vector<Triangle> m_triangles;
  Topology m_topology;
  TriangleTree m_tree, m_edge_tree;        ///< the latter over edges as triangles without area
  std::vector<int> m_never_begin, m_never; ///< symmetric, sorted
  std::vector<FourEdges> m_four_edges;
  std::vector<int> m_tree_vertices; ///< those of triangles, in the order in which the tree has them
  float m_float_slack = 0;          ///< m, what rounding to float may cost
  std::vector<Candidate> m_vertex_face_candidates, m_edge_edge_candidates; ///< sorted
  std::vector<Vec3> m_candidates_x;
  double m_candidates_radius = -1;
  /// The most a particle has moved against the common drift since the candidates were
  /// found, m.
  double m_moved = 0;
  int m_rebuilds = 0, m_updates = 0; ///< updates since the last rebuild
  std::size_t m_particles = 0;
  int m_k = 6;
  std::vector<VertexFacePair> m_vertex_face;
  std::vector<EdgeEdgePair> m_edge_edge;
};

} // namespace sloper::collision
