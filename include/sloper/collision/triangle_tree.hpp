#pragma once
/// k-DOP tree over the triangles of a mesh (Klosowski et al. 1998; four children to a node, Wald et
/// al. 2008), flat arrays. Built once by median splits of the triangle centres, refitted from the
/// leaves up when the vertices move. Bounds are floats rounded outward, so that no double-precision
/// contact is lost. k = 6 is the axis-aligned box; more directions reject more pairs and cost more
/// each. Queries are const and may run on several threads. Test:
/// tests/collision/test_triangle_tree.cpp
#include <sloper/base/simd4.hpp>
#include <sloper/collision/distance.hpp>
#include <sloper/geometry/triangle_mesh.hpp>

#include <bit>
#include <limits>
namespace sloper::collision {

/// The closest point of a mesh to a point.
struct ClosestPoint {
  int triangle = -1;               ///< -1: none within the distance asked for
  Vec3 point = Vec3::Zero();       ///< m
  Vec3 barycentric = Vec3::Zero(); ///< weights of the triangle's corners
  double squared_distance = std::numeric_limits<double>::infinity(); ///< m2
  int feature = FEATURE_FACE;                                        ///< 0..6, see distance.hpp
};

/// Most directions of a k-DOP.
inline constexpr int MAX_AXES = 13;
/// A k-DOP: intervals of direction . p for the first k/2 directions of DOP_DIRECTIONS, m.
struct Dop {
  /// Ends of the intervals, rounded outwards.
  float low[MAX_AXES], high[MAX_AXES];
};
/// Directions of k-DOPs: x, y and z first, then vectors with components in {-1, 0, 1},
/// not of unit length.
extern const std::array<Vec3, MAX_AXES> DOP_DIRECTIONS;

/// The tree of one mesh.
class TriangleTree {
public:
  /// Four children: boxes in x, y, z, lane by lane, and where they lead. Either all are nodes or,
  /// of a lowest node, all are slots: four that follow each other, the first a multiple of four;
  /// the last lowest node may have fewer.
  struct alignas(16) Node {
    /// Boxes of the children, m, by axis and lane.
    float low[3][4], high[3][4];
    int child[4];    ///< >= 0 a node, EMPTY, or <= -2: slot -2 - child
    int slot_end[4]; ///< one past the last slot below the child; slots of a subtree are consecutive
    bool is_lowest() const { return child[0] <= -2; }
    int first_slot() const { return -2 - child[0]; } ///< of a lowest node
  };
  /// Child of a lowest node that has fewer than four.
  static constexpr int EMPTY = -1;

  TriangleTree() = default;
  /// @param k 6, 14, 18 or 26; anything else throws Error INTERNAL. Cost O(#F log #F).
  TriangleTree(const std::vector<Vec3>& positions, const std::vector<Triangle>& triangles,
               int k = 6);
  /// The same tree without the sorting, which is most of the cost. O(#F).
  /// @param order triangle_order() of a tree over these triangles, however many directions it has;
  /// a permutation in any case
  TriangleTree(const std::vector<Vec3>& positions, const std::vector<Triangle>& triangles, int k,
               std::vector<int> order);

  /// New bounds for moved vertices; same triangles. O(#F), parallel.
  /// @param for_points  false spares what makes closest_point() fast: it answers the same, some
  /// times slower
  void refit(const std::vector<Vec3>& positions, bool for_points = true);

  /// Closest point of the mesh within max_distance (may be infinite), the lowest triangle index
  /// where distances tie.
  /// @param hint_triangle a triangle that may be near (the last answer), or -1; it changes the
  /// cost, never the answer.
  /// @param p  m
  ClosestPoint closest_point(const Vec3& p, double max_distance, int hint_triangle = -1) const;

  /// The least fraction of the segment from a to b at which it meets a triangle, seen
  /// from either side, or infinity.
  double first_hit(const Vec3& a, const Vec3& b) const;

  /// Calls visit(triangle) for every triangle whose bounds overlap the box, in no particular but
  /// fixed order.
  template<class Visit> void visit_overlaps(const Box3& box, Visit&& visit) const {
    visit_slots(dop_of(box), 0, [&](int slot) { visit(m_triangle_of_slot[slot]); });
  }

