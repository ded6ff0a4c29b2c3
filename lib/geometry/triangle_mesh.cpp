#include <sloper/geometry/disjoint_sets.hpp>
#include <sloper/geometry/triangle_mesh.hpp>

#include <algorithm>
#include <cmath>

namespace sloper {

Box3 bounding_box(const std::vector<Vec3>& points) {
  Box3 box;
  for (const Vec3& p : points)
    box.add(p);
  return box;
}

std::vector<Vec3> vertex_normals(const TriangleMesh& mesh) {
  return vertex_normals(mesh, std::vector<char>(mesh.positions.size(), 1));
}

std::vector<Vec3> vertex_normals(const TriangleMesh& mesh, const std::vector<char>& wanted) {
  std::vector<Vec3> normals(mesh.positions.size(), Vec3::Zero());
  for (const Triangle& t : mesh.triangles) {
    if (!wanted[t[0]] && !wanted[t[1]] && !wanted[t[2]])
      continue;
    const Vec3* p[3] = {&mesh.positions[t[0]], &mesh.positions[t[1]], &mesh.positions[t[2]]};
    Vec3 n = area_normal(*p[0], *p[1], *p[2]);
    const double length = n.norm();
    if (length < 1e-300)
      continue;
    n /= length;
    for (int k = 0; k < 3; ++k) {
      const Vec3 e1 = *p[(k + 1) % 3] - *p[k], e2 = *p[(k + 2) % 3] - *p[k];
      normals[t[k]] += std::atan2(e1.cross(e2).norm(), e1.dot(e2)) * n;
    }
  }
  for (Vec3& n : normals) {
    const double length = n.norm();
    if (length > 1e-300)
      n /= length;
  }
  return normals;
}

namespace {

/// As often as triangles have them.
std::vector<std::array<int, 2>> sorted_edges(const std::vector<Triangle>& triangles) {
  std::vector<std::array<int, 2>> edges;
  edges.reserve(triangles.size() * 3);
  for (const Triangle& t : triangles)
    for (int k = 0; k < 3; ++k)
      edges.push_back({std::min(t[k], t[(k + 1) % 3]), std::max(t[k], t[(k + 1) % 3])});
  std::sort(edges.begin(), edges.end());
  return edges;
}

} // namespace

std::vector<std::array<int, 2>> edges_of(const std::vector<Triangle>& triangles) {
  std::vector<std::array<int, 2>> edges = sorted_edges(triangles);
  edges.erase(std::unique(edges.begin(), edges.end()), edges.end());
  return edges;
}

std::vector<std::array<int, 2>> free_edges_of(const std::vector<Triangle>& triangles) {
  const std::vector<std::array<int, 2>> edges = sorted_edges(triangles);
  std::vector<std::array<int, 2>> free;
  for (std::size_t i = 0; i < edges.size(); ++i)
    if ((i == 0 || edges[i] != edges[i - 1]) && (i + 1 == edges.size() || edges[i] != edges[i + 1]))
      free.push_back(edges[i]);
  return free;
}

std::vector<int> connected_components(std::size_t n_vertices,
                                      const std::vector<Triangle>& triangles) {
  DisjointSets joined(n_vertices);
  for (const Triangle& t : triangles)
    for (int k = 1; k < 3; ++k)
      joined.unite(t[0], t[k]);
  return joined.numbers();
}

} // namespace sloper
