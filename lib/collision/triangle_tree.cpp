#include <sloper/collision/triangle_tree.hpp>

#include <sloper/base/error.hpp>
#include <sloper/base/parallel.hpp>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace sloper::collision {

// 14 adds the corner directions to the box, 18 the edge directions, 26 both: so the list is cut and
// spliced by k.
const std::array<Vec3, MAX_AXES> DOP_DIRECTIONS = {
    Vec3(1, 0, 0),  Vec3(0, 1, 0),  Vec3(0, 0, 1), Vec3(1, 1, 1), Vec3(1, 1, -1),
    Vec3(1, -1, 1), Vec3(-1, 1, 1), Vec3(1, 1, 0), Vec3(1, 0, 1), Vec3(0, 1, 1),
    Vec3(1, -1, 0), Vec3(1, 0, -1), Vec3(0, 1, -1)};

namespace {

constexpr float HUGE_FLOAT = std::numeric_limits<float>::max();
constexpr int SUBTREE_SLOTS = 4096; ///< a subtree of this size is one task of the parallel refit

/// A float not above (below) x: rounding moves x by at most half a unit in the last place, 1.2e-7
/// |x| undoes that.
float float_below(double x) {
  const auto f = static_cast<float>(x);
  return f - (std::abs(f) * 1.2e-7f + 1e-37f);
}
float float_above(double x) {
  const auto f = static_cast<float>(x);
  return f + (std::abs(f) * 1.2e-7f + 1e-37f);
}

/// Which of DOP_DIRECTIONS is axis `a` of a tree with `axes` axes: 18-DOPs skip the corner
/// directions.
int direction_index(int a, int axes) {
  return axes == 9 && a >= 3 ? a + 4 : a;
}

void interval(const std::array<Vec3, 3>& corners, int axis, int axes, double& low, double& high) {
  double d[3];
  for (int k = 0; k < 3; ++k)
    d[k] =
        axis < 3 ? corners[k][axis] : DOP_DIRECTIONS[direction_index(axis, axes)].dot(corners[k]);
  low = std::min(d[0], std::min(d[1], d[2]));
  high = std::max(d[0], std::max(d[1], d[2]));
}

/// Where slots are cut: at multiples of four, so that the lowest nodes are full.
int middle_of(int from, int to) {
  return from + ((to - from) / 2 + 3) / 4 * 4;
}

/// The borders of a node's children, halves of halves; of more than four slots.
std::array<int, 5> quarters(int begin, int end) {
  const int middle = middle_of(begin, end);
  return {begin, middle - begin > 4 ? middle_of(begin, middle) : middle, middle,
          end - middle > 4 ? middle_of(middle, end) : end, end};
}

/// Puts the slots of a subtree in order: each cut goes along the widest side of the centres.
void sort_slots(std::vector<int>& order, const std::vector<Vec3>& centers, int begin, int end) {
  if (end - begin <= 4)
    return;
  const auto cut = [&](int from, int middle, int to) {
    Box3 box;
    for (int i = from; i < to; ++i)
      box.add(centers[order[i]]);
    int axis;
    box.size().maxCoeff(&axis);
    std::nth_element(order.begin() + from, order.begin() + middle, order.begin() + to,
                     [&](int a, int b) {
                       const double ca = centers[a][axis], cb = centers[b][axis];
                       return ca < cb || (ca == cb && a < b);
                     });
  };
  const std::array<int, 5> border = quarters(begin, end);
  cut(begin, border[2], end);
  if (border[1] < border[2])
    cut(begin, border[1], border[2]);
  if (border[3] < end)
    cut(border[2], border[3], end);
  for (int i = 0; i < 4; ++i)
    sort_slots(order, centers, border[i], border[i + 1]);
}

std::vector<int> sorted_triangles(const std::vector<Vec3>& positions,
                                  const std::vector<Triangle>& triangles) {
  const auto n = static_cast<int>(triangles.size());
  std::vector<int> order(n);
  std::iota(order.begin(), order.end(), 0);
  std::vector<Vec3> centers(n);
  for (int f = 0; f < n; ++f) {
    const Vec3 &a = positions[triangles[f][0]], &b = positions[triangles[f][1]],
               &c = positions[triangles[f][2]];
    // the middle of the box, which median splits separate better than the centroid of a sliver
    centers[f] = 0.5 * (a.cwiseMin(b).cwiseMin(c) + a.cwiseMax(b).cwiseMax(c));
    for (int i = 0; i < 3; ++i)
      if (!std::isfinite(centers[f][i]))
        centers[f][i] = 0; // an ordering must not meet NaN
  }
  sort_slots(order, centers, 0, n);
  return order;
}

} // namespace

