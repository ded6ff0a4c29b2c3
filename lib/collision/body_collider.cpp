#include <sloper/collision/body_collider.hpp>

#include <sloper/base/parallel.hpp>

#include <algorithm>
#include <cmath>
#include <sloper/collision/intersections.hpp>

namespace sloper::collision {

namespace {

constexpr double TOUCHING =
    1e-12; ///< m; nearer than this the direction to the skin is the skin's normal
constexpr int RIM = -1, NOT_OWNED = -2;
constexpr int OWNED_VERTICES = 7, FIRST_OWNED_EDGE = 8; // bits of m_owned
constexpr std::size_t GRAIN_OF_NORMALS = 8192;          // triangles or vertices to a chunk
constexpr double LEAST_SINE = 1e-6; // of the angle of a point's direction to the skin, for a side

} // namespace

BodyCollider::BodyCollider(const TriangleMesh& body, int k) : m_mesh(body) {
  m_topology = make_topology(m_mesh.positions.size(), m_mesh.triangles);
  turn_faces();
  assign_features();
  m_tree = TriangleTree(m_mesh.positions, m_mesh.triangles, k);
  m_winding = std::make_shared<LazyWinding>();
  compute_normals();
  assess_sign_reliability();
  if (m_findings.buried_triangles > 0)
    m_skin = TriangleTree(m_mesh.positions, skin_triangles(), k);
}

BodyCollider::BodyCollider(const TriangleMesh& body, const PreparedSkin& known, int k)
    : m_mesh(body), m_topology(make_topology(body.positions.size(), body.triangles)),
      m_turned(known.turned), m_findings(known.findings) {
  for (const int f : m_turned)
    turn(f);
  assign_features();
  m_tree = TriangleTree(m_mesh.positions, m_mesh.triangles, k, known.order);
  compute_normals();
  m_trusted_face.assign(m_mesh.triangles.size(), 1);
  m_trusted_edge.assign(m_topology.edges.size(), 1);
  m_trusted_vertex.assign(m_mesh.positions.size(), 1);
  for (const int f : known.untrusted_faces)
    m_trusted_face[f] = 0;
  for (const int side : known.untrusted_edges)
    m_trusted_edge[m_topology.triangle_edges[side / 3][side % 3]] = 0;
  for (const int v : known.untrusted_vertices)
    m_trusted_vertex[v] = 0;
  if (known.buried.empty())
    return;
  std::vector<char> buried(m_mesh.triangles.size(), 0);
  for (const int f : known.buried)
    buried[f] = 1;
  number_skin(buried);
  m_skin = TriangleTree(m_mesh.positions, skin_triangles(), k, known.skin_order);
}

PreparedSkin BodyCollider::prepared() const {
  PreparedSkin found;
  found.turned = m_turned;
  found.findings = m_findings;
  found.order = m_tree.triangle_order();
  found.skin_order = m_skin.triangle_order();
  for (int f = 0; f < std::ssize(m_skin_of); ++f)
    if (m_skin_of[f] < 0)
      found.buried.push_back(f);
  for (int f = 0; f < std::ssize(m_mesh.triangles); ++f) {
    if (!m_trusted_face[f])
      found.untrusted_faces.push_back(f);
    const std::array<int, 3>& sides = m_topology.triangle_edges[f];
    for (int k = 0; k < 3; ++k) {
      const int edge = sides[k];
      if (m_trusted_edge[edge] || m_topology.triangles_of_edge(edge)[0] != f)
        continue;
      const auto before = sides.begin() + k; // a triangle of no width may have one edge twice
      if (std::find(sides.begin(), before, edge) == before)
        found.untrusted_edges.push_back(3 * f + k);
    }
  }
  for (int v = 0; v < std::ssize(m_trusted_vertex); ++v)
    if (!m_trusted_vertex[v])
      found.untrusted_vertices.push_back(v);
  return found;
}

std::vector<Triangle> BodyCollider::skin_triangles() const {
  std::vector<Triangle> kept;
  kept.reserve(m_skin_triangle.size());
  for (const int f : m_skin_triangle)
    kept.push_back(m_mesh.triangles[f]);
  return kept;
}

void BodyCollider::set_positions(const std::vector<Vec3>& positions) {
  m_mesh.positions = positions;
  m_tree.refit(positions);
  if (m_skin.n_slots() > 0)
    m_skin.refit(positions);
  m_winding = std::make_shared<LazyWinding>();
  compute_normals();
}

void BodyCollider::compute_normals() {
  const std::size_t n = m_mesh.triangles.size();
  m_face_normals.resize(n);
  std::vector<Vec3> angles(n);
  parallel_for(n, GRAIN_OF_NORMALS, [&](std::size_t begin, std::size_t end) {
    for (std::size_t f = begin; f < end; ++f) {
      const Triangle& t = m_mesh.triangles[f];
      const Vec3 corner[3] = {m_mesh.positions[t[0]], m_mesh.positions[t[1]],
                              m_mesh.positions[t[2]]};
      const Vec3 normal = area_normal(corner[0], corner[1], corner[2]);
      const double length = normal.norm();
      m_face_normals[f] = length > 0 ? Vec3(normal / length) : Vec3(Vec3::Zero());
      for (int k = 0; k < 3; ++k) {
        const Vec3 e1 = corner[(k + 1) % 3] - corner[k], e2 = corner[(k + 2) % 3] - corner[k];
        angles[f][k] = std::atan2(e1.cross(e2).norm(), e1.dot(e2));
      }
    }
  });
  // triangle by triangle, as they lie in memory: of a large scan a vertex does not know where its
  // triangles are without waiting for them
  m_vertex_normals.assign(m_mesh.positions.size(), Vec3::Zero());
  for (std::size_t f = 0; f < n; ++f)
    for (int k = 0; k < 3; ++k)
      m_vertex_normals[m_mesh.triangles[f][k]] += angles[f][k] * m_face_normals[f];
  parallel_for(m_mesh.positions.size(), GRAIN_OF_NORMALS, [&](std::size_t begin, std::size_t end) {
    for (std::size_t v = begin; v < end; ++v)
      if (const double length = m_vertex_normals[v].norm(); length > 0)
        m_vertex_normals[v] /= length;
  });
  find_convex_edges();
}

void BodyCollider::assign_features() {
  m_owned.assign(m_mesh.triangles.size(), 0);
  m_beyond.assign(m_mesh.triangles.size(), {NOT_OWNED, NOT_OWNED, NOT_OWNED});
  parallel_for(m_mesh.triangles.size(), GRAIN_OF_NORMALS, [&](std::size_t begin, std::size_t end) {
    for (auto f = static_cast<int>(begin); f < static_cast<int>(end); ++f)
      for (int k = 0; k < 3; ++k) {
        if (m_topology.triangles_of_vertex(m_mesh.triangles[f][k])[0] == f)
          m_owned[f] |= 1 << k;
        const auto around = m_topology.triangles_of_edge(m_topology.triangle_edges[f][k]);
        if (around[0] == f)
          m_beyond[f][k] = around.size() == 2 ? around[1] : RIM;
      }
  });
}

void BodyCollider::find_convex_edges() {
  // An edge in a hollow or on flat skin is never the nearest feature: its faces are at least as
  // near.
  constexpr double FLAT_SINE = 1e-3;
  parallel_for(m_mesh.triangles.size(), GRAIN_OF_NORMALS, [&](std::size_t begin, std::size_t end) {
    for (std::size_t f = begin; f < end; ++f) {
      m_owned[f] &= OWNED_VERTICES;
      for (int k = 0; k < 3; ++k) {
        const int beyond = m_beyond[f][k];
        if (beyond == NOT_OWNED)
          continue;
        // At a rim or where sheets meet there is no hollow side to rule out.
        bool convex = beyond == RIM;
        if (!convex) {
          const Triangle& t = m_mesh.triangles[f];
          const Vec3 along = m_mesh.positions[t[(k + 1) % 3]] - m_mesh.positions[t[k]];
          const Vec3 turn = m_face_normals[f].cross(m_face_normals[beyond]);
          convex = turn.dot(along) > FLAT_SINE * along.norm();
        }
        if (convex)
          m_owned[f] |= FIRST_OWNED_EDGE << k;
      }
    }
  });
}

Vec3 BodyCollider::pseudonormal(int triangle, int feature) const {
  if (feature < FEATURE_EDGE)
    return m_vertex_normals[m_mesh.triangles[triangle][feature]];
  if (feature == FEATURE_FACE)
    return m_face_normals[triangle];
  Vec3 sum = Vec3::Zero();
  for (int f :
       m_topology.triangles_of_edge(m_topology.triangle_edges[triangle][feature - FEATURE_EDGE]))
    sum += m_face_normals[f];
  return sum;
}

bool BodyCollider::is_trusted(int triangle, int feature) const {
  if (feature < FEATURE_EDGE)
    return m_trusted_vertex[m_mesh.triangles[triangle][feature]];
  if (feature == FEATURE_FACE)
    return m_trusted_face[triangle];
  return m_trusted_edge[m_topology.triangle_edges[triangle][feature - FEATURE_EDGE]];
}

double BodyCollider::winding_number(const Vec3& p) const {
  std::call_once(m_winding->once, [this] { m_winding->winding = WindingNumber(m_tree); });
  return m_winding->winding.at(m_tree, p);
}

SignedDistance BodyCollider::signed_distance(const Vec3& p, double max_distance,
                                             int hint_triangle) const {
  ClosestPoint closest;
  if (m_skin_of.empty()) {
    closest = m_tree.closest_point(p, max_distance, hint_triangle);
  } else {
    const bool known = hint_triangle >= 0 && hint_triangle < std::ssize(m_skin_of);
    closest = m_skin.closest_point(p, max_distance, known ? m_skin_of[hint_triangle] : -1);
    if (closest.triangle >= 0)
      closest.triangle = m_skin_triangle[closest.triangle];
  }
  SignedDistance result;
  if (closest.triangle < 0)
    return result;
  result.triangle = closest.triangle;
  result.point = closest.point;
  result.barycentric = closest.barycentric;
  const Vec3 away = p - closest.point;
  const Vec3 pseudo = pseudonormal(closest.triangle, closest.feature);
  const double distance = away.norm();
  const double height = away.dot(pseudo);
  // A pseudonormal at right angles to the direction of p says nothing: rounding, or a fold of the
  // mesh onto itself.
  const bool clear = std::abs(height) > LEAST_SINE * distance * pseudo.norm();
  const bool by_normal =
      distance <= TOUCHING || (clear && is_trusted(closest.triangle, closest.feature));
  const bool inside = by_normal ? height < 0 : is_inside(p);
  result.distance = inside ? -distance : distance;
  if (distance > TOUCHING)
    result.normal = away / result.distance;
  else
    result.normal = pseudo.norm() > 0 ? Vec3(pseudo.normalized()) : Vec3(0, 1, 0);
  return result;
}

std::vector<int> BodyCollider::faces_through(const std::vector<Vec3>& positions,
                                             const std::vector<Triangle>& triangles) const {
  return triangles_through(positions, triangles, m_tree);
}

} // namespace sloper::collision
