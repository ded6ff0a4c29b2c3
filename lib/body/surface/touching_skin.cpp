#include <body/surface/touching_skin.hpp>
#include <sloper/collision/triangle_tree.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <numeric>
#include <optional>
#include <span>
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

/// For each vertex a list of numbers, one list after the other.
class VertexLists {
public:
  /// @param n vertices
  /// @param each calls its argument with (vertex, number) for all entries, twice in the same order
  template<class Each> VertexLists(std::size_t n, const Each& each) : m_first(n + 1, 0) {
    each([&](int v, int) { ++m_first[v + 1]; });
    std::partial_sum(m_first.begin(), m_first.end(), m_first.begin());
    m_numbers.resize(static_cast<std::size_t>(m_first.back()));
    std::vector<int> at(m_first.begin(), m_first.end() - 1);
    each([&](int v, int number) { m_numbers[at[v]++] = number; });
  }
  std::span<const int> of(int v) const {
    return std::span(m_numbers).subspan(m_first[v], m_first[v + 1] - m_first[v]);
  }

private:
  std::vector<int> m_first, m_numbers;
};

void sort_unique(std::vector<int>& numbers) {
  std::sort(numbers.begin(), numbers.end());
  numbers.erase(std::unique(numbers.begin(), numbers.end()), numbers.end());
}

VertexLists neighbours_in(const TriangleMesh& skin) {
  const std::vector<std::array<int, 2>> edges = edges_of(skin.triangles);
  return {skin.positions.size(), [&](const auto& add) {
            for (const auto& [a, b] : edges) {
              add(a, b);
              add(b, a);
            }
          }};
}

VertexLists triangles_at(const TriangleMesh& skin) {
  return {skin.positions.size(), [&](const auto& add) {
            for (std::size_t f = 0; f < skin.triangles.size(); ++f)
              for (const int v : skin.triangles[f])
                add(v, static_cast<int>(f));
          }};
}

/// One round of spreading: the displacements of the marked vertices go halfway to the mean of their
/// neighbours'.
void spread(const VertexLists& neighbours, const std::vector<int>& marked,
            std::vector<Vec3>& displacement) {
  std::vector<Vec3> evened;
  evened.reserve(marked.size());
  for (const int v : marked) {
    Vec3 sum = Vec3::Zero();
    for (const int w : neighbours.of(v))
      sum += displacement[w];
    const std::size_t count = neighbours.of(v).size();
    evened.push_back(count > 0 ? Vec3(0.5 * displacement[v] + 0.5 * sum / count) : displacement[v]);
  }
  for (std::size_t i = 0; i < marked.size(); ++i)
    displacement[marked[i]] = evened[i];
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

/// The skin that a displacement can reach, with numbers of its own: whole skins are far larger.
struct Patch {
  TriangleMesh skin;                     ///< its triangles, in the order of the whole skin
  std::vector<int> vertex;               ///< number in the whole skin, ascending
  std::vector<char> candidate, may_move; ///< of its vertices
  std::vector<Triangle> near;            ///< triangles with a candidate
};

Patch patch_around(const TriangleMesh& skin, const std::vector<char>& candidate,
                   const std::vector<char>& may_move) {
  Patch patch;
  patch.skin.triangles = triangles_around(skin, candidate, SMOOTHINGS);
  std::vector<int> number(skin.positions.size(), -1);
  for (const Triangle& t : patch.skin.triangles)
    for (const int v : t)
      number[v] = 0;
  for (std::size_t v = 0; v < number.size(); ++v) {
    if (number[v] < 0)
      continue;
    number[v] = static_cast<int>(patch.vertex.size());
    patch.vertex.push_back(static_cast<int>(v));
    patch.skin.positions.push_back(skin.positions[v]);
    patch.candidate.push_back(candidate[v]);
    patch.may_move.push_back(may_move[v]);
  }
  for (Triangle& t : patch.skin.triangles) {
    for (int& v : t)
      v = number[v];
    if (patch.candidate[t[0]] || patch.candidate[t[1]] || patch.candidate[t[2]])
      patch.near.push_back(t);
  }
  return patch;
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
/// slot meet, each vertex would go by itself, and fine skin would lie in folds across the slot. A
/// round looks again only at triangles that the last one moved.
void unfold(const std::vector<Vec3>& before, const Patch& patch, const VertexLists& neighbours,
            const VertexLists& triangles, std::vector<Vec3>& displacement) {
  constexpr int MOST_ROUNDS = 100;
  const std::vector<Triangle>& all = patch.skin.triangles;
  auto is_folded = [&](int f) {
    const auto& [a, b, c] = all[f];
    const Vec3 was = area_normal(before[a], before[b], before[c]);
    const Vec3 is = area_normal(before[a] + displacement[a], before[b] + displacement[b],
                                before[c] + displacement[c]);
    return !(is.dot(was) >= LEAST_TURN * is.norm() * was.norm());
  };
  std::vector<char> folded(all.size());
  std::vector<int> changed(all.size());
  std::iota(changed.begin(), changed.end(), 0);
  for (int round = 0; round < MOST_ROUNDS; ++round) {
    for (const int f : changed)
      folded[f] = is_folded(f);
    std::vector<int> marked;
    for (std::size_t f = 0; f < all.size(); ++f)
      if (folded[f])
        std::copy_if(all[f].begin(), all[f].end(), std::back_inserter(marked),
                     [&](int v) { return patch.may_move[v]; });
    if (marked.empty())
      return;
    sort_unique(marked);
    spread(neighbours, marked, displacement);
    changed.clear();
    for (const int v : marked)
      changed.insert(changed.end(), triangles.of(v).begin(), triangles.of(v).end());
    sort_unique(changed);
  }
}

} // namespace

OpenedSkin open_touching_skin(TriangleMesh& whole, const std::vector<char>& may_move,
                              double gap_m) {
  const std::vector<char> candidate = facing_candidates(whole, may_move);
  if (std::find(candidate.begin(), candidate.end(), 1) == candidate.end())
    return {};
  Patch patch = patch_around(whole, candidate, may_move);
  TriangleMesh& skin = patch.skin;
  const std::vector<Vec3> before = skin.positions;
  std::vector<char> wants;
  std::optional<VertexLists> neighbours, triangles;
  for (int round = 0; round < PARTING_ROUNDS; ++round) {
    std::vector<Vec3> displacement =
        wanted_displacements(skin, patch.candidate, patch.near, gap_m, wants);
    if (std::find(wants.begin(), wants.end(), 1) == wants.end())
      break;
    if (!neighbours) {
      neighbours.emplace(neighbours_in(skin));
      triangles.emplace(triangles_at(skin));
    }
    std::vector<int> rim; // takes part; what must move keeps its own displacement
    for (std::size_t v = 0; v < displacement.size(); ++v)
      if (patch.may_move[v] && !wants[v])
        rim.push_back(static_cast<int>(v));
    for (int k = 0; k < SMOOTHINGS; ++k)
      spread(*neighbours, rim, displacement);
    for (std::size_t v = 0; v < displacement.size(); ++v) {
      displacement[v] += skin.positions[v] - before[v];
      const double length = displacement[v].norm();
      if (length > LARGEST_DISPLACEMENT)
        displacement[v] *= LARGEST_DISPLACEMENT / length;
    }
    unfold(before, patch, *neighbours, *triangles, displacement);
    for (std::size_t v = 0; v < displacement.size(); ++v)
      skin.positions[v] = before[v] + displacement[v];
  }
  OpenedSkin opened;
  for (std::size_t v = 0; v < before.size(); ++v) {
    whole.positions[patch.vertex[v]] = skin.positions[v];
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
