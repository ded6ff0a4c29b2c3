#pragma once
/// Broad phase of continuous self-collision: the pairs of elements whose relative
/// displacement exceeds a share of their distance. A rigid motion of both yields no pair,
/// however fast.
///
/// Two trees of one shape, over positions and over displacements, bound both at every
/// node, so that the common displacement of a node does not count. Test:
/// tests/collision/test_ccd_candidates.cpp
#include <cstdint>
#include <sloper/collision/topology.hpp>
#include <sloper/collision/triangle_tree.hpp>
namespace sloper::collision {

/// The candidates of one cloth's displacement.
class CcdCandidates {
public:
  /// A pair may close this share of its distance before it counts.
  static constexpr double SHARE = 0.9;

  /// Both outlive this.
  CcdCandidates(const std::vector<Triangle>& triangles, const Topology& topology)
      : m_triangles(triangles), m_topology(topology) {}

  /// Every pair that straight motion from x to x + dx, or the same fraction of it for
  /// all, could close by more than SHARE of its distance and to within 0.1 mm. Pairs that
  /// share a particle never count. Costs about as much as a search for pairs in contact
  /// if all are marked, else in proportion to those marked or, again, to what has
  /// changed.
  /// @param x, dx  #particles by 3, m
  /// @param may_meet  #particles: pairs of which no particle is marked cannot meet, and
  /// need not be found
  /// @param again  x is that of the last call: pairs need not be found of which no
  /// particle's displacement has changed since
  /// @param apart  m: pairs nearer than this need not be found, so that neither need those that
  /// move against each other by less than SHARE of it
  void find(const std::vector<Vec3>& x, const std::vector<Vec3>& dx,
            const std::vector<char>& may_meet, bool again, double apart = 0);

  /// Candidates found: vertex, triangle; sorted.
  const std::vector<std::array<int, 2>>& vertex_face() const { return m_vertex_face; }
  /// Candidates found: edges of the topology, the lower first; sorted.
  const std::vector<std::array<int, 2>>& edge_edge() const { return m_edge_edge; }

private:
  void refit(const std::vector<Vec3>& x, const std::vector<Vec3>& dx, bool again);
  void choose(const std::vector<Vec3>& dx, const std::vector<char>& may_meet, bool again);

  const std::vector<Triangle>& m_triangles;
  const Topology& m_topology;
  /// The motion trees hold displacements where the others hold positions.
  TriangleTree m_faces, m_face_motion, m_edges, m_edge_motion;
  std::vector<Vec3> m_last_dx; // of the last call
  std::vector<char> m_chosen;  // #particles: pairs with one of them are looked for
  std::vector<std::uint8_t> m_chosen_faces,
      m_chosen_edges; // by node of the trees, a bit for each child
  std::vector<std::array<int, 2>> m_vertex_face, m_edge_edge;
};

} // namespace sloper::collision
