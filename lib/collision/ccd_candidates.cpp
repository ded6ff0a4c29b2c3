#include <sloper/collision/ccd_candidates.hpp>

#include <sloper/collision/chunks.hpp>

#include <algorithm>

namespace sloper::collision {

namespace {

/// Elements whose boxes stay this far apart do not count, m: more than rounding to float costs.
constexpr float CLEAR = 1e-4f;
/// Of a squared displacement, to stay below it whatever rounding to float does.
constexpr double FLOAT_SHARE = 0.99;

using Pairs = std::vector<std::array<int, 2>>;

/// Bounds of an element's positions and displacements, outward in float.
struct Moving {
  Float4 low[3], high[3], slow[3], fast[3];
};

template<std::size_t N>
Moving bounds_of(const std::array<int, N>& particles, const std::vector<Vec3>& x,
                 const std::vector<Vec3>& dx) {
  Moving m;
  for (int a = 0; a < 3; ++a) {
    double low = x[particles[0]][a], high = low, slow = dx[particles[0]][a], fast = slow;
    for (std::size_t k = 1; k < N; ++k) {
      low = std::min(low, x[particles[k]][a]);
      high = std::max(high, x[particles[k]][a]);
      slow = std::min(slow, dx[particles[k]][a]);
      fast = std::max(fast, dx[particles[k]][a]);
    }
    m.low[a] = Float4::all(static_cast<float>(low) - CLEAR);
    m.high[a] = Float4::all(static_cast<float>(high) + CLEAR);
    m.slow[a] = Float4::all(static_cast<float>(slow));
    m.fast[a] = Float4::all(static_cast<float>(fast));
  }
  return m;
}

/// Of every node, the children below which a slot is listed: bits by lane.
template<class Listed>
void mark_nodes(const TriangleTree& tree, std::vector<std::uint8_t>& lanes, const Listed& listed) {
  lanes.assign(tree.nodes().size(), 0);
  for (std::size_t index = tree.nodes().size(); index-- > 0;) // children come after their parents
    for (int i = 0; i < 4; ++i) {
      const int child = tree.nodes()[index].child[i];
      if (child != TriangleTree::EMPTY && (child >= 0 ? lanes[child] != 0 : listed(-2 - child)))
        lanes[index] |= static_cast<std::uint8_t>(1 << i);
    }
}

/// Calls visit(slot) for every slot >= first that could meet the element if all moved 1 / SHARE
/// times as far, and then against the element by more than `apart`.
/// @param lanes  null, or those children of every node that are looked at
template<class Visit>
void visit_meeting(const TriangleTree& tree, const TriangleTree& motion, const Moving& e, int first,
                   const std::uint8_t* lanes, double apart, Visit&& visit) {
  const Float4 zero = Float4::all(0),
               stretch = Float4::all(static_cast<float>(1 / CcdCandidates::SHARE)),
               apart2 = Float4::all(static_cast<float>(FLOAT_SHARE * apart * apart));
  int stack[128], top = 0;
  stack[top++] = 0;
  while (top > 0) {
    const int index = stack[--top];
    const TriangleTree::Node &node = tree.nodes()[index], &moves = motion.nodes()[index];
    int mask = lanes ? lanes[index] : 15;
    Float4 farthest2 = zero;
    for (int a = 0; a < 3 && mask; ++a) { // the node's displacement relative to the element
      const Float4 back = min(zero, Float4::load(moves.low[a]) - e.fast[a]) * stretch,
                   on = max(zero, Float4::load(moves.high[a]) - e.slow[a]) * stretch;
      mask &= both_less_equal(Float4::load(node.low[a]) + back, e.high[a], e.low[a],
                              Float4::load(node.high[a]) + on);
      const Float4 most = max(on, zero - back);
      farthest2 = farthest2 + most * most;
    }
    mask &= ~less_equal(farthest2, apart2);
    for (int i = 0; i < 4; ++i) {
      if (!(mask & (1 << i)) || node.child[i] == TriangleTree::EMPTY || node.slot_end[i] <= first)
        continue;
      if (node.child[i] >= 0)
        stack[top++] = node.child[i];
      else
        visit(-2 - node.child[i]);
    }
  }
}

/// The farthest that a particle of one element moves against one of the other, squared.
template<std::size_t N, std::size_t M>
double closing2(const std::array<int, N>& a, const std::array<int, M>& b,
                const std::vector<Vec3>& dx) {
  double most = 0;
  for (int i : a)
    for (int j : b)
      most = std::max(most, (dx[i] - dx[j]).squaredNorm());
  return most;
}

/// find(index, found) for 0 .. n - 1 on all threads; what is found, sorted.
template<class Find> void collect(std::size_t n, Pairs& out, const Find& find) {
  std::vector<Pairs> chunks(n_chunks(n));
  parallel_for(n, SEARCH_GRAIN, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i)
      find(static_cast<int>(i), chunks[begin / SEARCH_GRAIN]);
  });
  out.clear();
  for (const Pairs& chunk : chunks)
    out.insert(out.end(), chunk.begin(), chunk.end());
  std::sort(out.begin(), out.end());
}

} // namespace

