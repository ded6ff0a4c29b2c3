/// BodyCollider::face_contacts(): contacts that cloth vertices alone do not see.
#include <sloper/collision/body_collider.hpp>
#include <sloper/collision/chunks.hpp>

#include <algorithm>
#include <cmath>
#include <optional>

namespace sloper::collision {

namespace {

/// A closest pair counts for a side of the skin only if it lies within 60 degrees of the skin's
/// normal: cloth that stands on the skin like a fin is no contact of this kind, and its sign would
/// be noise.
constexpr double CONE = 0.5;

/// Fills distance and normal of a contact from body point to cloth point; false where the pair has
/// no clear side.
bool set_side(FaceContact& contact, const Vec3& cloth_point, const Vec3& skin_normal) {
  const Vec3 away = cloth_point - contact.body_point;
  const double length = away.norm(), height = away.dot(skin_normal);
  if (length < 1e-12) {
    contact.normal = skin_normal;
    contact.distance = 0;
    return skin_normal.squaredNorm() > 0;
  }
  if (std::abs(height) < CONE * length)
    return false;
  contact.distance = height < 0 ? -length : length;
  contact.normal = away / contact.distance;
  return true;
}

void keep_deepest(std::optional<FaceContact>& best, const FaceContact& contact) {
  if (best && best->distance <= contact.distance &&
      !(best->distance == contact.distance && contact.body_triangle < best->body_triangle))
    return;
  best = contact;
}

} // namespace

std::vector<FaceContact> BodyCollider::face_contacts(const std::vector<Vec3>& positions,
                                                     const std::vector<Triangle>& triangles,
                                                     double radius) const {
  return face_contacts(positions, triangles, make_topology(positions.size(), triangles), radius);
}

std::vector<FaceContact> BodyCollider::face_contacts(const std::vector<Vec3>& positions,
                                                     const std::vector<Triangle>& triangles,
                                                     const Topology& topology,
                                                     double radius) const {
  const double radius2 = radius * radius;
  struct Found {
    std::vector<FaceContact> face, edge;
  };
  std::vector<Found> chunks(n_chunks(triangles.size()));
  const auto search = [&](int f, Found& found) {
    const Triangle& t = triangles[f];
    const Vec3* c[3] = {&positions[t[0]], &positions[t[1]], &positions[t[2]]};
    std::optional<FaceContact> face, edges[3];
    Box3 box, edge_box[3];
    for (const Vec3* p : c)
      box.add(*p);
    box.low.array() -= radius;
    box.high.array() += radius;
    for (int k = 0; k < 3; ++k) {
      if (topology.triangles_of_edge(topology.triangle_edges[f][k])[0] != f)
        continue; // stays empty: nothing meets it
      edge_box[k].low = c[k]->cwiseMin(*c[(k + 1) % 3]).array() - radius;
      edge_box[k].high = c[k]->cwiseMax(*c[(k + 1) % 3]).array() + radius;
    }
    m_tree.visit_overlaps(box, [&](int g) {
      if (m_owned[g] == 0 || (!m_skin_of.empty() && m_skin_of[g] < 0))
        return;
      const Triangle& body = m_mesh.triangles[g];
      for (int j = 0; j < 3; ++j) {
        const Vec3 &b0 = m_mesh.positions[body[j]], &b1 = m_mesh.positions[body[(j + 1) % 3]];
        if ((m_owned[g] & (1 << j)) && (b0.array() >= box.low.array()).all() &&
            (b0.array() <= box.high.array()).all()) {
          const PointTriangle d = point_triangle(b0, *c[0], *c[1], *c[2]);
          if (d.squared_distance <= radius2 && d.feature == FEATURE_FACE) {
            FaceContact contact{ContactKind::FACE, f,  d.barycentric, g,
                                Vec3::Zero(),      b0, Vec3::Zero(),  0};
            contact.body_barycentric[j] = 1;
            if (set_side(contact, d.point, m_vertex_normals[body[j]]))
              keep_deepest(face, contact);
          }
        }
        if (!(m_owned[g] & (8 << j)))
          continue;
        const Vec3 low = b0.cwiseMin(b1), high = b0.cwiseMax(b1);
        for (int k = 0; k < 3; ++k) {
          if ((low.array() > edge_box[k].high.array()).any() ||
              (high.array() < edge_box[k].low.array()).any())
            continue;
          const Vec3 &a0 = *c[k], &a1 = *c[(k + 1) % 3];
          const EdgeEdge d = edge_edge(a0, a1, b0, b1);
          if (d.squared_distance > radius2 || d.s <= 0 || d.s >= 1 || d.t <= 0 || d.t >= 1)
            continue;
          const Vec3 normal = pseudonormal(g, FEATURE_EDGE + j);
          const double length = normal.norm();
          if (!(length > 0))
            continue;
          FaceContact contact{
              ContactKind::EDGE, f, Vec3::Zero(), g, Vec3::Zero(), b0 + d.t * (b1 - b0),
              Vec3::Zero(),      0};
          contact.barycentric[k] = 1 - d.s;
          contact.barycentric[(k + 1) % 3] = d.s;
          contact.body_barycentric[j] = 1 - d.t;
          contact.body_barycentric[(j + 1) % 3] = d.t;
          if (set_side(contact, a0 + d.s * (a1 - a0), normal / length))
            keep_deepest(edges[k], contact);
        }
      }
    });
    if (face)
      found.face.push_back(*face);
    for (const auto& edge : edges)
      if (edge)
        found.edge.push_back(*edge);
  };
  parallel_for(triangles.size(), SEARCH_GRAIN, [&](std::size_t begin, std::size_t end) {
    for (std::size_t f = begin; f < end; ++f)
      search(static_cast<int>(f), chunks[begin / SEARCH_GRAIN]);
  });
  std::vector<FaceContact> contacts;
  for (const Found& found : chunks)
    contacts.insert(contacts.end(), found.face.begin(), found.face.end());
  for (const Found& found : chunks)
    contacts.insert(contacts.end(), found.edge.begin(), found.edge.end());
  return contacts;
}

} // namespace sloper::collision