TriangleTree::TriangleTree(const std::vector<Vec3>& positions,
                           const std::vector<Triangle>& triangles, int k)
    : TriangleTree(positions, triangles, k, sorted_triangles(positions, triangles)) {}

TriangleTree::TriangleTree(const std::vector<Vec3>& positions,
                           const std::vector<Triangle>& triangles, int k, std::vector<int> order)
    : m_axes(k / 2), m_triangle_of_slot(std::move(order)) {
  if (k != 6 && k != 14 && k != 18 && k != 26)
    throw Error(ErrorKind::INTERNAL, "general.internal"_id, {}, {},
                "a k-DOP tree has k = 6, 14, 18 or 26");
  const auto n = static_cast<int>(triangles.size());
  if (n != n_slots())
    throw Error(ErrorKind::INTERNAL, "general.internal"_id, {}, {},
                "a tree's order has as many triangles as the mesh");
  m_nodes.reserve(n / 2 + 1);
  if (n > 0)
    build(0, n);
  m_slot_of_triangle.resize(n);
  m_slot_vertices.resize(n);
  for (int s = 0; s < n; ++s) {
    m_slot_of_triangle[m_triangle_of_slot[s]] = s;
    m_slot_vertices[s] = triangles[m_triangle_of_slot[s]];
  }
  m_corners.resize(n);
  m_extra.resize(m_nodes.size() * (m_axes - 3));
  m_leaves_of_node.assign(m_nodes.size(), -1);
  for (std::size_t node = 0; node < m_nodes.size(); ++node) {
    if (!m_nodes[node].is_lowest())
      continue;
    m_leaves_of_node[node] = static_cast<int>(m_leaves.size());
    m_leaves.emplace_back();
  }

  // subtrees that refit on their own, and the nodes above them
  if (n > 0) {
    std::vector<std::array<int, 2>> stack = {{0, static_cast<int>(m_nodes.size())}};
    while (!stack.empty()) {
      const auto [node, end] = stack.back();
      stack.pop_back();
      const int first = [&](int at) { // leftmost slot
        while (m_nodes[at].child[0] >= 0)
          at = m_nodes[at].child[0];
        return -2 - m_nodes[at].child[0];
      }(node);
      const int last = *std::max_element(m_nodes[node].slot_end, m_nodes[node].slot_end + 4);
      if (last - first <= SUBTREE_SLOTS) {
        m_subtrees.push_back({node, end});
        continue;
      }
      m_top_nodes.push_back(node);
      int stop = end;
      for (int i = 3; i >= 0; --i) {
        if (m_nodes[node].child[i] < 0)
          continue;
        stack.push_back({m_nodes[node].child[i], stop});
        stop = m_nodes[node].child[i];
      }
    }
    std::sort(m_top_nodes.begin(), m_top_nodes.end());
  }
  refit(positions);
}

int TriangleTree::build(int begin, int end) {
  const auto index = static_cast<int>(m_nodes.size());
  m_nodes.emplace_back();
  std::fill_n(m_nodes[index].child, 4, EMPTY);
  std::fill_n(m_nodes[index].slot_end, 4, begin);
  if (end - begin <= 4) {
    for (int i = 0; begin + i < end; ++i) {
      m_nodes[index].child[i] = -2 - (begin + i);
      m_nodes[index].slot_end[i] = begin + i + 1;
    }
    return index;
  }
  const std::array<int, 5> border = quarters(begin, end);
  int lane = 0;
  for (int i = 0; i < 4; ++i) {
    const int from = border[i], to = border[i + 1];
    if (from >= to)
      continue;
    const int child = build(from, to); // which moves m_nodes
    m_nodes[index].child[lane] = child;
    m_nodes[index].slot_end[lane] = to;
    ++lane;
  }
  return index;
}

