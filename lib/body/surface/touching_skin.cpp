#include <body/surface/touching_skin.hpp>
#include <sloper/collision/triangle_tree.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <unordered_map>
#include <utility>

namespace sloper::body {

namespace {

constexpr int PARTING_ROUNDS = 6, SMOOTHINGS = 3;
constexpr double OPPOSED = -0.5;  ///< cosine of the two normals
constexpr double DEEPEST = 0.006; ///< m: skin that passes farther into other skin is left alone
constexpr double LARGEST_DISPLACEMENT = 0.003; ///< m
constexpr double LEAST_TURN = 0.5;             ///< cosine of the angle by which a triangle may turn

/// Unit normals of the vertices, weighted by area: all that is asked of them is which way the skin
/// faces.
std::vector<Vec3> rough_normals(const TriangleMesh& skin, const std::vector<Triangle>& triangles) {
  std::vector<Vec3> normals(skin.positions.size(), Vec3::Zero());
  for (const Triangle& t : triangles) {
    const Vec3 n = area_normal(skin.positions[t[0]], skin.positions[t[1]], skin.positions[t[2]]);
    for (const int v : t)
      normals[v] += n;
  }
  for (Vec3& n : normals)
    if (const double length = n.norm(); length > 1e-300)
      n /= length;
  return normals;
}

/// One round of spreading: the displacements of the marked vertices go halfway to the mean of their
/// neighbours'.
void spread(const std::vector<std::array<int, 2>>& edges, const std::vector<char>& mark,
            std::vector<Vec3>& displacement) {
  std::vector<Vec3> sum(displacement.size(), Vec3::Zero());
  std::vector<int> count(displacement.size(), 0);
  for (const auto& [a, b] : edges) {
    sum[a] += displacement[b];
    sum[b] += displacement[a];
    ++count[a];
    ++count[b];
  }
  for (std::size_t v = 0; v < displacement.size(); ++v)
    if (mark[v] && count[v] > 0)
      displacement[v] = 0.5 * displacement[v] + 0.5 * sum[v] / count[v];
}

/// The triangles within so many rings of the marked vertices: `mark` grows with them.
std::vector<Triangle> triangles_around(const TriangleMesh& skin, std::vector<char> mark,
                                       int rings) {
  std::vector<Triangle> around;
  for (int ring = 0; ring <= rings; ++ring) {
    around.clear();
    std::vector<char> next = mark;
    for (const Triangle& t : skin.triangles)
      if (mark[t[0]] || mark[t[1]] || mark[t[2]]) {
        around.push_back(t);
        next[t[0]] = next[t[1]] = next[t[2]] = 1;
      }
    mark = std::move(next);
  }
  return around;
}

/// Vertices with skin that looks the other way somewhere within about a cell: by a grid of the
/// directions that skin faces.
std::vector<char> facing_candidates(const TriangleMesh& skin, const std::vector<char>& may_move) {
  constexpr double POINT_CELL = 0.008; // m
  const std::vector<Vec3> normals = rough_normals(skin, skin.triangles);
  const auto key = [](long x, long y, long z) {
    return ((x + 100000) << 40) + ((y + 100000) << 20) + (z + 100000);
  };
  std::vector<std::pair<long, int>> faced; // cell, six bits: which way its skin faces
  std::unordered_map<long, int> number;    // of a cell in `faced`, while it is not yet sorted
  number.reserve(skin.positions.size() / 4);
  std::vector<int> cell_of(skin.positions.size(), -1);
  for (std::size_t v = 0; v < skin.positions.size(); ++v) {
    if (!may_move[v])
      continue;
    const Vec3 p = skin.positions[v] / POINT_CELL;
    const auto [at, is_new] =
        number.try_emplace(key(std::lround(p.x()), std::lround(p.y()), std::lround(p.z())),
                           static_cast<int>(faced.size()));
    if (is_new)
      faced.emplace_back(at->first, 0);
    cell_of[v] = at->second;
    for (int a = 0; a < 3; ++a) {
      if (normals[v][a] > 0.5)
        faced[at->second].second |= 1 << a;
      if (normals[v][a] < -0.5)
        faced[at->second].second |= 8 << a;
    }
  }
  const std::size_t n = faced.size();
  std::vector<int> order(n), place(n);
  std::iota(order.begin(), order.end(), 0);
  std::sort(order.begin(), order.end(),
            [&](int a, int b) { return faced[a].first < faced[b].first; });
  std::vector<std::pair<long, int>> sorted;
  for (std::size_t i = 0; i < n; ++i) {
    place[order[i]] = static_cast<int>(i);
    sorted.push_back(faced[order[i]]);
  }
  faced = std::move(sorted);
  std::vector<int> around(n, 0); // the same over the neighbour cells
  for (long x = -1; x <= 1; ++x)
    for (long y = -1; y <= 1; ++y)
      for (std::size_t i = 0, from = 0; i < n;
           ++i) { // cells come in order, and so do their neighbours on this side
        const long low = faced[i].first + (x << 40) + (y << 20) - 1;
        while (from < n && faced[from].first < low)
          ++from;
        for (std::size_t at = from; at < n && faced[at].first <= low + 2; ++at)
          around[i] |= faced[at].second;
      }
  std::vector<char> candidate(skin.positions.size(), 0);
  for (std::size_t v = 0; v < skin.positions.size(); ++v) {
    if (!may_move[v])
      continue;
    int against = 0;
    for (int a = 0; a < 3; ++a) {
      if (normals[v][a] > 0.25)
        against |= 8 << a;
      if (normals[v][a] < -0.25)
        against |= 1 << a;
    }
    candidate[v] = (around[place[cell_of[v]]] & against) != 0;
  }
  return candidate;
}

/// Ways that part the skin by what is missing; `wants` marks the vertices that have one.
std::vector<Vec3> wanted_displacements(const TriangleMesh& skin, const std::vector<char>& candidate,
                                       const std::vector<Triangle>& near, double gap_m,
                                       std::vector<char>& wants) {
  const std::vector<Vec3> normals = rough_normals(skin, near);
  const collision::TriangleTree tree(skin.positions, near);
  const double reach = std::max(gap_m, DEEPEST);
  std::vector<Vec3> displacement(skin.positions.size(), Vec3::Zero());
  wants.assign(skin.positions.size(), 0);
  for (std::size_t v = 0; v < skin.positions.size(); ++v) {
    if (!candidate[v])
      continue;
    const Vec3& p = skin.positions[v];
    double least = gap_m;
    tree.visit_overlaps({p.array() - reach, p.array() + reach}, [&](int f) {
      const Triangle& t = near[f];
      const Vec3 &a = skin.positions[t[0]], &b = skin.positions[t[1]], &c = skin.positions[t[2]];
      const Vec3 facing =
          (normals[t[0]] + normals[t[1]] + normals[t[2]])
              .normalized(); // of its vertices: one triangle of a rough skin looks anywhere
      if (!(facing.dot(normals[v]) < OPPOSED))
        return;
      const Vec3 away = p - collision::point_triangle(p, a, b, c).point;
      const double gap = away.dot(facing);
      if (gap >= least || gap < -DEEPEST || (away - gap * facing).norm() > 0.5 * gap_m)
        return;
      least = gap;
      displacement[v] = 0.5 * (gap_m - gap) * facing;
      wants[v] = 1;
    });
  }
  return displacement;
}

/// Evens out displacements around triangles that they turn over or nearly so: where the walls of a
/// slot meet, each vertex would go by itself, and fine skin would lie in folds across the slot.
void unfold(const std::vector<Vec3>& before, const std::vector<Triangle>& triangles,
            const std::vector<std::array<int, 2>>& edges, const std::vector<char>& may_move,
            std::vector<Vec3>& displacement) {
  constexpr int MOST_ROUNDS = 100;
  std::vector<char> folded(displacement.size());
  for (int round = 0; round < MOST_ROUNDS; ++round) {
    std::fill(folded.begin(), folded.end(), 0);
    bool any = false;
    for (std::size_t f = 0; f < triangles.size(); ++f) {
      const auto& [a, b, c] = triangles[f];
      const Vec3 was = area_normal(before[a], before[b], before[c]);
      const Vec3 is = area_normal(before[a] + displacement[a], before[b] + displacement[b],
                                  before[c] + displacement[c]);
      if (is.dot(was) >= LEAST_TURN * is.norm() * was.norm())
        continue;
      for (const int v : {a, b, c})
        folded[v] = may_move[v];
      any = true;
    }
    if (!any)
      return;
    spread(edges, folded, displacement);
  }
}

} // namespace

OpenedSkin open_touching_skin(TriangleMesh& skin, const std::vector<char>& may_move, double gap_m) {
  const std::vector<Vec3> before = skin.positions;
  const std::vector<char> candidate = facing_candidates(skin, may_move);
  if (std::find(candidate.begin(), candidate.end(), 1) == candidate.end())
    return {};
  std::vector<char> wants;
  const std::vector<Triangle> near = triangles_around(skin, candidate, 0);
  std::vector<Triangle> around; // triangles to which a displacement can spread
  std::vector<std::array<int, 2>> edges;
  for (int round = 0; round < PARTING_ROUNDS; ++round) {
    std::vector<Vec3> displacement = wanted_displacements(skin, candidate, near, gap_m, wants);
    if (std::find(wants.begin(), wants.end(), 1) == wants.end())
      break;
    if (edges.empty()) {
      around = triangles_around(skin, candidate, SMOOTHINGS);
      edges = edges_of(around);
    }
    std::vector<char> rim(
        displacement.size()); // takes part; what must move keeps its own displacement
    for (std::size_t v = 0; v < displacement.size(); ++v)
      rim[v] = may_move[v] && !wants[v];
    for (int k = 0; k < SMOOTHINGS; ++k)
      spread(edges, rim, displacement);
    for (std::size_t v = 0; v < displacement.size(); ++v) {
      displacement[v] += skin.positions[v] - before[v];
      const double length = displacement[v].norm();
      if (length > LARGEST_DISPLACEMENT)
        displacement[v] *= LARGEST_DISPLACEMENT / length;
    }
    unfold(before, around, edges, may_move, displacement);
    for (std::size_t v = 0; v < displacement.size(); ++v)
      skin.positions[v] = before[v] + displacement[v];
  }
  OpenedSkin opened;
  for (std::size_t v = 0; v < before.size(); ++v) {
    const double moved = (skin.positions[v] - before[v]).norm();
    opened.vertices += moved > 1e-4;
    if (moved <= opened.largest_m)
      continue;
    opened.largest_m = moved;
    opened.place = skin.positions[v];
  }
  return opened;
}

} // namespace sloper::body
