#pragma once
/// A flat square of cloth, for tests: n by n particles in the plane y = 0, warp along -z.
#include <sloper/cloth/cloth_mesh.hpp>
namespace sloper::cloth {
struct Grid {
  ClothMesh mesh;
  std::vector<Vec3> x;
};
inline Grid make_grid(int n, double size, const Fabric& fabric = {}) {
  std::vector<RestTriangle> triangles;
  std::vector<Vec3> x;
  std::vector<Vec2> flat;
  const double step = size / (n - 1);
  for (int r = 0; r < n; ++r)
    for (int c = 0; c < n; ++c) {
      flat.emplace_back(c * step, r * step);
      x.emplace_back(c * step, 0, -r * step);
    }
  auto add = [&](int a, int b, int c) {
    triangles.push_back({{a, b, c}, {flat[a], flat[b], flat[c]}, 0});
  };
  for (int r = 0; r + 1 < n; ++r)
    for (int c = 0; c + 1 < n; ++c) {
      const int a = r * n + c, b = a + 1, d = a + n, e = d + 1;
      if ((r + c) % 2) {
        add(a, b, d);
        add(b, e, d);
      } else {
        add(a, b, e);
        add(a, e, d);
      }
    }
  return {make_cloth_mesh(n * n, triangles, {fabric}), x};
}
} // namespace sloper::cloth