void TriangleTree::refit_node(int index) {
  Node& node = m_nodes[index];
  std::array<float, 8>* extra = m_extra.data() + static_cast<std::size_t>(index) * (m_axes - 3);
  for (int i = 0; i < 4; ++i) {
    const int child = node.child[i];
    for (int a = 0; a < m_axes; ++a) {
      float low = HUGE_FLOAT, high = -HUGE_FLOAT;
      if (child <= -2) {
        double l, h;
        interval(m_corners[-2 - child], a, m_axes, l, h);
        low = float_below(l);
        high = float_above(h);
      } else if (child >= 0) {
        const float* lows =
            a < 3 ? m_nodes[child].low[a]
                  : m_extra[static_cast<std::size_t>(child) * (m_axes - 3) + a - 3].data();
        const float* highs = a < 3 ? m_nodes[child].high[a] : lows + 4;
        for (int j = 0; j < 4; ++j) {
          low = std::min(low, lows[j]);
          high = std::max(high, highs[j]);
        }
      }
      (a < 3 ? node.low[a] : extra[a - 3].data())[i] = low;
      (a < 3 ? node.high[a] : extra[a - 3].data() + 4)[i] = high;
    }
  }
}

void TriangleTree::refit(const std::vector<Vec3>& positions, bool for_points) {
  parallel_for(m_corners.size(), SUBTREE_SLOTS, [&](std::size_t begin, std::size_t end) {
    for (std::size_t s = begin; s < end; ++s)
      for (int k = 0; k < 3; ++k)
        m_corners[s][k] = positions[m_slot_vertices[s][k]];
  });
  parallel_for(m_subtrees.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t s = begin; s < end; ++s)
      for (int node = m_subtrees[s][1] - 1; node >= m_subtrees[s][0]; --node)
        refit_node(node);
  });
  for (auto node = m_top_nodes.rbegin(); node != m_top_nodes.rend(); ++node)
    refit_node(*node);
  m_leaves_hold = for_points;
  if (for_points)
    fill_leaves();
}

void TriangleTree::fill_leaves() {
  constexpr std::size_t GRAIN = 8192;
  std::vector<double> longest2((m_nodes.size() + GRAIN - 1) / GRAIN, 0), farthest(longest2);
  parallel_for(m_nodes.size(), GRAIN, [&](std::size_t begin, std::size_t end) {
    double side2 = 0, far = 0;
    for (std::size_t node = begin; node < end; ++node) {
      if (m_leaves_of_node[node] < 0)
        continue;
      Leaves& leaves = m_leaves[m_leaves_of_node[node]];
      for (int i = 0; i < 4; ++i) {
        const int child =
            m_nodes[node].child[i] == EMPTY ? m_nodes[node].child[0] : m_nodes[node].child[i];
        const auto& c = m_corners[-2 - child];
        const Vec3 ab = c[1] - c[0], ac = c[2] - c[0];
        for (int k = 0; k < 3; ++k) {
          leaves.a[k][i] = static_cast<float>(c[0][k]);
          leaves.ab[k][i] = static_cast<float>(ab[k]);
          leaves.ac[k][i] = static_cast<float>(ac[k]);
        }
        side2 = std::max(side2, std::max(ab.squaredNorm(), ac.squaredNorm()));
        far = std::max(far, c[0].lpNorm<Eigen::Infinity>());
      }
    }
    longest2[begin / GRAIN] = side2;
    farthest[begin / GRAIN] = far;
  });
  double side2 = 0, far = 0;
  for (double x : longest2)
    side2 = std::max(side2, x);
  for (double x : farthest)
    far = std::max(far, x);
  m_leaf_slack = static_cast<float>(2e-5 * std::sqrt(side2) + 4e-7 * far);
}

