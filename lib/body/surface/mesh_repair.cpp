#include <body/surface/mesh_repair.hpp>
#include <sloper/geometry/disjoint_sets.hpp>

#include <algorithm>
#include <array>
#include <map>
#include <numeric>
#include <tuple>

namespace sloper::body {

namespace {

constexpr std::size_t FEW_EDGES =
    20; ///< around some faces of a mesh that were dropped, however coarse it is

/// Border edges against their face's direction, so that a new face agrees with the old one. Sorted.
std::vector<std::array<int, 2>> border_of(const TriangleMesh& mesh,
                                          const std::vector<HalfEdge>& list) {
  std::vector<std::array<int, 2>> border;
  for (std::size_t i = 0; i < list.size();) {
    std::size_t j = i;
    while (j < list.size() && list[j].key == list[i].key)
      ++j;
    if (j - i == 1) {
      const int low = static_cast<int>(list[i].key >> 32),
                high = static_cast<int>(list[i].key & 0xffffffffu);
      const Triangle& t = mesh.triangles[list[i].face];
      bool forward = false; // the face may have been turned since: look again
      for (int k = 0; k < 3; ++k)
        forward |= t[k] == low && t[(k + 1) % 3] == high;
      border.push_back(forward ? std::array<int, 2>{high, low} : std::array<int, 2>{low, high});
    }
    i = j;
  }
  std::sort(border.begin(), border.end());
  return border;
}

} // namespace

std::vector<std::vector<int>> border_loops(const std::vector<std::array<int, 2>>& border) {
  std::vector<char> used(border.size(), 0);
  auto next_of = [&](int v) {
    for (auto it = std::lower_bound(border.begin(), border.end(), std::array<int, 2>{v, -1});
         it != border.end() && (*it)[0] == v; ++it)
      if (!used[it - border.begin()])
        return static_cast<int>(it - border.begin());
    return -1;
  };
  std::vector<std::vector<int>> loops;
  for (std::size_t start = 0; start < border.size(); ++start) {
    if (used[start])
      continue;
    std::vector<int> walk = {border[start][0]};
    int e = static_cast<int>(start);
    while (true) {
      used[e] = 1;
      const int v = border[e][1];
      const auto before = std::find(walk.begin(), walk.end(), v);
      if (before != walk.end()) {
        loops.emplace_back(before, walk.end());
        walk.erase(before + 1, walk.end());
        if (loops.back().size() < 3)
          return {};
        if (walk.size() == 1 && v == border[start][0])
          break;
      } else
        walk.push_back(v);
      e = next_of(v);
      if (e < 0)
        return {};
    }
  }
  return loops;
}

TriangleMesh own_faces(const std::vector<Vec3>& positions, const std::vector<Triangle>& triangles,
                       const std::vector<char>& is_body, std::vector<int>& number) {
  TriangleMesh skin;
  number.assign(positions.size(), -1);
  std::vector<int> first(positions.size() + 1, 0);
  for (const Triangle& t : triangles) {
    if (!is_body[t[0]] || !is_body[t[1]] || !is_body[t[2]] || t[0] == t[1] || t[1] == t[2] ||
        t[2] == t[0])
      continue;
    if (area_normal(positions[t[0]], positions[t[1]], positions[t[2]]).squaredNorm() < 1e-24)
      continue;
    ++first[std::min({t[0], t[1], t[2]}) + 1];
    skin.triangles.push_back(t);
  }
  // faces by their lowest vertex, and those of one vertex by the other two: what is equal is the
  // same face again
  std::partial_sum(first.begin(), first.end(), first.begin());
  std::vector<std::array<int, 3>> seen(skin.triangles.size()); // middle and highest vertex, face
  std::vector<int> at(first.begin(), first.end() - 1);
  for (std::size_t i = 0; i < skin.triangles.size(); ++i) {
    const auto& [a, b, c] = skin.triangles[i];
    const int low = std::min({a, b, c}), high = std::max({a, b, c});
    seen[at[low]++] = {static_cast<int>(static_cast<long>(a) + b + c - low - high), high,
                       static_cast<int>(i)};
  }
  std::vector<char> keep(skin.triangles.size(), 1);
  for (std::size_t v = 0; v < positions.size(); ++v) {
    std::sort(seen.begin() + first[v], seen.begin() + first[v + 1]);
    for (int i = first[v] + 1; i < first[v + 1]; ++i)
      if (seen[i][0] == seen[i - 1][0] && seen[i][1] == seen[i - 1][1])
        keep[seen[i][2]] = 0;
  }
  std::vector<Triangle> kept;
  for (std::size_t i = 0; i < skin.triangles.size(); ++i) {
    if (!keep[i])
      continue;
    Triangle t = skin.triangles[i];
    for (int& v : t) {
      int& n = number[v];
      if (n < 0) {
        n = static_cast<int>(skin.positions.size());
        skin.positions.push_back(positions[v]);
      }
      v = n;
    }
    kept.push_back(t);
  }
  skin.triangles = std::move(kept);
  return skin;
}

bool weld(TriangleMesh& mesh, std::vector<int>& of_scan) {
  std::vector<int> order(mesh.positions.size());
  for (std::size_t i = 0; i < order.size(); ++i)
    order[i] = static_cast<int>(i);
  auto less = [&](int a, int b) {
    const Vec3 &p = mesh.positions[a], &q = mesh.positions[b];
    return std::tie(p.x(), p.y(), p.z(), a) < std::tie(q.x(), q.y(), q.z(), b);
  };
  std::sort(order.begin(), order.end(), less);
  std::vector<int> target(order.size());
  bool any = false;
  for (std::size_t i = 0; i < order.size(); ++i) {
    const bool same = i > 0 && mesh.positions[order[i]] == mesh.positions[order[i - 1]];
    target[order[i]] = same ? target[order[i - 1]] : order[i];
    any |= same;
  }
  if (!any)
    return false;
  std::vector<int> number(order.size(), -1);
  std::vector<Vec3> positions;
  for (std::size_t v = 0; v < order.size(); ++v)
    if (target[v] == static_cast<int>(v)) {
      number[v] = static_cast<int>(positions.size());
      positions.push_back(mesh.positions[v]);
    }
  std::vector<Triangle> triangles;
  for (const Triangle& t : mesh.triangles) {
    const Triangle w = {number[target[t[0]]], number[target[t[1]]], number[target[t[2]]]};
    if (w[0] != w[1] && w[1] != w[2] && w[2] != w[0])
      triangles.push_back(w);
  }
  mesh.positions = std::move(positions);
  mesh.triangles = std::move(triangles);
  for (int& v : of_scan)
    if (v >= 0)
      v = number[target[v]];
  return true;
}

int drop_small_pieces(TriangleMesh& mesh, std::vector<int>& of_scan) {
  const std::vector<int> piece = connected_components(mesh.positions.size(), mesh.triangles);
  std::vector<std::size_t> faces(mesh.positions.size(), 0);
  for (const Triangle& t : mesh.triangles)
    ++faces[piece[t[0]]];
  int dropped = 0;
  for (std::size_t n : faces)
    dropped += n > 0 && n * 100 < mesh.triangles.size();
  if (dropped == 0)
    return 0;
  auto keep = [&](int v) { return faces[piece[v]] * 100 >= mesh.triangles.size(); };
  std::vector<int> number(mesh.positions.size(), -1);
  TriangleMesh kept;
  for (std::size_t v = 0; v < mesh.positions.size(); ++v)
    if (keep(static_cast<int>(v))) {
      number[v] = static_cast<int>(kept.positions.size());
      kept.positions.push_back(mesh.positions[v]);
    }
  for (const Triangle& t : mesh.triangles)
    if (keep(t[0]))
      kept.triangles.push_back({number[t[0]], number[t[1]], number[t[2]]});
  for (int& v : of_scan)
    if (v >= 0)
      v = number[v];
  mesh = std::move(kept);
  return dropped;
}

std::vector<HalfEdge> half_edges(const TriangleMesh& mesh) {
  std::vector<HalfEdge> list(mesh.triangles.size() * 3);
  std::vector<std::size_t> first(
      mesh.positions.size() + 1,
      0); // by the lower vertex, then those of one vertex among themselves
  for (const Triangle& t : mesh.triangles)
    for (int k = 0; k < 3; ++k)
      ++first[std::min(t[k], t[(k + 1) % 3]) + 1];
  std::partial_sum(first.begin(), first.end(), first.begin());
  std::vector<std::size_t> at(first.begin(), first.end() - 1);
  for (std::size_t f = 0; f < mesh.triangles.size(); ++f)
    for (int k = 0; k < 3; ++k) {
      const auto a = static_cast<std::uint64_t>(mesh.triangles[f][k]),
                 b = static_cast<std::uint64_t>(mesh.triangles[f][(k + 1) % 3]);
      list[at[std::min(a, b)]++] = {std::min(a, b) << 32 | std::max(a, b), static_cast<int>(f),
                                    a < b};
    }
  for (std::size_t v = 0; v + 1 < first.size(); ++v)
    std::sort(list.begin() + static_cast<std::ptrdiff_t>(first[v]),
              list.begin() + static_cast<std::ptrdiff_t>(first[v + 1]),
              [](const HalfEdge& a, const HalfEdge& b) {
                return a.key != b.key ? a.key < b.key : a.face < b.face;
              });
  return list;
}

EdgeCounts count_edges(const std::vector<HalfEdge>& list) {
  EdgeCounts counts;
  for (std::size_t i = 0; i < list.size();) {
    std::size_t j = i;
    while (j < list.size() && list[j].key == list[i].key)
      ++j;
    if (j - i == 1)
      ++counts.border;
    else if (j - i > 2)
      ++counts.crowded;
    else if (list[i].forward == list[i + 1].forward)
      ++counts.flipped;
    i = j;
  }
  return counts;
}

void orient_faces(TriangleMesh& mesh, const std::vector<HalfEdge>& list) {
  const std::size_t n = mesh.triangles.size();
  // pieces of faces that neighbour over an edge of two, each face turned or not against the piece's
  // lowest: a disjoint-set forest with parity
  std::vector<int> parent(n);
  std::vector<char> against(n, 0); // the parent
  std::iota(parent.begin(), parent.end(), 0);
  const auto root = [&](int f) {
    int top = f;
    char turned = 0;
    for (; parent[top] != top; top = parent[top])
      turned ^= against[top];
    for (int next; parent[f] != top && f != top; f = next) {
      next = parent[f];
      const char rest = turned ^ against[f];
      parent[f] = top;
      against[f] = turned;
      turned = rest;
    }
    return top;
  };
  for (std::size_t i = 0; i + 1 < list.size(); ++i) {
    if (list[i].key != list[i + 1].key)
      continue;
    if ((i > 0 && list[i - 1].key == list[i].key) ||
        (i + 2 < list.size() && list[i + 2].key == list[i].key))
      continue; // crowded
    const int a = root(list[i].face), b = root(list[i + 1].face);
    if (a == b)
      continue;
    const char turned_a = a == list[i].face ? 0 : against[list[i].face],
               turned_b = b == list[i + 1].face ? 0 : against[list[i + 1].face];
    parent[std::max(a, b)] = std::min(a, b);
    against[std::max(a, b)] = turned_a ^ turned_b ^ (list[i].forward == list[i + 1].forward);
  }
  std::vector<Vec3> middle(n, Vec3::Zero());
  std::vector<int> count(n, 0);
  std::vector<double> volume(n, 0);
  for (std::size_t f = 0; f < n; ++f) {
    const int piece = root(static_cast<int>(f));
    if (piece != static_cast<int>(f) && against[f])
      std::swap(mesh.triangles[f][1], mesh.triangles[f][2]);
    middle[piece] += mesh.positions[mesh.triangles[f][0]];
    ++count[piece];
  }
  for (std::size_t f = 0; f < n; ++f) {
    const int piece = parent[f];
    const Vec3 o = middle[piece] / count[piece];
    const Triangle& t = mesh.triangles[f];
    volume[piece] +=
        (mesh.positions[t[0]] - o).dot((mesh.positions[t[1]] - o).cross(mesh.positions[t[2]] - o));
  }
  for (std::size_t f = 0; f < n; ++f)
    if (volume[parent[f]] < 0)
      std::swap(mesh.triangles[f][1], mesh.triangles[f][2]);
}

std::vector<Hole> holes_of(const TriangleMesh& mesh, const std::vector<HalfEdge>& list,
                           double least, std::size_t most) {
  const std::vector<std::array<int, 2>> border = border_of(mesh, list);
  DisjointSets joined(mesh.positions.size());
  for (const auto& [a, b] : border)
    joined.unite(a, b);
  std::map<int, std::pair<Hole, Box3>> pieces; // by the lowest vertex
  for (const auto& [a, b] : border) {
    auto& [hole, box] = pieces[joined.find(a)];
    hole.center += 0.5 * (mesh.positions[a] + mesh.positions[b]);
    ++hole.edges;
    box.add(mesh.positions[a]);
    box.add(mesh.positions[b]);
  }
  std::vector<Hole> holes;
  for (auto& [vertex, piece] : pieces) {
    Hole& hole = piece.first;
    hole.width = piece.second.size().norm();
    hole.center /= hole.edges;
    if (hole.width >= least)
      holes.push_back(hole);
  }
  std::stable_sort(holes.begin(), holes.end(),
                   [](const Hole& a, const Hole& b) { return a.width > b.width; });
  if (holes.size() > most)
    holes.resize(most);
  return holes;
}

bool fill_holes(TriangleMesh& mesh, const std::vector<HalfEdge>& list, double widest, double low,
                double high) {
  const std::vector<std::vector<int>> loops = border_loops(border_of(mesh, list));
  if (loops.empty())
    return false;
  for (const std::vector<int>& loop : loops) {
    Box3 box;
    for (const int v : loop)
      box.add(mesh.positions[v]);
    const bool at_an_end = box.high.y() < low || box.low.y() > high;
    if (box.size().norm() > widest && loop.size() > FEW_EDGES && !at_an_end)
      return false;
  }
  std::vector<Vec3> normal(mesh.positions.size(), Vec3::Zero());
  for (const Triangle& t : mesh.triangles) {
    const Vec3 facing =
        area_normal(mesh.positions[t[0]], mesh.positions[t[1]], mesh.positions[t[2]]);
    for (const int v : t)
      normal[v] += facing;
  }
  for (const std::vector<int>& loop : loops) {
    if (loop.size() == 3) {
      mesh.triangles.push_back({loop[0], loop[1], loop[2]});
      continue;
    }
    Vec3 middle = Vec3::Zero();
    for (const int v : loop)
      middle += mesh.positions[v] / static_cast<double>(loop.size());
    if (loop.size() <= FEW_EDGES) { // over a sphere the hub stands half as far out as its rim's
                                    // normals lean, which without the faces inside lean too far
      Vec3 out = Vec3::Zero();
      double lean = 0, reach = 0;
      for (const int v : loop) {
        const double length = normal[v].norm(), share = 1 / static_cast<double>(loop.size());
        if (length <= 0)
          continue;
        const Vec3 arm = mesh.positions[v] - middle;
        out += normal[v] / length;
        lean += share * arm.dot(normal[v]) / length;
        reach += share * arm.norm();
      }
      if (const double length = out.norm(); length > 0)
        middle += std::clamp(0.3 * lean, -0.2 * reach, 0.2 * reach) / length * out;
    }
    const int hub = std::ssize(mesh.positions);
    mesh.positions.push_back(middle);
    for (std::size_t k = 0; k < loop.size(); ++k)
      mesh.triangles.push_back({loop[k], loop[(k + 1) % loop.size()], hub});
  }
  return true;
}

} // namespace sloper::body
