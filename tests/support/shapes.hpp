#pragma once
/// Test meshes: spheres, bodies of revolution, sheets, triangle soups; all seeded.
#include <sloper/base/random.hpp>
#include <sloper/base/units.hpp>
#include <sloper/geometry/triangle_mesh.hpp>

#include <cmath>
#include <map>
#include <vector>

namespace sloper::shapes {

inline Vec3 random_point(Random& random, double size = 1) {
  const double x = random.uniform(-size, size), y = random.uniform(-size, size),
               z = random.uniform(-size, size);
  return {x, y, z};
}

/// A point of the grid 0 .. range - 1.
inline Vec3 grid_point(Random& random, unsigned range) {
  Vec3 p;
  for (double& c : p)
    c = static_cast<double>(random.next() % range);
  return p;
}

/// Subdivided icosahedron: 20 * 4^levels triangles, outward.
inline TriangleMesh sphere(int levels, double radius = 1, const Vec3& center = Vec3::Zero()) {
  const double g = (1 + std::sqrt(5.0)) / 2;
  TriangleMesh mesh;
  mesh.positions = {{-1, g, 0},  {1, g, 0},  {-1, -g, 0}, {1, -g, 0}, {0, -1, g},  {0, 1, g},
                    {0, -1, -g}, {0, 1, -g}, {g, 0, -1},  {g, 0, 1},  {-g, 0, -1}, {-g, 0, 1}};
  mesh.triangles = {{0, 11, 5}, {0, 5, 1},  {0, 1, 7},   {0, 7, 10}, {0, 10, 11},
                    {1, 5, 9},  {5, 11, 4}, {11, 10, 2}, {10, 7, 6}, {7, 1, 8},
                    {3, 9, 4},  {3, 4, 2},  {3, 2, 6},   {3, 6, 8},  {3, 8, 9},
                    {4, 9, 5},  {2, 4, 11}, {6, 2, 10},  {8, 6, 7},  {9, 8, 1}};
  for (int level = 0; level < levels; ++level) {
    std::map<std::array<int, 2>, int> middle;
    std::vector<Triangle> finer;
    for (const Triangle& t : mesh.triangles) {
      Triangle m;
      for (int k = 0; k < 3; ++k) {
        const int a = t[k], b = t[(k + 1) % 3];
        const auto [at, fresh] = middle.try_emplace({std::min(a, b), std::max(a, b)},
                                                    static_cast<int>(mesh.positions.size()));
        if (fresh)
          mesh.positions.push_back(mesh.positions[a] + mesh.positions[b]);
        m[k] = at->second;
      }
      finer.insert(
          finer.end(),
          {{t[0], m[0], m[2]}, {t[1], m[1], m[0]}, {t[2], m[2], m[1]}, {m[0], m[1], m[2]}});
    }
    mesh.triangles = finer;
    for (Vec3& p : mesh.positions)
      p.normalize();
  }
  for (Vec3& p : mesh.positions)
    p = center + radius * p.normalized();
  return mesh;
}

/// One level ring of a surface of revolution, an ellipse about (0, y, 0): (x sin a, y, z cos a), m.
struct Ring {
  double y, x, z;
};

/// The rings' surface about the vertical through `center`, `around` vertices a ring, outward where
/// rings go upwards. Ring by ring: vertices, then the triangles between. @param turned  angle of
/// each ring's first vertex from +z towards +x, in steps of a ring
inline TriangleMesh revolve(int around, const std::vector<Ring>& rings,
                            const Vec3& center = Vec3::Zero(), double turned = 0) {
  TriangleMesh mesh;
  for (const Ring& ring : rings)
    for (int c = 0; c < around; ++c) {
      const double a = 2 * units::PI * (c + turned) / around;
      mesh.positions.push_back(center + Vec3(ring.x * std::sin(a), ring.y, ring.z * std::cos(a)));
    }
  const auto id = [around](int r, int c) { return r * around + c % around; };
  for (int r = 0; r + 1 < std::ssize(rings); ++r)
    for (int c = 0; c < around; ++c) {
      mesh.triangles.push_back({id(r, c), id(r, c + 1), id(r + 1, c + 1)});
      mesh.triangles.push_back({id(r, c), id(r + 1, c + 1), id(r + 1, c)});
    }
  return mesh;
}

/// Closes what revolve() made: a fan from a point below the first ring and one from a point above
/// the last.
inline void close_ends(TriangleMesh& mesh, int around, const Vec3& low, const Vec3& high) {
  const int top = static_cast<int>(mesh.positions.size()) - around;
  const int below = static_cast<int>(mesh.positions.size()), above = below + 1;
  mesh.positions.push_back(low);
  mesh.positions.push_back(high);
  for (int c = 0; c < around; ++c)
    mesh.triangles.push_back({below, (c + 1) % around, c});
  for (int c = 0; c < around; ++c)
    mesh.triangles.push_back({above, top + c, top + (c + 1) % around});
}

/// A closed cylinder about the vertical through `center`, from y = low to high, in `up` rows.
inline TriangleMesh cylinder(double radius, double low, double high, int around, int up = 1,
                             const Vec3& center = Vec3::Zero(), double turned = 0) {
  std::vector<Ring> rings;
  for (int r = 0; r <= up; ++r)
    rings.push_back({low + (high - low) * r / up, radius, radius});
  TriangleMesh mesh = revolve(around, rings, center, turned);
  close_ends(mesh, around, center + Vec3(0, low, 0), center + Vec3(0, high, 0));
  return mesh;
}

/// A sheet of 2 n m triangles over [0, width] x [0, height] in x and y.
inline TriangleMesh sheet(int n, int m, double width, double height, double z = 0) {
  TriangleMesh mesh;
  for (int j = 0; j <= m; ++j)
    for (int i = 0; i <= n; ++i)
      mesh.positions.push_back({width * i / n, height * j / m, z});
  for (int j = 0; j < m; ++j)
    for (int i = 0; i < n; ++i) {
      const int a = j * (n + 1) + i, b = a + 1, c = a + n + 1, d = c + 1;
      if ((i + j) % 2)
        mesh.triangles.insert(mesh.triangles.end(), {{a, b, d}, {a, d, c}});
      else
        mesh.triangles.insert(mesh.triangles.end(), {{a, b, c}, {b, d, c}});
    }
  return mesh;
}

inline void jitter(TriangleMesh& mesh, double amount, std::uint64_t seed) {
  Random random(seed);
  for (Vec3& p : mesh.positions)
    p += random_point(random, amount);
}

inline void append(TriangleMesh& mesh, const TriangleMesh& other) {
  const auto base = static_cast<int>(mesh.positions.size());
  mesh.positions.insert(mesh.positions.end(), other.positions.begin(), other.positions.end());
  for (const Triangle& t : other.triangles)
    mesh.triangles.push_back({t[0] + base, t[1] + base, t[2] + base});
}

/// Unconnected triangles of all sizes, with some repeated points, slivers and zero areas among
/// them.
inline TriangleMesh soup(int n, double size, std::uint64_t seed) {
  Random random(seed);
  TriangleMesh mesh;
  for (int i = 0; i < n; ++i) {
    const Vec3 a = random_point(random);
    Vec3 b = a + random_point(random, size), c = a + random_point(random, size);
    if (i % 17 == 3)
      c = b;
    if (i % 23 == 5)
      c = 0.5 * (a + b) + random_point(random, 1e-12);
    if (i % 29 == 7)
      b = c = a;
    mesh.positions.insert(mesh.positions.end(), {a, b, c});
    mesh.triangles.push_back({3 * i, 3 * i + 1, 3 * i + 2});
  }
  return mesh;
}

} // namespace sloper::shapes
