#include <sloper/collision/self_proximity.hpp>

#include <sloper/collision/chunks.hpp>

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

namespace sloper::collision {

namespace {

constexpr std::size_t PAIR_GRAIN = 8192;
/// Candidates are kept up to this fraction beyond the radius; none beyond it while the cloth moves
/// too fast for that to pay.
constexpr double MARGIN = 0.25;

/// Joins the chunks and sorts by (a, b): counting sort by a, then each short bucket.
template<class Candidate>
void join_sorted(std::size_t n_first, std::vector<Candidate>& out,
                 const std::vector<std::vector<Candidate>>& chunks) {
  std::vector<int> begin(n_first + 1, 0);
  for (const auto& chunk : chunks)
    for (const auto& c : chunk)
      ++begin[static_cast<std::size_t>(c.a) + 1];
  for (std::size_t i = 0; i < n_first; ++i)
    begin[i + 1] += begin[i];
  out.resize(static_cast<std::size_t>(begin[n_first]));
  std::vector<int> next(begin.begin(), begin.end() - 1);
  for (const auto& chunk : chunks)
    for (const auto& c : chunk)
      out[next[c.a]++] = c;
  for (std::size_t i = 0; i < n_first; ++i)
    std::sort(out.begin() + begin[i], out.begin() + begin[i + 1],
              [](const Candidate& c, const Candidate& d) { return c.b < d.b; });
}

/// Keeps of the candidates that may be near enough those that measure(candidate, pair) accepts, in
/// order, on all threads.
template<class Candidate, class Pair, class Measure>
void measure_all(const std::vector<Candidate>& candidates, double reach, std::vector<Pair>& out,
                 const Measure& measure) {
  std::vector<std::vector<Pair>> found((candidates.size() + PAIR_GRAIN - 1) / PAIR_GRAIN);
  parallel_for(candidates.size(), PAIR_GRAIN, [&](std::size_t begin, std::size_t end) {
    Pair pair;
    for (std::size_t i = begin; i < end; ++i)
      if (candidates[i].distance <= reach && measure(candidates[i], pair))
        found[begin / PAIR_GRAIN].push_back(pair);
  });
  out.clear();
  for (const auto& part : found)
    out.insert(out.end(), part.begin(), part.end());
}

/// What overlaps each of `begin` to `end`, things that lie beside each other where their numbers
/// do: a group goes down the tree together, then each asks the lowest nodes that the group came to.
/// @param only_later the things are the tree's own slots, and each is asked only of those from its
/// group on
/// @param dop_of dop_of(i): bounds of i   @param visit visit(i, first slot of a lowest node, lanes
/// that overlap i)
template<class DopOf, class Visit>
void search_groups(const TriangleTree& tree, std::size_t begin, std::size_t end, bool only_later,
                   const DopOf& dop_of, const Visit& visit) {
  constexpr std::size_t GROUP = 8;
  Dop dops[GROUP];
  std::vector<int> nodes;
  for (std::size_t group = begin; group < end; group += GROUP) {
    const std::size_t n = std::min(GROUP, end - group);
    Dop whole;
    std::fill_n(whole.low, MAX_AXES, std::numeric_limits<float>::infinity());
    std::fill_n(whole.high, MAX_AXES, -std::numeric_limits<float>::infinity());
    for (std::size_t i = 0; i < n; ++i) {
      dops[i] = dop_of(group + i);
      for (int a = 0; a < tree.k() / 2; ++a) {
        whole.low[a] = std::min(whole.low[a], dops[i].low[a]);
        whole.high[a] = std::max(whole.high[a], dops[i].high[a]);
      }
    }
    nodes.clear();
    tree.visit_lowest(whole, only_later ? static_cast<int>(group) : 0,
                      [&](int node) { nodes.push_back(node); });
    for (std::size_t i = 0; i < n; ++i)
      for (int node : nodes)
        if (const int lanes = tree.overlapping(node, dops[i]))
          visit(group + i, tree.nodes()[node].first_slot(), lanes);
  }
}

/// Not above the root of x.
float root_below(double x) {
  return static_cast<float>(std::sqrt(x) * (1 - 2e-7));
}

} // namespace

SelfProximity::SelfProximity(std::size_t n_particles, const std::vector<Triangle>& triangles,
                             const std::vector<std::vector<int>>& never_collide, int k)
    : m_triangles(triangles), m_topology(make_topology(n_particles, triangles)),
      m_particles(n_particles) {
  m_k = k;

  std::vector<std::array<int, 2>> listed;
  for (std::size_t a = 0; a < never_collide.size(); ++a)
    for (int b : never_collide[a]) {
      listed.push_back({static_cast<int>(a), b});
      listed.push_back({b, static_cast<int>(a)});
    }
  std::sort(listed.begin(), listed.end());
  listed.erase(std::unique(listed.begin(), listed.end()), listed.end());
  if (listed.empty())
    return;
  m_never_begin.assign(n_particles + 1, 0);
  for (const auto& pair : listed)
    ++m_never_begin[static_cast<std::size_t>(pair[0]) + 1];
  for (std::size_t v = 0; v < n_particles; ++v)
    m_never_begin[v + 1] += m_never_begin[v];
  for (const auto& pair : listed)
    m_never.push_back(pair[1]);
}

bool SelfProximity::never_collide(int a, int b) const {
  const auto first = m_never.begin() + m_never_begin[a],
             last = m_never.begin() + m_never_begin[a + 1];
  return first != last && std::binary_search(first, last, b);
}

bool SelfProximity::candidates_hold(const std::vector<Vec3>& x, double radius) {
  if (m_candidates_x.size() != x.size())
    return false;
  // a pair's distance changes by at most what its ends move against the common drift
  Vec3 drift = Vec3::Zero();
  for (std::size_t v = 0; v < x.size(); ++v)
    drift += x[v] - m_candidates_x[v];
  drift /= std::max<double>(1, static_cast<double>(x.size()));
  double moved2 = 0;
  for (std::size_t v = 0; v < x.size(); ++v) {
    const double d2 = (x[v] - m_candidates_x[v] - drift).squaredNorm();
    if (!(d2 <= moved2))
      moved2 = d2 >= 0 ? d2 : std::numeric_limits<double>::infinity(); // NaN: look again
  }
  m_moved = std::sqrt(moved2) * (1 + 1e-12);
  return radius + 2 * m_moved <= m_candidates_radius;
}

void SelfProximity::search_vertices(std::size_t begin, std::size_t end,
                                    std::vector<Candidate>& found) const {
  const std::vector<Vec3>& x = m_candidates_x;
  const double radius2 = m_candidates_radius * m_candidates_radius;
  search_groups(
      m_tree, begin, end, false,
      [&](std::size_t at) {
        const Vec3& p = x[m_tree_vertices[at]];
        return m_tree.dop_of(
            Box3{p.array() - m_candidates_radius, p.array() + m_candidates_radius});
      },
      [&](std::size_t at, int first_slot, int lanes) {
        const int v = m_tree_vertices[at];
        for (; lanes; lanes &= lanes - 1) {
          const int slot = first_slot + std::countr_zero(static_cast<unsigned>(lanes)),
                    f = m_tree.triangle_of_slot(slot);
          const Triangle& t = m_triangles[f];
          if (v == t[0] || v == t[1] || v == t[2])
            continue;
          const auto& corner = m_tree.corners(slot);
          const double d2 = point_triangle(x[v], corner[0], corner[1], corner[2]).squared_distance;
          if (!(d2 <= radius2))
            continue;
          if (!m_never.empty() &&
              (never_collide(v, t[0]) || never_collide(v, t[1]) || never_collide(v, t[2])))
            continue;
          found.push_back({v, f, root_below(d2)});
        }
      });
}

void SelfProximity::search_edges(std::size_t begin, std::size_t end,
                                 std::vector<Candidate>& found) const {
  const std::vector<Vec3>& x = m_candidates_x;
  const double radius2 = m_candidates_radius * m_candidates_radius;
  const Float4 zero = Float4::all(0), one = Float4::all(1), tiny = Float4::all(1e-30f),
               parallel = Float4::all(1e-5f);
  search_groups(
      m_edge_tree, begin, end, true,
      [&](std::size_t slot) {
        return m_edge_tree.dop_of_slot(static_cast<int>(slot), m_candidates_radius);
      },
      [&](std::size_t at, int first_slot, int lanes) {
        // each pair once: from its lower slot
        const int slot = static_cast<int>(at), behind = slot - first_slot;
        if (behind >= 3)
          return;
        if (behind >= 0)
          lanes &= ~((2 << behind) - 1);
        const FourEdges &of_a = m_four_edges[slot / 4], &b = m_four_edges[first_slot / 4];
        const int k = slot % 4, a0 = of_a.first[k], a1 = of_a.second[k];
        lanes &= ~either_is(b.first, b.second, a0, a1);
        if (!lanes)
          return;
        // Four at a time in float, with slack for rounding and for edges so parallel that float
        // cannot tell where they are nearest (an angle below 3.2e-3); what passes is measured in
        // double.
        const Float4 ux = Float4::all(of_a.d[0][k]), uy = Float4::all(of_a.d[1][k]),
                     uz = Float4::all(of_a.d[2][k]);
        const Float4 vx = Float4::load(b.d[0]), vy = Float4::load(b.d[1]),
                     vz = Float4::load(b.d[2]);
        const Float4 wx = Float4::all(of_a.p[0][k]) - Float4::load(b.p[0]),
                     wy = Float4::all(of_a.p[1][k]) - Float4::load(b.p[1]),
                     wz = Float4::all(of_a.p[2][k]) - Float4::load(b.p[2]);
        const Float4 uu = ux * ux + uy * uy + uz * uz, vv = max(vx * vx + vy * vy + vz * vz, tiny),
                     uv = ux * vx + uy * vy + uz * vz;
        const Float4 uw = ux * wx + uy * wy + uz * wz, vw = vx * wx + vy * wy + vz * wz;
        const Float4 uuvv = uu * vv, det = uuvv - uv * uv;
        Float4 s = where_less((uv * vw - vv * uw) / max(det, tiny), parallel * uuvv, det);
        s = min(max(s, zero), one);
        const Float4 t = min(max((uv * s + vw) / vv, zero), one);
        s = min(max((uv * t - uw) / max(uu, tiny), zero), one);
        const Float4 dx = wx + s * ux - t * vx, dy = wy + s * uy - t * vy,
                     dz = wz + s * uz - t * vz;
        const Float4 within = Float4::all(static_cast<float>(m_candidates_radius) + m_float_slack) +
                              Float4::all(0.004f) * square_root(uu);
        lanes &= less_equal(dx * dx + dy * dy + dz * dz, within * within);
        for (; lanes; lanes &= lanes - 1) {
          const int lane = std::countr_zero(static_cast<unsigned>(lanes)), b0 = b.first[lane],
                    b1 = b.second[lane];
          const double d2 = collision::edge_edge(x[a0], x[a1], x[b0], x[b1]).squared_distance;
          if (!(d2 <= radius2))
            continue;
          if (!m_never.empty() && (never_collide(a0, b0) || never_collide(a0, b1) ||
                                   never_collide(a1, b0) || never_collide(a1, b1)))
            continue;
          const int ea = m_edge_tree.triangle_of_slot(slot),
                    eb = m_edge_tree.triangle_of_slot(first_slot + lane);
          found.push_back({std::min(ea, eb), std::max(ea, eb), root_below(d2)});
        }
      });
}

void SelfProximity::find_candidates(const std::vector<Vec3>& x, double radius) {
  // Looking further ahead pays if, at the pace since the last search, the margin lasts for two more
  // updates.
  const bool slow = m_rebuilds == 0 || 4 * m_moved <= MARGIN * radius * m_updates;
  m_candidates_x = x;
  m_candidates_radius = radius * (slow ? 1 + MARGIN : 1);
  m_moved = 0;
  m_updates = 0;
  ++m_rebuilds;
  if (m_edge_tree.n_slots() == 0) {
    std::vector<Triangle> flat;
    for (const auto& [a, b] : m_topology.edges)
      flat.push_back({a, b, b});
    m_edge_tree = TriangleTree(x, flat, m_k);
    m_four_edges.resize((flat.size() + 3) / 4);
    for (int s = 0; s < m_edge_tree.n_slots(); ++s) {
      const std::array<int, 2>& edge = m_topology.edges[m_edge_tree.triangle_of_slot(s)];
      m_four_edges[s / 4].first[s % 4] = edge[0];
      m_four_edges[s / 4].second[s % 4] = edge[1];
    }
  } else {
    m_edge_tree.refit(x, false);
  }
  double size = 0;
  for (const Vec3& p : x)
    if (p.allFinite())
      size = std::max(size, p.lpNorm<Eigen::Infinity>());
  m_float_slack = static_cast<float>(2e-6 * size);
  parallel_for(m_four_edges.size(), SEARCH_GRAIN, [&](std::size_t begin, std::size_t end) {
    for (std::size_t s = begin; s < end; ++s) {
      FourEdges& edges = m_four_edges[s];
      for (int k = 0; k < 4; ++k)
        for (int i = 0; i < 3; ++i) {
          edges.p[i][k] = static_cast<float>(x[edges.first[k]][i]);
          edges.d[i][k] = static_cast<float>(x[edges.second[k]][i] - x[edges.first[k]][i]);
        }
    }
  });
  std::vector<std::vector<Candidate>> chunks(n_chunks(m_tree_vertices.size()));
  parallel_for(m_tree_vertices.size(), SEARCH_GRAIN, [&](std::size_t begin, std::size_t end) {
    search_vertices(begin, end, chunks[begin / SEARCH_GRAIN]);
  });
  join_sorted(m_particles, m_vertex_face_candidates, chunks);
  chunks.assign(n_chunks(m_topology.edges.size()), {});
  parallel_for(m_topology.edges.size(), SEARCH_GRAIN, [&](std::size_t begin, std::size_t end) {
    search_edges(begin, end, chunks[begin / SEARCH_GRAIN]);
  });
  join_sorted(m_topology.edges.size(), m_edge_edge_candidates, chunks);
}

void SelfProximity::update(const std::vector<Vec3>& x, double radius,
                           const std::vector<std::array<int, 2>>& intersecting) {
  if (m_tree.n_slots() == 0 && !m_triangles.empty()) {
    m_tree = TriangleTree(x, m_triangles, m_k);
    std::vector<char> seen(m_particles, 0);
    for (int f : m_tree.triangle_order())
      for (int v : m_triangles[f]) {
        if (!seen[v])
          m_tree_vertices.push_back(v);
        seen[v] = 1;
      }
  } else {
    m_tree.refit(x, false);
  }
  ++m_updates;
  if (!candidates_hold(x, radius))
    find_candidates(x, radius);
  const double radius2 = radius * radius, reach = (radius + 2 * m_moved) * (1 + 1e-9);
  measure_all(m_vertex_face_candidates, reach, m_vertex_face,
              [&](const Candidate& c, VertexFacePair& pair) {
                const Triangle& t = m_triangles[c.b];
                const PointTriangle d = point_triangle(x[c.a], x[t[0]], x[t[1]], x[t[2]]);
                if (!(d.squared_distance <= radius2))
                  return false;
                pair = {c.a, c.b, std::sqrt(d.squared_distance), d.barycentric, false};
                return true;
              });
  measure_all(m_edge_edge_candidates, reach, m_edge_edge,
              [&](const Candidate& c, EdgeEdgePair& pair) {
                const auto [a0, a1] = m_topology.edges[c.a];
                const auto [b0, b1] = m_topology.edges[c.b];
                const EdgeEdge d = collision::edge_edge(x[a0], x[a1], x[b0], x[b1]);
                if (!(d.squared_distance <= radius2))
                  return false;
                pair = {c.a, c.b, std::sqrt(d.squared_distance), d.s, d.t, false};
                return true;
              });
  if (!intersecting.empty())
    mark_exempt(intersecting);
}

bool SelfProximity::has_vertex_face(const std::array<int, 2>& pair) const {
  const auto at = std::lower_bound(m_vertex_face.begin(), m_vertex_face.end(), pair,
                                   [](const VertexFacePair& p, const std::array<int, 2>& q) {
                                     return std::array<int, 2>{p.vertex, p.triangle} < q;
                                   });
  return at != m_vertex_face.end() && at->vertex == pair[0] && at->triangle == pair[1];
}

bool SelfProximity::has_edge_edge(const std::array<int, 2>& pair) const {
  const auto at = std::lower_bound(m_edge_edge.begin(), m_edge_edge.end(), pair,
                                   [](const EdgeEdgePair& p, const std::array<int, 2>& q) {
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
    return touched[f] && touched[g] &&
           std::binary_search(crossing.begin(), crossing.end(),
                              std::array<int, 2>{std::min(f, g), std::max(f, g)});
  };
  for (VertexFacePair& pair : m_vertex_face) {
    if (!touched[pair.triangle])
      continue;
    for (int f : m_topology.triangles_of_vertex(pair.vertex))
      pair.exempt |= crosses(f, pair.triangle);
  }
  for (EdgeEdgePair& pair : m_edge_edge)
    for (int f : m_topology.triangles_of_edge(pair.edge_a))
      if (touched[f])
        for (int g : m_topology.triangles_of_edge(pair.edge_b))
          pair.exempt |= crosses(f, g);
}

} // namespace sloper::collision
