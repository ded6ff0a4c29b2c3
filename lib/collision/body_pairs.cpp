/// BodyCollider::near_pairs(): which elements of a cloth are near which elements of the skin.
#include <sloper/collision/body_collider.hpp>
#include <sloper/collision/chunks.hpp>

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

namespace sloper::collision {

namespace {

/// Boxes in float, lane by lane; those never set overlap nothing.
struct alignas(16) FourBoxes {
  float low[3][4], high[3][4];
  FourBoxes() {
    for (int a = 0; a < 3; ++a)
      for (int i = 0; i < 4; ++i) {
        low[a][i] = std::numeric_limits<float>::infinity();
        high[a][i] = -low[a][i];
      }
  }
  /// Rounded outward, with room for the rounding of what is compared.
  void set(int lane, const Box3& box) {
    for (int a = 0; a < 3; ++a) {
      low[a][lane] = static_cast<float>(box.low[a] - ROUNDING * std::abs(box.low[a]));
      high[a][lane] = static_cast<float>(box.high[a] + ROUNDING * std::abs(box.high[a]));
    }
  }
  /// Bit i is set where box i overlaps that of p and q.
  int overlapping(const Vec3& p, const Vec3& q) const {
    int lanes = 15;
    for (int a = 0; a < 3; ++a)
      lanes &= both_less_equal(
          Float4::load(low[a]), Float4::all(static_cast<float>(std::max(p[a], q[a]))),
          Float4::all(static_cast<float>(std::min(p[a], q[a]))), Float4::load(high[a]));
    return lanes;
  }
  static constexpr double ROUNDING = 3e-7; ///< of a number to float, twice and some
};

bool apart(const Box3& box, const Vec3& p) {
  return (p.array() > box.high.array()).any() || (p.array() < box.low.array()).any();
}

Box3 around(const Vec3& p, const Vec3& q, double margin) {
  return {p.cwiseMin(q).array() - margin, p.cwiseMax(q).array() + margin};
}

} // namespace

void BodyCollider::near_pairs(const std::vector<Vec3>& x, const std::vector<Triangle>& triangles,
                              const Topology& topology, const std::vector<char>& asked,
                              double vertex_radius, double edge_radius, BodyPairs& pairs) const {
  const double vertex_radius2 = vertex_radius * vertex_radius,
               edge_radius2 = edge_radius * edge_radius;
  std::vector<BodyPairs> chunks(n_chunks(triangles.size()));
  const auto search = [&](int f, BodyPairs& found) {
    const Triangle& t = triangles[f];
    const Vec3* c[3] = {&x[t[0]], &x[t[1]], &x[t[2]]};
    Box3 box;
    bool owns_vertex[3];
    Dop near_vertex[3];
    FourBoxes near_edge; // of those that it owns
    for (int k = 0; k < 3; ++k) {
      box.add(*c[k]);
      owns_vertex[k] = topology.triangles_of_vertex(t[k])[0] == f;
      if (owns_vertex[k])
        near_vertex[k] = m_tree.dop_of(around(*c[k], *c[k], vertex_radius));
      if (topology.triangles_of_edge(topology.triangle_edges[f][k])[0] == f)
        near_edge.set(k, around(*c[k], *c[(k + 1) % 3], edge_radius));
    }
    const Box3 face_box = around(box.low, box.high, edge_radius);
    const Dop near_face = m_tree.dop_of(face_box);
    m_tree.visit_lowest(
        m_tree.dop_of(around(box.low, box.high, std::max(vertex_radius, edge_radius))), 0,
        [&](int node) {
          const int lanes_of_face = m_tree.overlapping(node, near_face);
          int lanes_of_vertex[3], lanes = lanes_of_face;
          for (int k = 0; k < 3; ++k)
            lanes |= lanes_of_vertex[k] =
                owns_vertex[k] ? m_tree.overlapping(node, near_vertex[k]) : 0;
          for (; lanes; lanes &= lanes - 1) {
            const int lane = std::countr_zero(static_cast<unsigned>(lanes)),
                      slot = m_tree.nodes()[node].first_slot() + lane,
                      g = m_tree.triangle_of_slot(slot);
            if (!m_skin_of.empty() && m_skin_of[g] < 0)
              continue;
            const std::array<Vec3, 3>& b = m_tree.corners(slot);
            for (int k = 0; k < 3; ++k) {
              if (!(lanes_of_vertex[k] >> lane & 1))
                continue;
              if (const double d2 = point_triangle(*c[k], b[0], b[1], b[2]).squared_distance;
                  d2 <= vertex_radius2)
                found.vertex_face.push_back({t[k], g, std::sqrt(d2)});
            }
            if (!(lanes_of_face >> lane & 1))
              continue;
            for (int j = 0; j < 3; ++j) {
              if ((m_owned[g] & (1 << j)) && !apart(face_box, b[j]))
                if (const double d2 = point_triangle(b[j], *c[0], *c[1], *c[2]).squared_distance;
                    d2 <= edge_radius2)
                  found.face_vertex.push_back({f, m_mesh.triangles[g][j], std::sqrt(d2)});
              if (!(m_owned[g] & (8 << j)))
                continue;
              const Vec3 &b0 = b[j], &b1 = b[(j + 1) % 3];
              for (int edges = near_edge.overlapping(b0, b1); edges; edges &= edges - 1) {
                const int k = std::countr_zero(static_cast<unsigned>(edges));
                if (const double d2 = edge_edge(*c[k], *c[(k + 1) % 3], b0, b1).squared_distance;
                    d2 <= edge_radius2)
                  found.edge_edge.push_back({topology.triangle_edges[f][k], g, j, std::sqrt(d2)});
              }
            }
          }
        });
  };
  parallel_for(triangles.size(), SEARCH_GRAIN, [&](std::size_t begin, std::size_t end) {
    for (std::size_t f = begin; f < end; ++f)
      if (asked[f])
        search(static_cast<int>(f), chunks[begin / SEARCH_GRAIN]);
  });
  pairs.vertex_face.clear();
  pairs.edge_edge.clear();
  pairs.face_vertex.clear();
  for (const BodyPairs& found : chunks) {
    pairs.vertex_face.insert(pairs.vertex_face.end(), found.vertex_face.begin(),
                             found.vertex_face.end());
    pairs.edge_edge.insert(pairs.edge_edge.end(), found.edge_edge.begin(), found.edge_edge.end());
    pairs.face_vertex.insert(pairs.face_vertex.end(), found.face_vertex.begin(),
                             found.face_vertex.end());
  }
}

} // namespace sloper::collision
