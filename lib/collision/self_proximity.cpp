#include <collision/self_proximity.hpp>

#include <base/parallel.hpp>

#include <algorithm>
#include <cmath>

namespace sloper::collision {

namespace {

constexpr std::size_t SLOT_GRAIN = 1024, PAIR_GRAIN = 4096;
constexpr double MARGIN = 0.5; ///< candidates are kept up to this fraction beyond the radius

/// Joins the chunks and sorts by (first, second): counting sort by the first index, then each short bucket.
void join_sorted(std::size_t n_first, std::vector<std::array<int, 2>>& out, const std::vector<const std::vector<std::array<int, 2>>*>& chunks) {
  std::vector<int> begin(n_first + 1, 0);
  for (const auto* chunk : chunks)
    for (const auto& pair : *chunk) ++begin[static_cast<std::size_t>(pair[0]) + 1];
  for (std::size_t i = 0; i < n_first; ++i) begin[i + 1] += begin[i];
  out.resize(static_cast<std::size_t>(begin[n_first]));
  std::vector<int> next(begin.begin(), begin.end() - 1);
  for (const auto* chunk : chunks)
    for (const auto& pair : *chunk) out[next[pair[0]]++] = pair;
  for (std::size_t i = 0; i < n_first; ++i) std::sort(out.begin() + begin[i], out.begin() + begin[i + 1]);
}

/// Keeps of the candidates those that measure(candidate, pair) accepts, in order, on all threads.
template<class Pair, class Measure> void measure_all(const std::vector<std::array<int, 2>>& candidates, std::vector<Pair>& out, const Measure& measure) {
  std::vector<std::vector<Pair>> found((candidates.size() + PAIR_GRAIN - 1) / PAIR_GRAIN);
  parallel_for(candidates.size(), PAIR_GRAIN, [&](std::size_t begin, std::size_t end) {
    Pair pair;
    for (std::size_t i = begin; i < end; ++i)
      if (measure(candidates[i], pair)) found[begin / PAIR_GRAIN].push_back(pair);
  });
  out.clear();
  for (const auto& part : found) out.insert(out.end(), part.begin(), part.end());
}

} // namespace

SelfProximity::SelfProximity(std::size_t n_particles, const std::vector<Triangle>& triangles, const std::vector<std::vector<int>>& never_collide, int k)
    : m_triangles(triangles), m_topology(make_topology(n_particles, triangles)), m_particles(n_particles) {
  m_tree = TriangleTree(); // built at the first update: only then is it known where the triangles are
  m_owned.assign(triangles.size(), 0);
  for (std::size_t f = 0; f < triangles.size(); ++f)
    for (int i = 0; i < 3; ++i) {
      // the first triangle owns, at the first corner where it has the vertex or edge (a triangle may repeat an index)
      const int vertex = triangles[f][i], edge = m_topology.triangle_edges[f][i];
      bool repeated_vertex = false, repeated_edge = false;
      for (int j = 0; j < i; ++j) {
        repeated_vertex |= triangles[f][j] == vertex;
        repeated_edge |= m_topology.triangle_edges[f][j] == edge;
      }
      if (!repeated_vertex && m_topology.triangles_of_vertex(vertex)[0] == static_cast<int>(f)) m_owned[f] |= 1 << i;
      if (!repeated_edge && m_topology.triangles_of_edge(edge)[0] == static_cast<int>(f)) m_owned[f] |= 8 << i;
    }
  m_k = k;

  std::vector<std::array<int, 2>> listed;
  for (std::size_t a = 0; a < never_collide.size(); ++a)
    for (int b : never_collide[a]) {
      listed.push_back({static_cast<int>(a), b});
      listed.push_back({b, static_cast<int>(a)});
    }
  std::sort(listed.begin(), listed.end());
  listed.erase(std::unique(listed.begin(), listed.end()), listed.end());
  if (listed.empty()) return;
  m_never_begin.assign(n_particles + 1, 0);
  for (const auto& pair : listed) ++m_never_begin[static_cast<std::size_t>(pair[0]) + 1];
  for (std::size_t v = 0; v < n_particles; ++v) m_never_begin[v + 1] += m_never_begin[v];
  for (const auto& pair : listed) m_never.push_back(pair[1]);
}

bool SelfProximity::never_collide(int a, int b) const {
  const auto first = m_never.begin() + m_never_begin[a], last = m_never.begin() + m_never_begin[a + 1];
  return first != last && std::binary_search(first, last, b);
}

bool SelfProximity::candidates_hold(const std::vector<Vec3>& x, double radius) const {
  if (m_candidates_radius < radius || m_candidates_x.size() != x.size()) return false;
  // a pair's distance changes by at most what its ends move against the common drift
  Vec3 drift = Vec3::Zero();
  for (std::size_t v = 0; v < x.size(); ++v) drift += x[v] - m_candidates_x[v];
  drift /= std::max<double>(1, static_cast<double>(x.size()));
  const double allowed = 0.5 * (m_candidates_radius - radius);
  for (std::size_t v = 0; v < x.size(); ++v)
    if (!((x[v] - m_candidates_x[v] - drift).squaredNorm() <= allowed * allowed)) return false;
  return true;
}

void SelfProximity::search(int slot, double radius, Near& near) const {
  const int f = m_tree.triangle_of_slot(slot);
  const Triangle& a = m_triangles[f];
  const double radius2 = radius * radius;
  const bool any_never = !m_never.empty();
  const std::vector<Vec3>& x = m_candidates_x;
  const auto vertex_face = [&](int v, const Triangle& t, int triangle, const std::array<Vec3, 3>& corners) {
    if (v == t[0] || v == t[1] || v == t[2]) return;
    const Vec3& p = x[v];
    for (int i = 0; i < 3; ++i) {
      const double low = std::min(corners[0][i], std::min(corners[1][i], corners[2][i]));
      const double high = std::max(corners[0][i], std::max(corners[1][i], corners[2][i]));
      if (p[i] < low - radius || p[i] > high + radius) return;
    }
    if (any_never && (never_collide(v, t[0]) || never_collide(v, t[1]) || never_collide(v, t[2]))) return;
    if (!(point_triangle(p, corners[0], corners[1], corners[2]).squared_distance <= radius2)) return;
    near.vertex_face.push_back({v, triangle});
  };
  m_tree.visit_slots(m_tree.dop_of_slot(slot, radius), slot + 1, [&](int other) {
    const int g = m_tree.triangle_of_slot(other);
    const Triangle& b = m_triangles[g];
    const int own_a = m_owned[f], own_b = m_owned[g];
    for (int i = 0; i < 3; ++i) {
      if (own_a & (1 << i)) vertex_face(a[i], b, g, m_tree.corners(other));
      if (own_b & (1 << i)) vertex_face(b[i], a, f, m_tree.corners(slot));
    }
    if (!(own_a & 56) || !(own_b & 56)) return;
    for (int i = 0; i < 3; ++i) {
      if (!(own_a & (8 << i))) continue;
      const int ea = m_topology.triangle_edges[f][i];
      const auto [a0, a1] = m_topology.edges[ea];
      const Float4 low = Float4::load(m_edge_boxes[ea].low), high = Float4::load(m_edge_boxes[ea].high);
      for (int j = 0; j < 3; ++j) {
        if (!(own_b & (8 << j))) continue;
        const int eb = m_topology.triangle_edges[g][j];
        if (both_less_equal(low, Float4::load(m_edge_boxes[eb].high), Float4::load(m_edge_boxes[eb].low), high) != 15) continue;
        const auto [b0, b1] = m_topology.edges[eb];
        if (a0 == b0 || a0 == b1 || a1 == b0 || a1 == b1) continue;
        if (any_never && (never_collide(a0, b0) || never_collide(a0, b1) || never_collide(a1, b0) || never_collide(a1, b1))) continue;
        if (!(collision::edge_edge(x[a0], x[a1], x[b0], x[b1]).squared_distance <= radius2)) continue;
        near.edge_edge.push_back({std::min(ea, eb), std::max(ea, eb)});
      }
    }
  });
}

void SelfProximity::find_candidates(const std::vector<Vec3>& x, double radius) {
  m_candidates_x = x;
  m_candidates_radius = radius * (1 + MARGIN);
  ++m_rebuilds;
  const float grow = static_cast<float>(0.5 * m_candidates_radius);
  m_edge_boxes.resize(m_topology.edges.size());
  parallel_for(m_edge_boxes.size(), PAIR_GRAIN, [&](std::size_t begin, std::size_t end) {
    for (std::size_t e = begin; e < end; ++e) {
      const Vec3 &p = x[m_topology.edges[e][0]], &q = x[m_topology.edges[e][1]];
      FloatBox& box = m_edge_boxes[e];
      for (int i = 0; i < 3; ++i) {
        const auto low = static_cast<float>(std::min(p[i], q[i])), high = static_cast<float>(std::max(p[i], q[i]));
        box.low[i] = low - grow - 3e-7f * (std::abs(low) + grow);
        box.high[i] = high + grow + 3e-7f * (std::abs(high) + grow);
      }
      box.low[3] = box.high[3] = 0;
    }
  });
  const auto n = static_cast<std::size_t>(m_tree.n_slots());
  std::vector<Near> chunks((n + SLOT_GRAIN - 1) / SLOT_GRAIN);
  parallel_for(n, SLOT_GRAIN, [&](std::size_t begin, std::size_t end) {
    for (std::size_t slot = begin; slot < end; ++slot) search(static_cast<int>(slot), m_candidates_radius, chunks[begin / SLOT_GRAIN]);
  });
  std::vector<const std::vector<std::array<int, 2>>*> vertex_face, edge_edge;
  for (const Near& near : chunks) {
    vertex_face.push_back(&near.vertex_face);
    edge_edge.push_back(&near.edge_edge);
  }
  join_sorted(m_particles, m_candidates.vertex_face, vertex_face);
  join_sorted(m_topology.edges.size(), m_candidates.edge_edge, edge_edge);
}

void SelfProximity::update(const std::vector<Vec3>& x, double radius, const std::vector<std::array<int, 2>>& intersecting) {
  m_radius = radius;
  if (m_tree.n_slots() == 0 && !m_triangles.empty()) m_tree = TriangleTree(x, m_triangles, m_k);
  else m_tree.refit(x);
  if (!candidates_hold(x, radius)) find_candidates(x, radius);
  const double radius2 = radius * radius;
  measure_all(m_candidates.vertex_face, m_vertex_face, [&](const std::array<int, 2>& c, VertexFacePair& pair) {
    const Triangle& t = m_triangles[c[1]];
    const PointTriangle d = point_triangle(x[c[0]], x[t[0]], x[t[1]], x[t[2]]);
    if (!(d.squared_distance <= radius2)) return false;
    pair = {c[0], c[1], std::sqrt(d.squared_distance), d.barycentric, false};
    return true;
  });
  measure_all(m_candidates.edge_edge, m_edge_edge, [&](const std::array<int, 2>& c, EdgeEdgePair& pair) {
    const auto [a0, a1] = m_topology.edges[c[0]];
    const auto [b0, b1] = m_topology.edges[c[1]];
    const EdgeEdge d = collision::edge_edge(x[a0], x[a1], x[b0], x[b1]);
    if (!(d.squared_distance <= radius2)) return false;
    pair = {c[0], c[1], std::sqrt(d.squared_distance), d.s, d.t, false};
    return true;
  });
  if (!intersecting.empty()) mark_exempt(intersecting);
}

void SelfProximity::mark_exempt(const std::vector<std::array<int, 2>>& intersecting) {
  std::vector<std::array<int, 2>> crossing;
  std::vector<char> touched(m_triangles.size(), 0);
  for (const auto& [f, g] : intersecting) {
    crossing.push_back({std::min(f, g), std::max(f, g)});
    touched[f] = touched[g] = 1;
  }
  std::sort(crossing.begin(), crossing.end());
  const auto crosses = [&](int f, int g) {
    return touched[f] && touched[g] && std::binary_search(crossing.begin(), crossing.end(), std::array<int, 2>{std::min(f, g), std::max(f, g)});
  };
  for (VertexFacePair& pair : m_vertex_face) {
    if (!touched[pair.triangle]) continue;
    for (int f : m_topology.triangles_of_vertex(pair.vertex)) pair.exempt |= crosses(f, pair.triangle);
  }
  for (EdgeEdgePair& pair : m_edge_edge)
    for (int f : m_topology.triangles_of_edge(pair.edge_a))
      if (touched[f])
        for (int g : m_topology.triangles_of_edge(pair.edge_b)) pair.exempt |= crosses(f, g);
}

std::vector<double> SelfProximity::displacement_bound(double gamma) const {
  std::vector<double> bound(m_particles, m_radius);
  for (const VertexFacePair& pair : m_vertex_face) {
    if (pair.exempt) continue;
    bound[pair.vertex] = std::min(bound[pair.vertex], pair.distance);
    for (int v : m_triangles[pair.triangle]) bound[v] = std::min(bound[v], pair.distance);
  }
  for (const EdgeEdgePair& pair : m_edge_edge) {
    if (pair.exempt) continue;
    for (int e : {pair.edge_a, pair.edge_b})
      for (int v : m_topology.edges[e]) bound[v] = std::min(bound[v], pair.distance);
  }
  for (double& b : bound) b *= gamma;
  return bound;
}

} // namespace sloper::collision
