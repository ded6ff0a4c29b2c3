#include <collision/self_proximity.hpp>

#include <collision/chunks.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace sloper::collision {

namespace {

constexpr std::size_t PAIR_GRAIN = 8192;
/// Candidates are kept up to this fraction beyond the radius; none beyond it while the cloth moves too fast for that to pay.
constexpr double MARGIN = 0.25;

/// Joins the chunks and sorts by (a, b): counting sort by a, then each short bucket.
template<class Candidate> void join_sorted(std::size_t n_first, std::vector<Candidate>& out, const std::vector<std::vector<Candidate>>& chunks) {
  std::vector<int> begin(n_first + 1, 0);
  for (const auto& chunk : chunks)
    for (const auto& c : chunk) ++begin[static_cast<std::size_t>(c.a) + 1];
  for (std::size_t i = 0; i < n_first; ++i) begin[i + 1] += begin[i];
  out.resize(static_cast<std::size_t>(begin[n_first]));
  std::vector<int> next(begin.begin(), begin.end() - 1);
  for (const auto& chunk : chunks)
    for (const auto& c : chunk) out[next[c.a]++] = c;
  for (std::size_t i = 0; i < n_first; ++i)
    std::sort(out.begin() + begin[i], out.begin() + begin[i + 1], [](const Candidate& c, const Candidate& d) { return c.b < d.b; });
}

/// Keeps of the candidates that may be near enough those that measure(candidate, pair) accepts, in order, on all threads.
template<class Candidate, class Pair, class Measure>
void measure_all(const std::vector<Candidate>& candidates, double reach, std::vector<Pair>& out, const Measure& measure) {
  std::vector<std::vector<Pair>> found((candidates.size() + PAIR_GRAIN - 1) / PAIR_GRAIN);
  parallel_for(candidates.size(), PAIR_GRAIN, [&](std::size_t begin, std::size_t end) {
    Pair pair;
    for (std::size_t i = begin; i < end; ++i)
      if (candidates[i].distance <= reach && measure(candidates[i], pair)) found[begin / PAIR_GRAIN].push_back(pair);
  });
  out.clear();
  for (const auto& part : found) out.insert(out.end(), part.begin(), part.end());
}

/// Not above the root of x.
float root_below(double x) { return static_cast<float>(std::sqrt(x) * (1 - 2e-7)); }

} // namespace

