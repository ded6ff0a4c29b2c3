#include <collision/body_collider.hpp>

#include <base/parallel.hpp>
#include <collision/intersections.hpp>

#include <algorithm>
#include <cmath>

namespace sloper::collision {

namespace {

constexpr double TOUCHING = 1e-12; ///< m; nearer than this the direction to the skin is the skin's normal

/// +1 where triangle t runs along the edge (low, high) from low to high, -1 the other way.
int direction_along(const Triangle& t, const std::array<int, 2>& edge) {
  for (int k = 0; k < 3; ++k)
    if (t[k] == edge[0] && t[(k + 1) % 3] == edge[1]) return 1;
  return -1;
}

/// All triangles at a vertex hang together over shared edges: one fan, no bow tie.
bool is_single_fan(const Topology& topology, const std::vector<Triangle>& triangles, int vertex) {
  const auto around = topology.triangles_of_vertex(vertex);
  if (around.empty()) return false;
  std::vector<int> reached = {around[0]};
  for (std::size_t i = 0; i < reached.size(); ++i)
    for (int k = 0; k < 3; ++k) {
      const Triangle& t = triangles[reached[i]];
      if (t[k] != vertex && t[(k + 1) % 3] != vertex) continue;
      for (int g : topology.triangles_of_edge(topology.triangle_edges[reached[i]][k]))
        if (std::find(reached.begin(), reached.end(), g) == reached.end()) reached.push_back(g);
    }
  return reached.size() == around.size();
}

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

void BodyCollider::turn_faces() {
  // Each manifold piece is made to agree with itself, keeping the orientation that most of its area has.
  const auto n = static_cast<int>(m_mesh.triangles.size());
  std::vector<signed char> turn(n, 0); // 1 keep, -1 turn, 0 not reached
  for (int seed = 0; seed < n; ++seed) {
    if (turn[seed] != 0) continue;
    std::vector<int> piece = {seed};
    turn[seed] = 1;
    double kept_area = 0, turned_area = 0;
    for (std::size_t i = 0; i < piece.size(); ++i) {
      const int f = piece[i];
      const Triangle& t = m_mesh.triangles[f];
      (turn[f] > 0 ? kept_area : turned_area) += area_normal(m_mesh.positions[t[0]], m_mesh.positions[t[1]], m_mesh.positions[t[2]]).norm();
      for (int e : m_topology.triangle_edges[f]) {
        const auto pair = m_topology.triangles_of_edge(e);
        if (pair.size() != 2) continue;
        const int g = pair[0] == f ? pair[1] : pair[0];
        if (turn[g] != 0 || g == f) continue;
        const auto& edge = m_topology.edges[e];
        const bool agree = direction_along(t, edge) != direction_along(m_mesh.triangles[g], edge);
        turn[g] = static_cast<signed char>(agree ? turn[f] : -turn[f]);
        piece.push_back(g);
      }
    }
    if (turned_area > kept_area)
      for (int f : piece) turn[f] = static_cast<signed char>(-turn[f]);
  }
  // Six times the volume about the middle; a body inside out has it negative.
  const Vec3 middle = m_mesh.positions.empty() ? Vec3(Vec3::Zero()) : bounding_box(m_mesh.positions).center();
  double volume = 0;
  for (int f = 0; f < n; ++f) {
    const Triangle& t = m_mesh.triangles[f];
    const Vec3 a = m_mesh.positions[t[0]] - middle, b = m_mesh.positions[t[1]] - middle, c = m_mesh.positions[t[2]] - middle;
    volume += turn[f] * a.dot(b.cross(c));
  }
  for (int f = 0; f < n; ++f)
    if ((turn[f] < 0) != (volume < 0)) {
      std::swap(m_mesh.triangles[f][1], m_mesh.triangles[f][2]);
      std::swap(m_topology.triangle_edges[f][0], m_topology.triangle_edges[f][2]);
      ++m_findings.flipped_triangles;
    }
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

void BodyCollider::assess_trust() {
  const auto n = static_cast<int>(m_mesh.triangles.size());
  m_trusted_face.assign(n, 1);
  m_trusted_edge.assign(m_topology.edges.size(), 1);
  m_trusted_vertex.assign(m_mesh.positions.size(), 1);

  for (std::size_t e = 0; e < m_topology.edges.size(); ++e) {
    const auto pair = m_topology.triangles_of_edge(static_cast<int>(e));
    const auto& edge = m_topology.edges[e];
    const bool good =
        pair.size() == 2 && pair[0] != pair[1] && direction_along(m_mesh.triangles[pair[0]], edge) != direction_along(m_mesh.triangles[pair[1]], edge);
    if (good) continue;
    m_trusted_edge[e] = 0;
    (pair.size() == 1 ? m_findings.boundary_edges : m_findings.non_manifold_edges) += 1;
  }

  // Where the skin passes through itself, the nearer sheet need not be the one that decides.
  const auto crossings = self_intersections(m_mesh.positions, m_mesh.triangles, m_tree);
  m_findings.self_intersections = static_cast<int>(crossings.size());
  std::vector<char> crossed(n, 0);
  for (const auto& [a, b] : crossings) crossed[a] = crossed[b] = 1;

  // Each patch between crossings and untrusted edges is asked by winding number whether its front is outside, its back inside.
  std::vector<char> buried(n, 0);
  std::vector<int> patch_of(n, -1);
  for (int seed = 0; seed < n; ++seed) {
    if (patch_of[seed] >= 0) continue;
    std::vector<int> patch = {seed};
    patch_of[seed] = seed;
    for (std::size_t i = 0; i < patch.size(); ++i)
      for (int e : m_topology.triangle_edges[patch[i]]) {
        if (!m_trusted_edge[e]) continue;
        for (int g : m_topology.triangles_of_edge(e))
          if (patch_of[g] < 0 && crossed[g] == crossed[seed]) {
            patch_of[g] = seed;
            patch.push_back(g);
          }
      }
    if (crossed[seed]) {
      for (int f : patch) m_trusted_face[f] = 0;
      continue;
    }
    int samples = 0, right = 0, inside = 0;
    const std::size_t stride = std::max<std::size_t>(1, patch.size() / 16);
    for (std::size_t i = 0; i < patch.size(); i += stride) {
      const Triangle& t = m_mesh.triangles[patch[i]];
      const Vec3 &a = m_mesh.positions[t[0]], &b = m_mesh.positions[t[1]], &c = m_mesh.positions[t[2]];
      const double size = std::sqrt(area_normal(a, b, c).norm());
      if (!(size > 0)) continue;
      const Vec3 center = (a + b + c) / 3, offset = 1e-3 * size * m_face_normals[patch[i]];
      const bool front = is_inside(center + offset), back = is_inside(center - offset);
      ++samples;
      right += !front && back;
      inside += front && back;
    }
    if (samples == 0 || right < samples)
      for (int f : patch) m_trusted_face[f] = 0;
    if (samples > 0 && inside == samples)
      for (int f : patch) buried[f] = 1;
  }

  for (int f = 0; f < n; ++f) {
    if (m_trusted_face[f]) continue;
    ++m_findings.untrusted_triangles;
    for (int e : m_topology.triangle_edges[f]) m_trusted_edge[e] = 0;
  }
  for (std::size_t e = 0; e < m_topology.edges.size(); ++e)
    if (!m_trusted_edge[e]) m_trusted_vertex[m_topology.edges[e][0]] = m_trusted_vertex[m_topology.edges[e][1]] = 0;
  for (std::size_t v = 0; v < m_mesh.positions.size(); ++v)
    if (m_trusted_vertex[v] && !is_single_fan(m_topology, m_mesh.triangles, static_cast<int>(v))) m_trusted_vertex[v] = 0;

  m_findings.buried_triangles = static_cast<int>(std::count(buried.begin(), buried.end(), 1));
  if (m_findings.buried_triangles == n) m_findings.buried_triangles = 0; // never leave nothing to collide with
  m_skin_triangle.clear();
  m_skin_of.clear();
  if (m_findings.buried_triangles == 0) return;
  m_skin_of.assign(n, -1);
  for (int f = 0; f < n; ++f) {
    if (buried[f]) continue;
    m_skin_of[f] = static_cast<int>(m_skin_triangle.size());
    m_skin_triangle.push_back(f);
  }
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