/// Point to four triangles in float; too small where float cannot tell (flat triangles, projections
/// near an edge), never above the true distance by more than 1e-4 of it plus m_leaf_slack.
Float4 TriangleTree::squared_distances(const Leaves& leaves, const Float4 (&p)[3]) {
  const Float4 zero = Float4::all(0), one = Float4::all(1), tiny = Float4::all(1e-30f),
               rounding = Float4::all(2e-6f);
  Float4 ab[3], ac[3], ap[3];
  for (int k = 0; k < 3; ++k) {
    ab[k] = Float4::load(leaves.ab[k]);
    ac[k] = Float4::load(leaves.ac[k]);
    ap[k] = p[k] - Float4::load(leaves.a[k]);
  }
  const auto dot = [](const Float4* u, const Float4* v) {
    return u[0] * v[0] + u[1] * v[1] + u[2] * v[2];
  };
  const Float4 bb = dot(ab, ab), bc = dot(ab, ac), cc = dot(ac, ac), pb = dot(ap, ab),
               pc = dot(ap, ac);
  const auto to_edge = [&](const Float4* from, const Float4* edge, Float4 along, Float4 length2) {
    const Float4 t = min(max(along / max(length2, tiny), zero), one);
    const Float4 x = from[0] - t * edge[0], y = from[1] - t * edge[1], z = from[2] - t * edge[2];
    return x * x + y * y + z * z;
  };
  Float4 edge[3], from_b[3];
  for (int k = 0; k < 3; ++k) {
    edge[k] = ac[k] - ab[k];
    from_b[k] = ap[k] - ab[k];
  }
  const Float4 to_sides = min(min(to_edge(ap, ab, pb, bb), to_edge(ap, ac, pc, cc)),
                              to_edge(from_b, edge, dot(from_b, edge), dot(edge, edge)));
  const Float4 n[3] = {ab[1] * ac[2] - ab[2] * ac[1], ab[2] * ac[0] - ab[0] * ac[2],
                       ab[0] * ac[1] - ab[1] * ac[0]};
  const Float4 nn = dot(n, n), height = dot(n, ap), bbcc = bb * cc;
  const Float4 above = where_less(height * height / max(nn, tiny), Float4::all(1e-4f) * bbcc,
                                  nn); // 0 where nearly flat
  // weights of b and c times nn, and what rounding may have done to them
  const Float4 v1 = cc * pb, v2 = bc * pc, w1 = bb * pc, w2 = bc * pb, v = v1 - v2, w = w1 - w2;
  const Float4 loose_v = rounding * (absolute(v1) + absolute(v2)),
               loose_w = rounding * (absolute(w1) + absolute(w2));
  const Float4 least = min(min(v + loose_v, w + loose_w),
                           bbcc - bc * bc - v - w + loose_v + loose_w + rounding * bbcc);
  // inside: the height; outside: the sides
  return min(to_sides, above + where_less(to_sides, least, zero));
}

Dop TriangleTree::dop_of(const Box3& box) const {
  Dop dop;
  for (int a = 0; a < m_axes; ++a) {
    const Vec3& d = DOP_DIRECTIONS[direction_index(a, m_axes)];
    double low = 0, high = 0;
    for (int i = 0; i < 3; ++i) {
      if (d[i] == 0)
        continue;
      low += d[i] > 0 ? box.low[i] : -box.high[i];
      high += d[i] > 0 ? box.high[i] : -box.low[i];
    }
    dop.low[a] = float_below(low);
    dop.high[a] = float_above(high);
  }
  return dop;
}

Dop TriangleTree::dop_of_slot(int slot, double margin) const {
  Dop dop;
  for (int a = 0; a < m_axes; ++a) {
    double low, high;
    interval(m_corners[slot], a, m_axes, low, high);
    // the set of points within `margin` reaches margin |d| further along d
    const double reach =
        a < 3 ? margin : margin * DOP_DIRECTIONS[direction_index(a, m_axes)].norm();
    dop.low[a] = float_below(low - reach);
    dop.high[a] = float_above(high + reach);
  }
  return dop;
}