SelfProximity::SelfProximity(std::size_t n_particles, const std::vector<Triangle>& triangles, const std::vector<std::vector<int>>& never_collide, int k)
    : m_triangles(triangles), m_topology(make_topology(n_particles, triangles)), m_particles(n_particles) {
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

bool SelfProximity::candidates_hold(const std::vector<Vec3>& x, double radius) {
  if (m_candidates_x.size() != x.size()) return false;
  // a pair's distance changes by at most what its ends move against the common drift
  Vec3 drift = Vec3::Zero();
  for (std::size_t v = 0; v < x.size(); ++v) drift += x[v] - m_candidates_x[v];
  drift /= std::max<double>(1, static_cast<double>(x.size()));
  double moved2 = 0;
  for (std::size_t v = 0; v < x.size(); ++v) {
    const double d2 = (x[v] - m_candidates_x[v] - drift).squaredNorm();
    if (!(d2 <= moved2)) moved2 = d2 >= 0 ? d2 : std::numeric_limits<double>::infinity(); // NaN: look again
  }
  m_moved = std::sqrt(moved2) * (1 + 1e-12);
  return radius + 2 * m_moved <= m_candidates_radius;
}

void SelfProximity::search_vertices(std::size_t begin, std::size_t end, std::vector<Candidate>& found) const {
  const std::vector<Vec3>& x = m_candidates_x;
  const double radius2 = m_candidates_radius * m_candidates_radius;
  for (auto v = static_cast<int>(begin); v < static_cast<int>(end); ++v) {
    if (m_topology.triangles_of_vertex(v).empty()) continue;
    const Box3 box{x[v].array() - m_candidates_radius, x[v].array() + m_candidates_radius};
    const std::size_t first = found.size();
    m_tree.visit_slots(m_tree.dop_of(box), 0, [&](int slot) {
      const int f = m_tree.triangle_of_slot(slot);
      const Triangle& t = m_triangles[f];
      if (v == t[0] || v == t[1] || v == t[2]) return;
      const auto& corner = m_tree.corners(slot);
      const double d2 = point_triangle(x[v], corner[0], corner[1], corner[2]).squared_distance;
      if (d2 <= radius2) found.push_back({v, f, root_below(d2)});
    });
    if (!m_never.empty() && m_never_begin[v] != m_never_begin[v + 1])
      found.erase(std::remove_if(found.begin() + static_cast<long>(first), found.end(),
                                 [&](const Candidate& c) {
                                   const Triangle& t = m_triangles[c.b];
                                   return never_collide(v, t[0]) || never_collide(v, t[1]) || never_collide(v, t[2]);
                                 }),
                  found.end());
  }
}

void SelfProximity::search_edges(std::size_t begin, std::size_t end, std::vector<Candidate>& found) const {
  const std::vector<Vec3>& x = m_candidates_x;
  const double radius2 = m_candidates_radius * m_candidates_radius;
  const Float4 zero = Float4::all(0), one = Float4::all(1), tiny = Float4::all(1e-30f), parallel = Float4::all(1e-5f);
  std::vector<int> near; // slots
  for (auto slot = static_cast<int>(begin); slot < static_cast<int>(end); ++slot) {
    const int ea = m_edge_tree.triangle_of_slot(slot);
    const int a0 = m_topology.edges[ea][0], a1 = m_topology.edges[ea][1]; // clang 14 captures no structured binding
    near.clear();
    m_edge_tree.visit_slots(m_edge_tree.dop_of_slot(slot, m_candidates_radius), slot + 1, [&](int other) {
      const auto& [b0, b1] = m_slot_edges[other];
      if (a0 != b0 && a0 != b1 && a1 != b0 && a1 != b1) near.push_back(other);
    });
    if (near.empty()) continue;
    // Four at a time in float, with slack for rounding and for edges so parallel that float cannot tell where they are
    // nearest (an angle below 3.2e-3); what passes is measured in double.
    const FloatEdge& a = m_float_edges[slot];
    const Float4 ux = Float4::all(a.d[0]), uy = Float4::all(a.d[1]), uz = Float4::all(a.d[2]);
    const Float4 px = Float4::all(a.p[0]), py = Float4::all(a.p[1]), pz = Float4::all(a.p[2]);
    const float length2 = a.d[0] * a.d[0] + a.d[1] * a.d[1] + a.d[2] * a.d[2];
    const Float4 uu = Float4::all(length2), uu_safe = max(uu, tiny);
    const float within = static_cast<float>(m_candidates_radius) + 0.004f * std::sqrt(length2) + m_float_slack;
    const Float4 within2 = Float4::all(within * within);
    const std::size_t n = near.size();
    while (near.size() % 4) near.push_back(near.back());
    for (std::size_t i = 0; i < n; i += 4) {
      const FloatEdge* b[4];
      for (int k = 0; k < 4; ++k) b[k] = &m_float_edges[near[i + k]];
      Float4 qx = Float4::load(b[0]->p), qy = Float4::load(b[1]->p), qz = Float4::load(b[2]->p), q = Float4::load(b[3]->p);
      Float4 vx = Float4::load(b[0]->d), vy = Float4::load(b[1]->d), vz = Float4::load(b[2]->d), v = Float4::load(b[3]->d);
      transpose(qx, qy, qz, q);
      transpose(vx, vy, vz, v);
      const Float4 wx = px - qx, wy = py - qy, wz = pz - qz;
      const Float4 vv = max(vx * vx + vy * vy + vz * vz, tiny), uv = ux * vx + uy * vy + uz * vz;
      const Float4 uw = ux * wx + uy * wy + uz * wz, vw = vx * wx + vy * wy + vz * wz;
      const Float4 uuvv = uu * vv, det = uuvv - uv * uv;
      Float4 s = where_less((uv * vw - vv * uw) / max(det, tiny), parallel * uuvv, det);
      s = min(max(s, zero), one);
      const Float4 t = min(max((uv * s + vw) / vv, zero), one);
      s = min(max((uv * t - uw) / uu_safe, zero), one);
      const Float4 dx = wx + s * ux - t * vx, dy = wy + s * uy - t * vy, dz = wz + s * uz - t * vz;
      int mask = less_equal(dx * dx + dy * dy + dz * dz, within2);
      if (n - i < 4) mask &= (1 << (n - i)) - 1;
      for (int k = 0; k < 4; ++k) {
        if (!(mask & (1 << k))) continue;
        const int eb = m_edge_tree.triangle_of_slot(near[i + k]);
        const auto [b0, b1] = m_topology.edges[eb];
        const double d2 = collision::edge_edge(x[a0], x[a1], x[b0], x[b1]).squared_distance;
        if (!(d2 <= radius2)) continue;
        if (!m_never.empty() && (never_collide(a0, b0) || never_collide(a0, b1) || never_collide(a1, b0) || never_collide(a1, b1))) continue;
        found.push_back({std::min(ea, eb), std::max(ea, eb), root_below(d2)});
      }
    }
  }
}

void SelfProximity::find_candidates(const std::vector<Vec3>& x, double radius) {
  // Looking further ahead pays if, at the pace since the last search, the margin lasts for two more updates.
  const bool slow = m_rebuilds == 0 || 4 * m_moved <= MARGIN * radius * m_updates;
  m_candidates_x = x;
  m_candidates_radius = radius * (slow ? 1 + MARGIN : 1);
  m_moved = 0;
  m_updates = 0;
  ++m_rebuilds;
  if (m_edge_tree.n_slots() == 0) {
    std::vector<Triangle> flat;
    for (const auto& [a, b] : m_topology.edges) flat.push_back({a, b, b});
    m_edge_tree = TriangleTree(x, flat, m_k);
    for (int s = 0; s < m_edge_tree.n_slots(); ++s) m_slot_edges.push_back(m_topology.edges[m_edge_tree.triangle_of_slot(s)]);
    m_float_edges.resize(m_slot_edges.size());
  } else {
    m_edge_tree.refit(x, false);
  }
  double size = 0;
  for (const Vec3& p : x)
    if (p.allFinite()) size = std::max(size, p.lpNorm<Eigen::Infinity>());
  m_float_slack = static_cast<float>(2e-6 * size);
  parallel_for(m_slot_edges.size(), PAIR_GRAIN, [&](std::size_t begin, std::size_t end) {
    for (std::size_t s = begin; s < end; ++s) {
      const Vec3 &p = x[m_slot_edges[s][0]], d = x[m_slot_edges[s][1]] - p;
      for (int i = 0; i < 3; ++i) {
        m_float_edges[s].p[i] = static_cast<float>(p[i]);
        m_float_edges[s].d[i] = static_cast<float>(d[i]);
      }
      m_float_edges[s].p[3] = m_float_edges[s].d[3] = 0;
    }
  });
  std::vector<std::vector<Candidate>> chunks(n_chunks(m_particles));
  parallel_for(m_particles, SEARCH_GRAIN, [&](std::size_t begin, std::size_t end) { search_vertices(begin, end, chunks[begin / SEARCH_GRAIN]); });
  join_sorted(m_particles, m_vertex_face_candidates, chunks);
  chunks.assign(n_chunks(m_slot_edges.size()), {});
  parallel_for(m_slot_edges.size(), SEARCH_GRAIN, [&](std::size_t begin, std::size_t end) { search_edges(begin, end, chunks[begin / SEARCH_GRAIN]); });
  join_sorted(m_topology.edges.size(), m_edge_edge_candidates, chunks);
}

void SelfProximity::update(const std::vector<Vec3>& x, double radius, const std::vector<std::array<int, 2>>& intersecting) {
  if (m_tree.n_slots() == 0 && !m_triangles.empty()) m_tree = TriangleTree(x, m_triangles, m_k);
  else m_tree.refit(x, false);
  ++m_updates;
  if (!candidates_hold(x, radius)) find_candidates(x, radius);
  const double radius2 = radius * radius, reach = (radius + 2 * m_moved) * (1 + 1e-9);
  measure_all(m_vertex_face_candidates, reach, m_vertex_face, [&](const Candidate& c, VertexFacePair& pair) {
    const Triangle& t = m_triangles[c.b];
    const PointTriangle d = point_triangle(x[c.a], x[t[0]], x[t[1]], x[t[2]]);
    if (!(d.squared_distance <= radius2)) return false;
    pair = {c.a, c.b, std::sqrt(d.squared_distance), d.barycentric, false};
    return true;
  });
  measure_all(m_edge_edge_candidates, reach, m_edge_edge, [&](const Candidate& c, EdgeEdgePair& pair) {
    const auto [a0, a1] = m_topology.edges[c.a];
    const auto [b0, b1] = m_topology.edges[c.b];
    const EdgeEdge d = collision::edge_edge(x[a0], x[a1], x[b0], x[b1]);
    if (!(d.squared_distance <= radius2)) return false;
    pair = {c.a, c.b, std::sqrt(d.squared_distance), d.s, d.t, false};
    return true;
  });
  if (!intersecting.empty()) mark_exempt(intersecting);
}

bool SelfProximity::has_vertex_face(const std::array<int, 2>& pair) const {
  const auto at = std::lower_bound(m_vertex_face.begin(), m_vertex_face.end(), pair, [](const VertexFacePair& p, const std::array<int, 2>& q) {
    return std::array<int, 2>{p.vertex, p.triangle} < q;
  });
  return at != m_vertex_face.end() && at->vertex == pair[0] && at->triangle == pair[1];
}

bool SelfProximity::has_edge_edge(const std::array<int, 2>& pair) const {
  const auto at = std::lower_bound(m_edge_edge.begin(), m_edge_edge.end(), pair, [](const EdgeEdgePair& p, const std::array<int, 2>& q) {
    return std::array<int, 2>{p.edge_a, p.edge_b} < q;
  });
  return at != m_edge_edge.end() && at->edge_a == pair[0] && at->edge_b == pair[1];
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

} // namespace sloper::collision
