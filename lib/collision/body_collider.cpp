#include <collision/body_collider.hpp>

#include <base/parallel.hpp>
#include <cmath>
#include <collision/intersections.hpp>

namespace sloper::collision {

namespace {

constexpr double TOUCHING = 1e-12; ///< m; nearer than this the direction to the skin is the skin's normal

} // namespace

BodyCollider::BodyCollider(const TriangleMesh& body, int k) : m_mesh(body) {
  m_topology = make_topology(m_mesh.positions.size(), m_mesh.triangles);
  turn_faces();
  m_tree = TriangleTree(m_mesh.positions, m_mesh.triangles, k);
  m_winding = std::make_shared<LazyWinding>();
  compute_normals();
  assess_trust();
  if (m_findings.buried_triangles > 0) {
    std::vector<Triangle> kept;
    for (int f : m_skin_triangle) kept.push_back(m_mesh.triangles[f]);
    m_skin = TriangleTree(m_mesh.positions, kept, k);
  }
}

void BodyCollider::set_positions(const std::vector<Vec3>& positions) {
  m_mesh.positions = positions;
  m_tree.refit(positions);
  if (m_skin.n_slots() > 0) m_skin.refit(positions);
  m_winding = std::make_shared<LazyWinding>();
  compute_normals();
}

void BodyCollider::compute_normals() {
  m_face_normals.resize(m_mesh.triangles.size());
  parallel_for(m_mesh.triangles.size(), 8192, [&](std::size_t begin, std::size_t end) {
    for (std::size_t f = begin; f < end; ++f) {
      const Triangle& t = m_mesh.triangles[f];
      const Vec3 n = area_normal(m_mesh.positions[t[0]], m_mesh.positions[t[1]], m_mesh.positions[t[2]]);
      const double length = n.norm();
      m_face_normals[f] = length > 0 ? Vec3(n / length) : Vec3(Vec3::Zero());
    }
  });
  m_vertex_normals.resize(m_mesh.positions.size());
  parallel_for(m_mesh.positions.size(), 8192, [&](std::size_t begin, std::size_t end) {
    for (auto v = static_cast<int>(begin); v < static_cast<int>(end); ++v) {
      Vec3 sum = Vec3::Zero();
      for (int f : m_topology.triangles_of_vertex(v)) {
        const Triangle& t = m_mesh.triangles[f];
        const int k = t[0] == v ? 0 : t[1] == v ? 1 : 2;
        const Vec3 e1 = m_mesh.positions[t[(k + 1) % 3]] - m_mesh.positions[v], e2 = m_mesh.positions[t[(k + 2) % 3]] - m_mesh.positions[v];
        sum += std::atan2(e1.cross(e2).norm(), e1.dot(e2)) * m_face_normals[f];
      }
      const double length = sum.norm();
      m_vertex_normals[v] = length > 0 ? Vec3(sum / length) : sum;
    }
  });
  assign_features();
}

void BodyCollider::assign_features() {
  // An edge in a hollow or on flat skin is never the nearest feature: its faces are at least as near.
  constexpr double FLAT_SINE = 1e-3;
  m_owned.assign(m_mesh.triangles.size(), 0);
  parallel_for(m_mesh.triangles.size(), 8192, [&](std::size_t begin, std::size_t end) {
    for (auto f = static_cast<int>(begin); f < static_cast<int>(end); ++f)
      for (int k = 0; k < 3; ++k) {
        const Triangle& t = m_mesh.triangles[f];
        if (m_topology.triangles_of_vertex(t[k])[0] == f) m_owned[f] |= 1 << k;
        const auto around = m_topology.triangles_of_edge(m_topology.triangle_edges[f][k]);
        if (around[0] != f) continue;
        bool convex = around.size() != 2; // at a rim or where sheets meet there is no hollow side to rule out
        if (!convex) {
          const Vec3 along = m_mesh.positions[t[(k + 1) % 3]] - m_mesh.positions[t[k]];
          convex = m_face_normals[f].cross(m_face_normals[around[1]]).dot(along) > FLAT_SINE * along.norm();
        }
        if (convex) m_owned[f] |= 8 << k;
      }
  });
}

Vec3 BodyCollider::pseudonormal(int triangle, int feature) const {
  if (feature < FEATURE_EDGE) return m_vertex_normals[m_mesh.triangles[triangle][feature]];
  if (feature == FEATURE_FACE) return m_face_normals[triangle];
  Vec3 sum = Vec3::Zero();
  for (int f : m_topology.triangles_of_edge(m_topology.triangle_edges[triangle][feature - FEATURE_EDGE])) sum += m_face_normals[f];
  return sum;
}

bool BodyCollider::is_trusted(int triangle, int feature) const {
  if (feature < FEATURE_EDGE) return m_trusted_vertex[m_mesh.triangles[triangle][feature]];
  if (feature == FEATURE_FACE) return m_trusted_face[triangle];
  return m_trusted_edge[m_topology.triangle_edges[triangle][feature - FEATURE_EDGE]];
}

double BodyCollider::winding_number(const Vec3& p) const {
  std::call_once(m_winding->once, [this] { m_winding->winding = WindingNumber(m_tree); });
  return m_winding->winding.at(m_tree, p);
}

SignedDistance BodyCollider::signed_distance(const Vec3& p, double max_distance, int hint_triangle) const {
  ClosestPoint closest;
  if (m_skin_of.empty()) {
    closest = m_tree.closest_point(p, max_distance, hint_triangle);
  } else {
    const bool known = hint_triangle >= 0 && hint_triangle < static_cast<int>(m_skin_of.size());
    closest = m_skin.closest_point(p, max_distance, known ? m_skin_of[hint_triangle] : -1);
    if (closest.triangle >= 0) closest.triangle = m_skin_triangle[closest.triangle];
  }
  SignedDistance result;
  if (closest.triangle < 0) return result;
  result.triangle = closest.triangle;
  result.point = closest.point;
  result.barycentric = closest.barycentric;
  const Vec3 away = p - closest.point, pseudo = pseudonormal(closest.triangle, closest.feature);
  const double distance = away.norm(), height = away.dot(pseudo);
  // a pseudonormal at right angles to the way to p says nothing: rounding, or a fold of the mesh onto itself
  const bool clear = std::abs(height) > 1e-6 * distance * pseudo.norm();
  bool inside;
  if (distance <= TOUCHING) inside = height < 0;
  else if (clear && is_trusted(closest.triangle, closest.feature)) inside = height < 0;
  else inside = is_inside(p);
  result.distance = inside ? -distance : distance;
  if (distance > TOUCHING) result.normal = away / result.distance;
  else result.normal = pseudo.norm() > 0 ? Vec3(pseudo.normalized()) : Vec3(0, 1, 0);
  return result;
}

std::vector<int> BodyCollider::faces_through(const std::vector<Vec3>& positions, const std::vector<Triangle>& triangles) const {
  return triangles_through(positions, triangles, m_tree);
}

} // namespace sloper::collision