void CcdCandidates::refit(const std::vector<Vec3>& x, const std::vector<Vec3>& dx, bool again) {
  if (m_faces.n_slots() == 0 && !m_triangles.empty()) {
    m_faces = TriangleTree(x, m_triangles);
    std::vector<Triangle> flat;
    for (const auto& [a, b] : m_topology.edges)
      flat.push_back({a, b, b});
    m_edges = TriangleTree(x, flat);
    m_face_motion = m_faces;
    m_edge_motion = m_edges;
  } else if (!again) {
    m_faces.refit(x, false);
    m_edges.refit(x, false);
  }
  m_face_motion.refit(dx, false);
  m_edge_motion.refit(dx, false);
}

/// Whose pairs are looked for: what is marked or, if that is less, what has changed.
void CcdCandidates::choose(const std::vector<Vec3>& dx, const std::vector<char>& may_meet,
                           bool again) {
  m_chosen = may_meet;
  if (again) {
    std::vector<char> changed(dx.size());
    for (std::size_t i = 0; i < dx.size(); ++i)
      changed[i] = dx[i] != m_last_dx[i];
    if (std::count(changed.begin(), changed.end(), 1) <
        std::count(may_meet.begin(), may_meet.end(), 1))
      m_chosen = std::move(changed);
  }
  m_last_dx = dx;
  mark_nodes(m_faces, m_chosen_faces, [&](int slot) {
    const Triangle& t = m_triangles[m_faces.triangle_of_slot(slot)];
    return m_chosen[t[0]] || m_chosen[t[1]] || m_chosen[t[2]];
  });
  mark_nodes(m_edges, m_chosen_edges, [&](int slot) {
    const std::array<int, 2>& e = m_topology.edges[m_edges.triangle_of_slot(slot)];
    return m_chosen[e[0]] || m_chosen[e[1]];
  });
}

void CcdCandidates::find(const std::vector<Vec3>& x, const std::vector<Vec3>& dx,
                         const std::vector<char>& may_meet, bool again, double apart) {
  m_vertex_face.clear();
  m_edge_edge.clear();
  if (m_triangles.empty())
    return;
  refit(x, dx, again);
  choose(dx, may_meet, again);
  const double share2 = SHARE * SHARE;
  collect(x.size(), m_vertex_face, [&](int v, Pairs& found) {
    if (m_topology.triangles_of_vertex(v).empty() || (!m_chosen[v] && !m_chosen_faces[0]))
      return;
    const std::array<int, 1> own{v};
    visit_meeting(m_faces, m_face_motion, bounds_of(own, x, dx), 0,
                  m_chosen[v] ? nullptr : m_chosen_faces.data(), apart, [&](int slot) {
                    const int f = m_faces.triangle_of_slot(slot);
                    const Triangle& t = m_triangles[f];
                    if (v == t[0] || v == t[1] || v == t[2])
                      return;
                    if (closing2(own, t, dx) >
                        share2 * point_triangle(x[v], x[t[0]], x[t[1]], x[t[2]]).squared_distance)
                      found.push_back({v, f});
                  });
  });
  collect(m_topology.edges.size(), m_edge_edge, [&](int slot, Pairs& found) {
    const int e = m_edges.triangle_of_slot(slot);
    const std::array<int, 2>& a = m_topology.edges[e];
    const bool chosen = m_chosen[a[0]] || m_chosen[a[1]];
    if (!chosen && !m_chosen_edges[0])
      return;
    visit_meeting(
        m_edges, m_edge_motion, bounds_of(a, x, dx), slot + 1,
        chosen ? nullptr : m_chosen_edges.data(), apart, [&](int other) {
          const int f = m_edges.triangle_of_slot(other);
          const std::array<int, 2>& b = m_topology.edges[f];
          if (a[0] == b[0] || a[0] == b[1] || a[1] == b[0] || a[1] == b[1])
            return;
          if (closing2(a, b, dx) >
              share2 * collision::edge_edge(x[a[0]], x[a[1]], x[b[0]], x[b[1]]).squared_distance)
            found.push_back({std::min(e, f), std::max(e, f)});
        });
  });
}

} // namespace sloper::collision
