/// BodyCollider::near_pairs(): which elements of a cloth are near which elements of the skin.
#include <collision/body_collider.hpp>
#include <collision/chunks.hpp>

#include <algorithm>

namespace sloper::collision {

namespace {

bool apart(const Box3& a, const Vec3& low, const Vec3& high) { return (low.array() > a.high.array()).any() || (high.array() < a.low.array()).any(); }

Box3 box_of(const Vec3& p, const Vec3& q, double margin) { return {p.cwiseMin(q).array() - margin, p.cwiseMax(q).array() + margin}; }

} // namespace

void BodyCollider::near_pairs(const std::vector<Vec3>& x, const std::vector<Triangle>& triangles, const Topology& topology, const std::vector<char>& asked,
                              double vertex_radius, double edge_radius, BodyPairs& pairs) const {
  const double vertex_radius2 = vertex_radius * vertex_radius, edge_radius2 = edge_radius * edge_radius;
  const double widest = std::max(vertex_radius, edge_radius);
  std::vector<BodyPairs> chunks(n_chunks(triangles.size()));
  const auto search = [&](int f, BodyPairs& found) {
    const Triangle& t = triangles[f];
    const Vec3* c[3] = {&x[t[0]], &x[t[1]], &x[t[2]]};
    Box3 box, edge_box[3];
    bool owns_vertex[3], owns_edge[3];
    for (int k = 0; k < 3; ++k) {
      box.add(*c[k]);
      owns_vertex[k] = topology.triangles_of_vertex(t[k])[0] == f;
      owns_edge[k] = topology.triangles_of_edge(topology.triangle_edges[f][k])[0] == f;
      edge_box[k] = box_of(*c[k], *c[(k + 1) % 3], edge_radius);
    }
    const Box3 face_box{box.low.array() - edge_radius, box.high.array() + edge_radius};
    box.low.array() -= widest;
    box.high.array() += widest;
    m_tree.visit_overlaps(box, [&](int g) {
      if (!m_skin_of.empty() && m_skin_of[g] < 0) return;
      const Triangle& body = m_mesh.triangles[g];
      const Vec3* b[3] = {&m_mesh.positions[body[0]], &m_mesh.positions[body[1]], &m_mesh.positions[body[2]]};
      const Box3 body_box{b[0]->cwiseMin(*b[1]).cwiseMin(*b[2]).array() - vertex_radius, b[0]->cwiseMax(*b[1]).cwiseMax(*b[2]).array() + vertex_radius};
      for (int k = 0; k < 3; ++k)
        if (owns_vertex[k] && !apart(body_box, *c[k], *c[k]) && point_triangle(*c[k], *b[0], *b[1], *b[2]).squared_distance <= vertex_radius2)
          found.vertex_face.push_back({t[k], g});
      for (int j = 0; j < 3; ++j) {
        if ((m_owned[g] & (1 << j)) && !apart(face_box, *b[j], *b[j]) && point_triangle(*b[j], *c[0], *c[1], *c[2]).squared_distance <= edge_radius2)
          found.face_vertex.push_back({f, body[j]});
        if (!(m_owned[g] & (8 << j))) continue;
        const Vec3 &b0 = *b[j], &b1 = *b[(j + 1) % 3];
        const Vec3 low = b0.cwiseMin(b1), high = b0.cwiseMax(b1);
        for (int k = 0; k < 3; ++k)
          if (owns_edge[k] && !apart(edge_box[k], low, high) && edge_edge(*c[k], *c[(k + 1) % 3], b0, b1).squared_distance <= edge_radius2)
            found.edge_edge.push_back({topology.triangle_edges[f][k], g, j});
      }
    });
  };
  parallel_for(triangles.size(), SEARCH_GRAIN, [&](std::size_t begin, std::size_t end) {
    for (std::size_t f = begin; f < end; ++f)
      if (asked[f]) search(static_cast<int>(f), chunks[begin / SEARCH_GRAIN]);
  });
  pairs.vertex_face.clear();
  pairs.edge_edge.clear();
  pairs.face_vertex.clear();
  for (const BodyPairs& found : chunks) {
    pairs.vertex_face.insert(pairs.vertex_face.end(), found.vertex_face.begin(), found.vertex_face.end());
    pairs.edge_edge.insert(pairs.edge_edge.end(), found.edge_edge.begin(), found.edge_edge.end());
    pairs.face_vertex.insert(pairs.face_vertex.end(), found.face_vertex.begin(), found.face_vertex.end());
  }
}

} // namespace sloper::collision
