/// BodyCollider: to which side the skin faces, and where its pseudonormals can be believed.
#include <sloper/base/parallel.hpp>
#include <sloper/collision/body_collider.hpp>
#include <sloper/collision/intersections.hpp>

#include <algorithm>
#include <cmath>

namespace sloper::collision {

namespace {

/// +1 where triangle t runs along the edge (low, high) from low to high, -1 from high to low.
int direction_along(const Triangle& t, const std::array<int, 2>& edge) {
  for (int k = 0; k < 3; ++k)
    if (t[k] == edge[0] && t[(k + 1) % 3] == edge[1])
      return 1;
  return -1;
}

/// All triangles at a vertex hang together over shared edges: one fan, no bow tie.
bool is_single_fan(const Topology& topology, const std::vector<Triangle>& triangles, int vertex) {
  const auto around = topology.triangles_of_vertex(vertex);
  if (around.empty())
    return false;
  std::vector<int> reached = {around[0]};
  for (std::size_t i = 0; i < reached.size(); ++i)
    for (int k = 0; k < 3; ++k) {
      const Triangle& t = triangles[reached[i]];
      if (t[k] != vertex && t[(k + 1) % 3] != vertex)
        continue;
      for (int g : topology.triangles_of_edge(topology.triangle_edges[reached[i]][k]))
        if (std::find(reached.begin(), reached.end(), g) == reached.end())
          reached.push_back(g);
    }
  return reached.size() == around.size();
}

/// The piece, closed up or nearly, encloses a negative volume about its own middle. A flat or open
/// piece (a floor, a patch) encloses too little for its area to tell and is left as it is; a ball
/// has volume / area^1.5 = 0.094.
bool is_inside_out(const TriangleMesh& mesh, const std::vector<int>& piece,
                   const std::vector<signed char>& turn) {
  constexpr double LEAST_BULK = 0.01;
  double area = 0, volume = 0;
  Vec3 middle = Vec3::Zero();
  for (int f : piece) {
    const Triangle& t = mesh.triangles[f];
    const double a =
        0.5 * area_normal(mesh.positions[t[0]], mesh.positions[t[1]], mesh.positions[t[2]]).norm();
    middle += a / 3 * (mesh.positions[t[0]] + mesh.positions[t[1]] + mesh.positions[t[2]]);
    area += a;
  }
  if (!(area > 0))
    return false;
  middle /= area;
  for (int f : piece) {
    const Triangle& t = mesh.triangles[f];
    const Vec3 a = mesh.positions[t[0]] - middle, b = mesh.positions[t[1]] - middle,
               c = mesh.positions[t[2]] - middle;
    volume += turn[f] * a.dot(b.cross(c)) / 6;
  }
  return volume < -LEAST_BULK * std::pow(area, 1.5);
}

} // namespace

void BodyCollider::turn_faces() {
  // Each manifold piece is made to agree with itself, keeping the orientation that most of its area
  // has.
  const auto n = static_cast<int>(m_mesh.triangles.size());
  std::vector<signed char> side(n, 0); // 1 keep, -1 turn, 0 not reached
  for (int seed = 0; seed < n; ++seed) {
    if (side[seed] != 0)
      continue;
    std::vector<int> piece = {seed};
    side[seed] = 1;
    double kept_area = 0, turned_area = 0;
    for (std::size_t i = 0; i < piece.size(); ++i) {
      const int f = piece[i];
      const Triangle& t = m_mesh.triangles[f];
      (side[f] > 0 ? kept_area : turned_area) +=
          area_normal(m_mesh.positions[t[0]], m_mesh.positions[t[1]], m_mesh.positions[t[2]])
              .norm();
      for (int e : m_topology.triangle_edges[f]) {
        const auto pair = m_topology.triangles_of_edge(e);
        if (pair.size() != 2)
          continue;
        const int g = pair[0] == f ? pair[1] : pair[0];
        if (side[g] != 0 || g == f)
          continue;
        const auto& edge = m_topology.edges[e];
        const bool agree = direction_along(t, edge) != direction_along(m_mesh.triangles[g], edge);
        side[g] = static_cast<signed char>(agree ? side[f] : -side[f]);
        piece.push_back(g);
      }
    }
    if (turned_area > kept_area)
      for (int f : piece)
        side[f] = static_cast<signed char>(-side[f]);
    if (is_inside_out(m_mesh, piece, side))
      for (int f : piece)
        side[f] = static_cast<signed char>(-side[f]);
  }
  for (int f = 0; f < n; ++f)
    if (side[f] < 0) {
      m_turned.push_back(f);
      turn(f);
    }
  m_findings.flipped_triangles = static_cast<int>(m_turned.size());
}

void BodyCollider::turn(int f) {
  std::swap(m_mesh.triangles[f][1], m_mesh.triangles[f][2]);
  std::swap(m_topology.triangle_edges[f][0], m_topology.triangle_edges[f][2]);
}

void BodyCollider::assess_sign_reliability() {
  const auto n = static_cast<int>(m_mesh.triangles.size());
  m_trusted_face.assign(n, 1);
  m_trusted_edge.assign(m_topology.edges.size(), 1);
  m_trusted_vertex.assign(m_mesh.positions.size(), 1);

  for (std::size_t e = 0; e < m_topology.edges.size(); ++e) {
    const auto pair = m_topology.triangles_of_edge(static_cast<int>(e));
    const auto& edge = m_topology.edges[e];
    const bool good = pair.size() == 2 && pair[0] != pair[1] &&
                      direction_along(m_mesh.triangles[pair[0]], edge) !=
                          direction_along(m_mesh.triangles[pair[1]], edge);
    if (good)
      continue;
    m_trusted_edge[e] = 0;
    (pair.size() == 1 ? m_findings.boundary_edges : m_findings.non_manifold_edges) += 1;
  }
  // Where the skin passes through itself, the nearer sheet need not be the one that decides.
  const auto crossings = self_intersections(m_mesh.positions, m_mesh.triangles, m_tree);
  m_findings.self_intersections = static_cast<int>(crossings.size());
  for (const auto& [a, b] : crossings)
    m_trusted_face[a] = m_trusted_face[b] = 0;

  const std::vector<char> buried = ask_winding_numbers();
  for (int f = 0; f < n; ++f) {
    if (m_trusted_face[f])
      continue;
    ++m_findings.untrusted_triangles;
    for (int e : m_topology.triangle_edges[f])
      m_trusted_edge[e] = 0;
  }
  for (std::size_t e = 0; e < m_topology.edges.size(); ++e)
    if (!m_trusted_edge[e])
      m_trusted_vertex[m_topology.edges[e][0]] = m_trusted_vertex[m_topology.edges[e][1]] = 0;
  for (std::size_t v = 0; v < m_mesh.positions.size(); ++v)
    if (m_trusted_vertex[v] && !is_single_fan(m_topology, m_mesh.triangles, static_cast<int>(v)))
      m_trusted_vertex[v] = 0;

  m_findings.buried_triangles = static_cast<int>(std::count(buried.begin(), buried.end(), 1));
  if (m_findings.buried_triangles == n)
    m_findings.buried_triangles = 0; // never leave nothing to collide with
  if (m_findings.buried_triangles > 0)
    number_skin(buried);
}

void BodyCollider::number_skin(const std::vector<char>& buried) {
  m_skin_of.assign(m_mesh.triangles.size(), -1);
  for (std::size_t f = 0; f < buried.size(); ++f) {
    if (buried[f])
      continue;
    m_skin_of[f] = static_cast<int>(m_skin_triangle.size());
    m_skin_triangle.push_back(static_cast<int>(f));
  }
}

/// Asks faces whether their front is outside and their back inside, and stops trusting those that
/// say no. Asked are the faces around everything doubtful, some of every piece, and then the
/// neighbours of every face that said no: what lies beyond a ring of faces that say yes is as they
/// are. Returns which faces have the body on both sides.
std::vector<char> BodyCollider::ask_winding_numbers() {
  constexpr int SAMPLES = 16; // of each piece
  enum : char { RIGHT, WRONG, BURIED };
  const auto n = static_cast<int>(m_mesh.triangles.size());
  std::vector<char> asked(n, 0), buried(n, 0), doubtful(m_mesh.positions.size(), 0);
  std::vector<int> front;
  const auto ask = [&](int f) {
    if (!asked[f])
      front.push_back(f);
    asked[f] = 1;
  };
  const auto ask_around = [&](int f) {
    for (int v : m_mesh.triangles[f])
      for (int g : m_topology.triangles_of_vertex(v))
        ask(g);
  };
  for (std::size_t e = 0; e < m_topology.edges.size(); ++e)
    if (!m_trusted_edge[e])
      doubtful[m_topology.edges[e][0]] = doubtful[m_topology.edges[e][1]] = 1;
  for (int f = 0; f < n; ++f)
    if (!m_trusted_face[f])
      for (int v : m_mesh.triangles[f])
        doubtful[v] = 1;
  for (int v = 0; v < std::ssize(doubtful); ++v)
    if (doubtful[v])
      for (int f : m_topology.triangles_of_vertex(v))
        ask(f);
  const std::vector<int> component =
      connected_components(m_mesh.positions.size(), m_mesh.triangles);
  std::vector<int> size(m_mesh.positions.size(), 0), seen(m_mesh.positions.size(), 0);
  for (const Triangle& t : m_mesh.triangles)
    ++size[component[t[0]]];
  for (int f = 0; f < n; ++f) {
    const int c = component[m_mesh.triangles[f][0]];
    if (seen[c]++ % std::max(1, size[c] / SAMPLES) == 0)
      ask(f);
  }

  std::vector<char> answer;
  while (!front.empty()) {
    answer.assign(front.size(), RIGHT);
    parallel_for(front.size(), 64, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) {
        const Triangle& t = m_mesh.triangles[front[i]];
        const Vec3 &a = m_mesh.positions[t[0]], &b = m_mesh.positions[t[1]],
                   &c = m_mesh.positions[t[2]];
        const double side = std::sqrt(area_normal(a, b, c).norm());
        if (!(side > 0))
          continue; // has no sides; its neighbours answer for it
        const Vec3 center = (a + b + c) / 3, offset = 1e-3 * side * m_face_normals[front[i]];
        const bool outer = is_inside(center + offset), inner = is_inside(center - offset);
        if (outer && inner)
          answer[i] = BURIED;
        else
          answer[i] = inner ? RIGHT : WRONG;
      }
    });
    const std::vector<int> answered = std::move(front);
    front.clear();
    for (std::size_t i = 0; i < answered.size(); ++i) {
      const int f = answered[i];
      if (answer[i] == RIGHT)
        continue;
      // a crossing face is buried in part at most: it stays part of the skin
      if (answer[i] == BURIED && m_trusted_face[f])
        buried[f] = 1;
      m_trusted_face[f] = 0;
      ask_around(f);
    }
  }
  return buried;
}

} // namespace sloper::collision