double TriangleTree::first_hit(const Vec3& a, const Vec3& b) const {
  double least = std::numeric_limits<double>::infinity();
  const Vec3 direction = b - a;
  visit_slots(dop_of(bounding_box({a, b})), 0, [&](int slot) {
    const std::array<Vec3, 3>& p = m_corners[slot];
    const Vec3 e1 = p[1] - p[0], e2 = p[2] - p[0],
               h = direction.cross(e2); // Moeller and Trumbore 1997
    const double det = e1.dot(h);
    if (std::abs(det) < 1e-18)
      return;
    const Vec3 s = a - p[0];
    const double u = s.dot(h) / det;
    if (u < 0 || u > 1)
      return;
    const Vec3 q = s.cross(e1);
    const double v = direction.dot(q) / det, at = e2.dot(q) / det;
    if (v < 0 || u + v > 1 || at < 0 || at > 1)
      return;
    least = std::min(least, at);
  });
  return least;
}

ClosestPoint TriangleTree::closest_point(const Vec3& p, double max_distance,
                                         int hint_triangle) const {
  ClosestPoint best;
  double bound = max_distance * max_distance;
  const auto try_slot = [&](int slot) {
    const std::array<Vec3, 3>& c = m_corners[slot];
    const PointTriangle q = point_triangle(p, c[0], c[1], c[2]);
    const int triangle = m_triangle_of_slot[slot];
    if (!(q.squared_distance < bound ||
          (q.squared_distance == bound && (best.triangle < 0 || triangle < best.triangle))))
      return;
    bound = q.squared_distance;
    best = {triangle, q.point, q.barycentric, q.squared_distance, q.feature};
  };
  if (m_nodes.empty() || !p.allFinite())
    return best;
  if (hint_triangle >= 0 && hint_triangle < n_slots())
    try_slot(m_slot_of_triangle[hint_triangle]);

  // lower bounds in float: rounding of p and of the differences is covered by the slack
  const auto px = static_cast<float>(p.x()), py = static_cast<float>(p.y()),
             pz = static_cast<float>(p.z());
  const Float4 point[3] = {Float4::all(px), Float4::all(py), Float4::all(pz)},
               zero = Float4::all(0);
  const float size = std::max(std::abs(px), std::max(std::abs(py), std::abs(pz)));
  const Float4 slack = Float4::all(2.5e-7f * size);
  const float leaf_slack = m_leaf_slack + 4e-7f * size;
  float near = 0,
        near_leaf = 0; // squared float distances up to which a box, a triangle, must be looked at
  const auto set_near = [&] {
    near = static_cast<float>(bound * (1 + 2e-6));
    const float root = static_cast<float>(std::sqrt(bound)) * (1 + 1e-4f) + leaf_slack;
    near_leaf = root * root;
  };
  set_near();
  struct Entry {
    float squared;
    int node;
  };
  Entry stack[128];
  int top = 0;
  stack[top++] = {0, 0};
  alignas(16) float squared[4];
  while (top > 0) {
    const Entry entry = stack[--top];
    if (entry.squared > near)
      continue;
    const Node& node = m_nodes[entry.node];
    if (m_leaves_hold && m_leaves_of_node[entry.node] >= 0) {
      int mask = less_equal(squared_distances(m_leaves[m_leaves_of_node[entry.node]], point),
                            Float4::all(near_leaf));
      const double before = bound;
      while (mask) {
        const int i = std::countr_zero(static_cast<unsigned>(mask));
        mask &= mask - 1;
        if (node.child[i] != EMPTY)
          try_slot(-2 - node.child[i]);
      }
      if (bound != before)
        set_near();
      continue;
    }
    Float4 sum = zero;
    for (int k = 0; k < 3; ++k) {
      const Float4 d = max(
          max(Float4::load(node.low[k]) - point[k], point[k] - Float4::load(node.high[k])) - slack,
          zero);
      sum = sum + d * d;
    }
    sum.store(squared);
    const int first = top;
    for (int i = 0; i < 4; ++i) {
      const int child = node.child[i];
      if (child == EMPTY || !(squared[i] <= near))
        continue;
      if (child <= -2) {
        const double before = bound;
        try_slot(-2 - child);
        if (bound != before)
          set_near();
        continue;
      }
      int at = top++; // nearest on top
      for (; at > first && stack[at - 1].squared < squared[i]; --at)
        stack[at] = stack[at - 1];
      stack[at] = {squared[i], child};
    }
  }
  return best;
}

} // namespace sloper::collision
