#pragma once
/// The Cusick drape test (BS 5058, ISO 9073-9): a round specimen of 30 cm lies between two discs of
/// 18 cm; the drape coefficient is the share of the free ring's area that the shadow of the draped
/// specimen covers.
#include "at_rest.hpp"

#include <sloper/base/random.hpp>
#include <sloper/cloth/forces/bending.hpp>
#include <sloper/cloth/forces/edge_spring.hpp>
#include <sloper/cloth/forces/gravity.hpp>
#include <sloper/cloth/forces/membrane.hpp>
#include <sloper/cloth/forces/pins.hpp>
#include <sloper/cloth/forces/shear.hpp>
#include <sloper/cloth/forces/triangle_stretch.hpp>
#include <string>

namespace sloper::cloth {

struct Cusick {
  double coefficient = 0; ///< %
  int nodes = 0;          ///< folds around the rim
  int steps = 0;          ///< -1: not at rest
  std::size_t particles = 0;
  double largest_strain = 0;
  std::vector<Vec2> rim; ///< from above, m
};

constexpr double CUSICK_DISC = 0.09, CUSICK_SPECIMEN = 0.15; // m, radii

/// Area of the shadow from above of the part of the cloth outside the disc, m2; by cells of 0.25
/// mm.
inline double ring_shadow(const ClothMesh& mesh, const std::vector<Vec3>& x) {
  constexpr int N = 1280;
  constexpr double REACH = 0.16, CELL = 2 * REACH / N;
  std::vector<char> dark(static_cast<std::size_t>(N) * N, 0);
  for (const RestTriangle& t : mesh.triangles) {
    Vec2 p[3];
    for (int k = 0; k < 3; ++k)
      p[k] = Vec2(x[t.particle[k]].x(), x[t.particle[k]].z());
    const auto side = [](const Vec2& a, const Vec2& b, const Vec2& q) {
      return (b.x() - a.x()) * (q.y() - a.y()) - (b.y() - a.y()) * (q.x() - a.x());
    };
    const Vec2 low = p[0].cwiseMin(p[1]).cwiseMin(p[2]), high = p[0].cwiseMax(p[1]).cwiseMax(p[2]);
    const auto cell = [&](double v) {
      return std::clamp(static_cast<int>((v + REACH) / CELL), 0, N - 1);
    };
    for (int i = cell(low.x()); i <= cell(high.x()); ++i)
      for (int j = cell(low.y()); j <= cell(high.y()); ++j) {
        const Vec2 q((i + 0.5) * CELL - REACH, (j + 0.5) * CELL - REACH);
        const double a = side(p[0], p[1], q), b = side(p[1], p[2], q), c = side(p[2], p[0], q);
        if ((a >= 0 && b >= 0 && c >= 0) || (a <= 0 && b <= 0 && c <= 0))
          dark[static_cast<std::size_t>(i) * N + j] = q.norm() > CUSICK_DISC;
      }
  }
  std::size_t count = 0;
  for (char d : dark)
    count += d;
  return static_cast<double>(count) * CELL * CELL;
}

/// @param rings  free rings of the mesh: 8 is an edge length of about 9 mm
/// @param seed   of the small roughness from which the folds grow
inline Cusick drape_cusick(const Fabric& fabric, int rings, const std::string& model,
                           std::uint64_t seed = 1) {
  // Only the ring outside the disc is meshed. Two rings of particles are held, at half a cell to
  // either side of the disc's rim: the hinges between carry half their curvature inside (see
  // test_elastica.cpp).
  const double dr = (CUSICK_SPECIMEN - CUSICK_DISC) / (rings - 0.5);
  std::vector<Vec2> flat;
  std::vector<std::vector<int>> ring;
  for (int k = 0; k <= rings; ++k) {
    const double r = CUSICK_DISC - 0.5 * dr + k * dr;
    const int n = static_cast<int>(std::lround(2 * M_PI * r * std::sqrt(0.75) / dr));
    const double offset = std::fmod(0.6180339887 * k, 1.0); // no two rings in line
    ring.emplace_back();
    for (int i = 0; i < n; ++i) {
      const double a = 2 * M_PI * (i + offset) / n;
      ring.back().push_back(std::ssize(flat));
      flat.emplace_back(r * std::cos(a), r * std::sin(a));
    }
  }
  std::vector<RestTriangle> triangles;
  auto add = [&](int a, int b, int c) {
    triangles.push_back({{a, b, c}, {flat[a], flat[b], flat[c]}, 0});
  };
  for (int k = 0; k < rings; ++k) { // zip two rings, always by the shorter diagonal
    const auto &p = ring[k], &q = ring[k + 1];
    std::size_t j0 = 0;
    for (std::size_t j = 0; j < q.size(); ++j)
      if ((flat[q[j]] - flat[p[0]]).norm() < (flat[q[j0]] - flat[p[0]]).norm())
        j0 = j;
    for (std::size_t i = 0, j = 0; i < p.size() || j < q.size();) {
      const int pi = p[i % p.size()], pn = p[(i + 1) % p.size()], qj = q[(j0 + j) % q.size()],
                qn = q[(j0 + j + 1) % q.size()];
      const bool inner = j == q.size() || (i < p.size() && (flat[pn] - flat[qj]).norm() <
                                                               (flat[qn] - flat[pi]).norm());
      if (inner) {
        add(pi, qj, pn);
        ++i;
      } else {
        add(pi, qj, qn);
        ++j;
      }
    }
  }
  const ClothMesh mesh = make_cloth_mesh(static_cast<int>(flat.size()), triangles, {fabric});
  Random random(seed);
  std::vector<Vec3> x;
  std::vector<Pin> pins;
  for (std::size_t i = 0; i < flat.size(); ++i) {
    x.emplace_back(flat[i].x(), 0, -flat[i].y());
    if (static_cast<int>(i) <= ring[1].back())
      pins.push_back({static_cast<int>(i), x.back(), 1e4, Vec3::Zero()});
    else
      x.back().y() += random.uniform(-1e-3, 1e-3);
  }
  ClothSolver solver(mesh, x);
  if (model == "fem")
    solver.emplace<MembraneEffect>(mesh);
  else if (model == "triangles")
    solver.emplace<TriangleStretchEffect>(mesh);
  else
    solver.emplace<EdgeSpringEffect>(mesh);
  if (model != "fem")
    solver.emplace<ShearEffect>(mesh);
  solver.emplace<BendingEffect>(mesh);
  solver.emplace<GravityEffect>(mesh, Vec3(0, -9.80665, 0));
  solver.emplace<PinsEffect>(pins);

  Cusick out;
  out.particles = flat.size();
  out.steps = go_to_rest(solver, 1e-4, 1500, 0.2);
  const auto& y = solver.x();
  const double disc = M_PI * CUSICK_DISC * CUSICK_DISC,
               specimen = M_PI * CUSICK_SPECIMEN * CUSICK_SPECIMEN;
  out.coefficient = 100 * ring_shadow(mesh, y) / (specimen - disc);
  double mean = 0;
  std::vector<double> radius;
  for (int i : ring.back()) {
    out.rim.emplace_back(y[i].x(), y[i].z());
    radius.push_back(out.rim.back().norm());
  }
  for (double r : radius)
    mean += r / static_cast<double>(radius.size());
  bool out_there = radius.back() > mean;
  for (double r : radius) { // a fold counts when it swings 2 mm to either side
    const bool now = r > mean + (out_there ? -0.002 : 0.002);
    out.nodes += now && !out_there;
    out_there = now;
  }
  for (const EdgeSpring& s : mesh.springs)
    out.largest_strain = std::max(out.largest_strain, (y[s.j] - y[s.i]).norm() / s.rest_length - 1);
  return out;
}

} // namespace sloper::cloth