  /// Calls visit(slot) for every slot >= first_slot whose k-DOP overlaps `query` (k/2 intervals
  /// used).
  template<class Visit> void visit_slots(const Dop& query, int first_slot, Visit&& visit) const {
    visit_lowest(query, first_slot, [&](int node) {
      const int slot = m_nodes[node].first_slot();
      for (int lanes = overlapping(node, query); lanes; lanes &= lanes - 1) {
        const int i = std::countr_zero(static_cast<unsigned>(lanes));
        if (slot + i >= first_slot)
          visit(slot + i);
      }
    });
  }
  /// Calls visit(node) for every lowest node with a slot >= first_slot whose k-DOP overlaps
  /// `query`: for a query that holds several, each of which is then asked of the node with
  /// overlapping().
  template<class Visit> void visit_lowest(const Dop& query, int first_slot, Visit&& visit) const;
  /// Bit i is set where the k-DOP of child i of the node overlaps `query`.
  int overlapping(int node, const Dop& query) const;

  /// The k-DOP of a box.
  Dop dop_of(const Box3& box) const;
  /// Bounds of the triangle in a slot, each face moved outwards by `margin`, m.
  Dop dop_of_slot(int slot, double margin) const;

  /// Number of slots: triangles in tree order.
  int n_slots() const { return static_cast<int>(m_triangle_of_slot.size()); }
  /// Triangle of a slot, and of all slots in order.
  int triangle_of_slot(int slot) const { return m_triangle_of_slot[slot]; }
  const std::vector<int>& triangle_order() const { return m_triangle_of_slot; }
  /// Slot of a triangle: the inverse of triangle_of_slot().
  int slot_of_triangle(int triangle) const { return m_slot_of_triangle[triangle]; }
  /// Corners of the triangle in a slot at the last refit, m.
  const std::array<Vec3, 3>& corners(int slot) const { return m_corners[slot]; }
  /// All nodes, the root first, parents before children.
  const std::vector<Node>& nodes() const { return m_nodes; }
  /// Directions of the bounds, 6 to 26.
  int k() const { return 2 * m_axes; }

private:
  /// The up to four triangles of a lowest node in float: first corner and the two sides from it, by
  /// axis and lane.
  struct alignas(16) Leaves {
    float a[3][4], ab[3][4], ac[3][4];
  };
  static Float4 squared_distances(const Leaves& leaves, const Float4 (&p)[3]);
  void fill_leaves();
  int build(int begin, int end);
  void refit_node(int node);

  int m_axes = 3;
  std::vector<Node> m_nodes;
  std::vector<std::array<float, 8>> m_extra; ///< (m_axes - 3) per node: low and high of four lanes
  std::vector<Leaves> m_leaves;              ///< of the nodes whose children are all triangles
  std::vector<int> m_leaves_of_node;         ///< -1 for other nodes
  bool m_leaves_hold = false;                ///< m_leaves are of the last refit
  float m_leaf_slack = 0; ///< m, how far a distance by Leaves may be above the true one
  std::vector<std::array<int, 2>> m_subtrees; ///< node ranges that refit independently
  std::vector<int> m_top_nodes;               ///< the nodes above those
  std::vector<Triangle> m_slot_vertices;      ///< in slot order
  std::vector<std::array<Vec3, 3>> m_corners; ///< in slot order
  std::vector<int> m_triangle_of_slot, m_slot_of_triangle;
};

inline int TriangleTree::overlapping(int node, const Dop& query) const {
  const Node& n = m_nodes[node];
  int mask = (1 << 4) - 1;
  if (n.child[3] == EMPTY) // what is infinite overlaps the bounds of what is not there, too
    for (int i = 1; i < 4; ++i)
      if (n.child[i] == EMPTY)
        mask &= ~(1 << i);
  for (int a = 0; a < 3; ++a)
    mask &= both_less_equal(Float4::load(n.low[a]), Float4::all(query.high[a]),
                            Float4::all(query.low[a]), Float4::load(n.high[a]));
  if (m_axes == 3)
    return mask;
  const auto* extra = m_extra.data() + static_cast<std::size_t>(node) * (m_axes - 3);
  for (int a = 3; a < m_axes && mask; ++a, ++extra)
    for (int i = 0; i < 4; ++i)
      if (!((*extra)[i] <= query.high[a] && query.low[a] <= (*extra)[4 + i]))
        mask &= ~(1 << i);
  return mask;
}

template<class Visit>
void TriangleTree::visit_lowest(const Dop& query, int first_slot, Visit&& visit) const {
  if (m_nodes.empty())
    return;
  int stack[128], top = 0; // at most three waiting siblings a level, and the tree is balanced
  stack[top++] = 0;
  while (top > 0) {
    const int index = stack[--top];
    const Node& node = m_nodes[index];
    if (node.is_lowest()) {
      visit(index);
      continue;
    }
    for (int lanes = overlapping(index, query); lanes; lanes &= lanes - 1) {
      const int i = std::countr_zero(static_cast<unsigned>(lanes));
      if (node.slot_end[i] > first_slot)
        stack[top++] = node.child[i];
    }
  }
}

} // namespace sloper::collision
