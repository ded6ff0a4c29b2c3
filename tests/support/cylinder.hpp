#pragma once
#include <geometry/triangle_mesh.hpp>

#include <cmath>

namespace sloper::garment {

/// A closed cylinder about y from -0.2 to `top`, m, for a body.
inline TriangleMesh cylinder(double radius, double top = 0.6) {
  TriangleMesh mesh;
  const int n = 96;
  for (const double y : {-0.2, top})
    for (int c = 0; c < n; ++c) mesh.positions.emplace_back(radius * std::sin(2 * M_PI * c / n), y, radius * std::cos(2 * M_PI * c / n));
  mesh.positions.emplace_back(0, -0.2, 0);
  mesh.positions.emplace_back(0, top, 0);
  for (int c = 0; c < n; ++c) {
    const int d = (c + 1) % n;
    mesh.triangles.push_back({c, d, n + d});
    mesh.triangles.push_back({c, n + d, n + c});
    mesh.triangles.push_back({2 * n, d, c});
    mesh.triangles.push_back({2 * n + 1, n + c, n + d});
  }
  return mesh;
}

} // namespace sloper::garment
