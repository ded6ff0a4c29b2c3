#include <sloper/garment/ingest/mesh_surface.hpp>

#include <sloper/geometry/disjoint_sets.hpp>
#include <sloper/geometry/triangle_mesh.hpp>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

namespace sloper::garment {

namespace {

constexpr double ONE_PLACE = 1e-5;   // m: nearer vertices are one
constexpr double LEAST_AREA = 1e-11; // m2, of a triangle: less is none; the solver takes 1e-12

/// The number of each point's place.
std::vector<int> places_of(const std::vector<Vec3>& positions) {
  using Cell = std::array<long, 3>;
  const auto cell_of = [](const Vec3& p) {
    return Cell{std::lround(p.x() / ONE_PLACE), std::lround(p.y() / ONE_PLACE),
                std::lround(p.z() / ONE_PLACE)};
  };
  std::vector<std::pair<Cell, int>> cells;
  for (std::size_t i = 0; i < positions.size(); ++i)
    cells.emplace_back(cell_of(positions[i]), static_cast<int>(i));
  std::sort(cells.begin(), cells.end());
  DisjointSets places(positions.size());
  for (const auto& [cell, i] : cells)
    for (long dx = 0; dx <= 1; ++dx)
      for (long dy = -1; dy <= 1; ++dy) {
        const Cell low{cell[0] + dx, cell[1] + dy, cell[2] - 1};
        for (auto at = std::lower_bound(cells.begin(), cells.end(), std::pair(low, -1));
             at != cells.end() && at->first[0] == low[0] && at->first[1] == low[1] &&
             at->first[2] <= cell[2] + 1;
             ++at)
          if ((positions[i] - positions[at->second]).norm() < ONE_PLACE)
            places.unite(i, at->second);
      }
  return places.numbers();
}

/// Corners of a polygon as triangles: of a quad along the shorter diagonal, else as a fan.
std::vector<std::array<int, 3>> cut(const std::vector<int>& face,
                                    const std::vector<Vec3>& positions) {
  if (face.size() == 4) {
    const double a = (positions[face[0]] - positions[face[2]]).norm(),
                 b = (positions[face[1]] - positions[face[3]]).norm();
    // Of equal ones that with the lowest place, so that a quad and its other side are cut alike.
    const bool equal = std::abs(a - b) <= 1e-9 * (a + b);
    const bool lowest = std::min(face[1], face[3]) < std::min(face[0], face[2]);
    if (equal ? lowest : b < a)
      return {{0, 1, 3}, {1, 2, 3}};
  }
  std::vector<std::array<int, 3>> fan;
  for (int k = 2; k < std::ssize(face); ++k)
    fan.push_back({0, k - 1, k});
  return fan;
}

/// Triangles by edge, with the corner from which each goes along it.
struct EdgeSide {
  int i, j, triangle;
  bool along; ///< the triangle goes from i to j
};
std::vector<EdgeSide> sides_of(const std::vector<Triangle>& triangles) {
  std::vector<EdgeSide> sides;
  for (std::size_t f = 0; f < triangles.size(); ++f)
    for (int k = 0; k < 3; ++k) {
      const int a = triangles[f][k], b = triangles[f][(k + 1) % 3];
      sides.push_back({std::min(a, b), std::max(a, b), static_cast<int>(f), a < b});
    }
  std::sort(sides.begin(), sides.end(), [](const EdgeSide& a, const EdgeSide& b) {
    return std::tie(a.i, a.j, a.triangle) < std::tie(b.i, b.j, b.triangle);
  });
  return sides;
}

template<class Visit> void visit_edges(const std::vector<EdgeSide>& sides, Visit&& visit) {
  for (std::size_t u = 0; u < sides.size();) {
    std::size_t end = u;
    while (end < sides.size() && sides[end].i == sides[u].i && sides[end].j == sides[u].j)
      ++end;
    visit(u, end);
    u = end;
  }
}

/// Turns triangles so that neighbours over an edge of two face alike. @return piece of each
std::vector<int> face_alike(std::vector<Triangle>& triangles, std::vector<Triangle>& texture) {
  const std::vector<EdgeSide> sides = sides_of(triangles);
  std::vector<std::vector<std::pair<int, bool>>> next(triangles.size()); // and whether it is turned
  visit_edges(sides, [&](std::size_t u, std::size_t end) {
    if (end - u != 2)
      return;
    const EdgeSide &a = sides[u], &b = sides[u + 1];
    next[a.triangle].emplace_back(b.triangle, a.along == b.along);
    next[b.triangle].emplace_back(a.triangle, a.along == b.along);
  });
  std::vector<int> piece(triangles.size(), -1);
  std::vector<char> turned(triangles.size(), 0);
  int n = 0;
  for (std::size_t seed = 0; seed < triangles.size(); ++seed) {
    if (piece[seed] >= 0)
      continue;
    std::vector<int> front{static_cast<int>(seed)};
    piece[seed] = n;
    for (std::size_t at = 0; at < front.size(); ++at)
      for (const auto& [f, other] : next[front[at]]) {
        if (piece[f] >= 0)
          continue;
        piece[f] = n;
        turned[f] = static_cast<char>(turned[front[at]] ^ static_cast<char>(other));
        front.push_back(f);
      }
    ++n;
  }
  for (std::size_t f = 0; f < triangles.size(); ++f) {
    if (!turned[f])
      continue;
    std::swap(triangles[f][1], triangles[f][2]);
    if (!texture.empty())
      std::swap(texture[f][1], texture[f][2]);
  }
  return piece;
}

} // namespace

std::vector<Triangle> all_triangles(const io::MeshFile& file, const MeshSurface& surface) {
  std::vector<Triangle> triangles;
  for (const std::vector<int>& face : file.faces) {
    std::vector<int> corners;
    for (const int v : face)
      corners.push_back(surface.place_of[v]);
    for (const auto& c : cut(corners, surface.position))
      triangles.push_back({corners[c[0]], corners[c[1]], corners[c[2]]});
  }
  return triangles;
}

MeshSurface make_surface(const io::MeshFile& file, const std::vector<Vec3>& positions) {
  MeshSurface s;
  s.place_of = places_of(positions);
  for (std::size_t v = 0; v < positions.size(); ++v)
    if (s.place_of[v] == std::ssize(s.position))
      s.position.push_back(positions[v]);
  const bool has_texture = !file.face_texture.empty();
  std::set<Triangle> known;
  for (std::size_t f = 0; f < file.faces.size(); ++f) {
    std::vector<int> corners;
    for (const int v : file.faces[f])
      corners.push_back(s.place_of[v]);
    s.polygons += corners.size() > 3;
    for (const auto& c : cut(corners, s.position)) {
      const Triangle t{corners[c[0]], corners[c[1]], corners[c[2]]};
      if (0.5 * area_normal(s.position[t[0]], s.position[t[1]], s.position[t[2]]).norm() <
          LEAST_AREA) {
        ++s.degenerate;
        continue;
      }
      Triangle sorted = t;
      std::sort(sorted.begin(), sorted.end());
      if (!known.insert(sorted).second) {
        ++s.duplicates;
        continue;
      }
      s.triangles.push_back(t);
      if (!has_texture)
        continue;
      const std::vector<int>& uv = file.face_texture[f];
      s.texture.push_back({uv[c[0]], uv[c[1]], uv[c[2]]});
    }
  }
  face_alike(s.triangles, s.texture);
  DisjointSets joined(s.position.size());
  for (const Triangle& t : s.triangles) {
    joined.unite(t[0], t[1]);
    joined.unite(t[1], t[2]);
  }
  std::map<int, int> number;
  for (const Triangle& t : s.triangles)
    s.component.push_back(
        number.try_emplace(joined.find(t[0]), static_cast<int>(number.size())).first->second);
  s.n_components = static_cast<int>(number.size());
  visit_edges(sides_of(s.triangles), [&](std::size_t u, std::size_t end) {
    s.non_manifold_edges += end - u > 2;
    s.open_edges += end - u == 1;
  });
  return s;
}

void face_outward(const std::vector<Vec3>& position, const std::vector<Vec3>& outward,
                  std::vector<Triangle>& triangles, std::vector<Triangle>& texture) {
  const std::vector<int> piece = face_alike(triangles, texture);
  std::map<int, double> looks;
  for (std::size_t f = 0; f < triangles.size(); ++f) {
    const Triangle& t = triangles[f];
    looks[piece[f]] += area_normal(position[t[0]], position[t[1]], position[t[2]])
                           .dot(outward[t[0]] + outward[t[1]] + outward[t[2]]);
  }
  for (std::size_t f = 0; f < triangles.size(); ++f) {
    if (looks[piece[f]] >= 0)
      continue;
    std::swap(triangles[f][1], triangles[f][2]);
    if (!texture.empty())
      std::swap(texture[f][1], texture[f][2]);
  }
}

} // namespace sloper::garment
