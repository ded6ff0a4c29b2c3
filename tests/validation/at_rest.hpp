#pragma once
/// Cloth for the validation tests: rectangular sheets, and the road to rest.
#include <cmath>
#include <sloper/cloth/solver/implicit_step.hpp>

namespace sloper::cloth {

struct Sheet {
  ClothMesh mesh;
  std::vector<Vec3> x;
  int nx = 0, ny = 0; ///< cells along weft (x) and warp
  int at(int c, int r) const { return r * (nx + 1) + c; }
};

/// Flat rectangle in the x-z plane, weft along +x, warp along -z; `first` is the corner at column
/// 0, row 0.
inline Sheet make_sheet(int nx, int ny, double dx, double dy, const Fabric& fabric,
                        const Vec3& first = Vec3::Zero()) {
  Sheet s;
  s.nx = nx;
  s.ny = ny;
  std::vector<Vec2> flat;
  std::vector<RestTriangle> triangles;
  for (int r = 0; r <= ny; ++r)
    for (int c = 0; c <= nx; ++c) {
      flat.emplace_back(c * dx, r * dy);
      s.x.push_back(first + Vec3(c * dx, 0, -r * dy));
    }
  auto add = [&](int a, int b, int c) {
    triangles.push_back({{a, b, c}, {flat[a], flat[b], flat[c]}, 0});
  };
  for (int r = 0; r < ny; ++r)
    for (int c = 0; c < nx; ++c) {
      const int a = s.at(c, r), b = s.at(c + 1, r), d = s.at(c, r + 1), e = s.at(c + 1, r + 1);
      if ((r + c) % 2) {
        add(a, b, d);
        add(b, e, d);
      } else {
        add(a, b, e);
        add(a, e, d);
      }
    }
  s.mesh = make_cloth_mesh(static_cast<int>(s.x.size()), triangles, {fabric});
  return s;
}

/// Rectangle of equilateral triangles (as the pattern's mesher makes inside a panel) in the x-z
/// plane: rows[c] are the particles of column c at x = c dx, straight across from z = 0 to z = -m
/// l, l = dx / sqrt(3/4); halved triangles at both sides.
struct HexSheet {
  ClothMesh mesh;
  std::vector<Vec3> x;
  std::vector<std::vector<int>> columns;
};
inline HexSheet make_hex_sheet(int n, double dx, int m, const Fabric& fabric) {
  HexSheet s;
  const double l = dx / std::sqrt(0.75);
  std::vector<Vec2> flat;
  std::vector<RestTriangle> triangles;
  for (int c = 0; c <= n; ++c) {
    std::vector<double> across{0};
    for (int k = c % 2 ? 0 : 1; k < m; ++k)
      across.push_back((c % 2 ? k + 0.5 : k) * l);
    across.push_back(m * l);
    s.columns.emplace_back();
    for (double z : across) {
      s.columns.back().push_back(std::ssize(flat));
      flat.emplace_back(c * dx, z);
      s.x.emplace_back(c * dx, 0, -z);
    }
  }
  auto add = [&](int a, int b, int c) {
    triangles.push_back({{a, b, c}, {flat[a], flat[b], flat[c]}, 0});
  };
  for (int c = 0; c < n; ++c) { // zip two columns
    const auto &p = s.columns[c], &q = s.columns[c + 1];
    for (std::size_t i = 0, j = 0; i + 1 < p.size() || j + 1 < q.size();) {
      const double next_p = i + 1 < p.size() ? flat[p[i + 1]].y() : 1e300,
                   next_q = j + 1 < q.size() ? flat[q[j + 1]].y() : 1e300;
      if (next_p < next_q || (next_p == next_q && p.size() > q.size())) {
        add(p[i], q[j], p[i + 1]);
        ++i;
      } else {
        add(p[i], q[j], q[j + 1]);
        ++j;
      }
    }
  }
  s.mesh = make_cloth_mesh(static_cast<int>(flat.size()), triangles, {fabric});
  return s;
}

/// Steps without inertia until no particle moves more than `still` (m/s of pseudo time) and the
/// residual force is small.
/// @return steps taken, or -1 when that did not do
inline int go_to_rest(ClothSolver& solver, double still = 1e-5, int most = 3000,
                      double largest_h = 0.5) {
  StepOptions o;
  o.h = 0.02;
  o.cg_tolerance = 1e-4;
  o.cg_max_iterations = 2000;
  o.largest_move_m = 0.02;
  for (int k = 0; k < most; ++k) {
    const StepResult r = solver.step(o);
    if (!r.finite)
      return -1;
    if (r.largest_move_m / o.h < still && o.h > 0.5 * largest_h)
      return k + 1;
    o.h = r.largest_move_m < 0.005 ? std::min(1.3 * o.h, largest_h) : std::max(0.8 * o.h, 0.005);
  }
  return -1;
}

} // namespace sloper::cloth
