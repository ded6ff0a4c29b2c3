#pragma once
/// A sewn tube: the simplest garment that has panels, seams and a pattern.
#include <sloper/garment/garment.hpp>

#include <cmath>

namespace sloper::garment {

/// A tube of two panels around a vertical axis, sewn at both sides: pattern coordinates are true
/// lengths.
inline Garment sewn_tube(double radius, double length, double y) {
  Garment g;
  const int n = 24, rows = 12;
  for (int r = 0; r <= rows; ++r)
    for (int c = 0; c < 2 * n; ++c)
      g.position.emplace_back(radius * std::sin(M_PI * c / n), y + length * r / rows,
                              radius * std::cos(M_PI * c / n));
  for (int side = 0; side < 2; ++side) {
    pattern::PanelInfo p;
    p.name = side ? "back" : "front";
    p.first_vertex = static_cast<int>(g.panels.pattern.size());
    p.first_triangle = static_cast<int>(g.panels.triangles.size());
    const auto id = [&](int r, int c) { return p.first_vertex + r * (n + 1) + c; };
    for (int r = 0; r <= rows; ++r)
      for (int c = 0; c <= n; ++c) {
        g.panels.pattern.emplace_back(M_PI * radius * c / n, length * r / rows);
        g.panels.ids.push_back({side, static_cast<double>(c) / n, static_cast<double>(r) / rows});
        g.particle_of.push_back(r * 2 * n + (side * n + c) % (2 * n));
      }
    for (int r = 0; r < rows; ++r)
      for (int c = 0; c < n; ++c) {
        g.panels.triangles.push_back({id(r, c), id(r, c + 1), id(r + 1, c + 1)});
        g.panels.triangles.push_back({id(r, c), id(r + 1, c + 1), id(r + 1, c)});
      }
    for (int c = 0; c < n; ++c)
      p.outline.push_back(id(0, c));
    for (int r = 0; r < rows; ++r)
      p.outline.push_back(id(r, n));
    for (int c = n; c > 0; --c)
      p.outline.push_back(id(rows, c));
    for (int r = rows; r > 0; --r)
      p.outline.push_back(id(r, 0));
    p.n_vertices = static_cast<int>(g.panels.pattern.size()) - p.first_vertex;
    p.n_triangles = static_cast<int>(g.panels.triangles.size()) - p.first_triangle;
    g.panels.panels.push_back(p);
  }
  for (int side = 0; side < 2; ++side) {
    pattern::MeshSeam seam;
    seam.name = side ? "left" : "right";
    seam.kind = "seam";
    for (int r = 0; r <= rows; ++r) {
      seam.a.push_back(g.panels.panels[0].first_vertex + r * (n + 1) + (side ? 0 : n));
      seam.b.push_back(g.panels.panels[1].first_vertex + r * (n + 1) + (side ? n : 0));
    }
    g.panels.seams.push_back(seam);
  }
  for (std::size_t v = 0; v < g.particle_of.size(); ++v)
    g.panels.placed.push_back(g.position[g.particle_of[v]]);
  return g;
}

/// A sewn tube of rest radius `radius` that is held open to `open` at all heights.
inline Garment tube_around(double radius, double length, double y, double open) {
  Garment g = sewn_tube(radius, length, y);
  for (Vec3& p : g.position) {
    p.x() *= open / radius;
    p.z() *= open / radius;
  }
  return g;
}

} // namespace sloper::garment
