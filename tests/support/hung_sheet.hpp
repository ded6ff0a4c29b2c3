#pragma once
/// A rectangle of cloth as a garment of one panel, standing upright before it is draped.
#include <sloper/garment/garment.hpp>

#include <cmath>

namespace sloper::garment {

/// nx by ny cells of `cell` m, its lower left corner at (0, 1, 0), warp up, outside towards +z.
/// @param ripple  m: it stands a little out of its plane
inline Garment hung_sheet(int nx, int ny, double cell, double ripple = 0.002) {
  Garment g;
  pattern::PanelMesh& p = g.panels;
  p.name = "sheet";
  p.edge_length = cell;
  pattern::PanelInfo panel;
  panel.name = "sheet";
  panel.n_vertices = (nx + 1) * (ny + 1);
  panel.n_triangles = 2 * nx * ny;
  panel.grain = Vec2(0, 1);
  const auto at = [&](int c, int r) { return r * (nx + 1) + c; };
  for (int r = 0; r <= ny; ++r)
    for (int c = 0; c <= nx; ++c) {
      const double s = static_cast<double>(c) / nx, t = static_cast<double>(r) / ny;
      p.pattern.emplace_back(c * cell, r * cell);
      p.placed.emplace_back(c * cell, 1 + r * cell, ripple * std::sin(7 * s + 5 * t));
      p.ids.push_back({0, s, t});
    }
  for (int r = 0; r < ny; ++r)
    for (int c = 0; c < nx; ++c) {
      const int a = at(c, r), b = at(c + 1, r), d = at(c, r + 1), e = at(c + 1, r + 1);
      if ((r + c) % 2)
        p.triangles.insert(p.triangles.end(), {Triangle{a, b, d}, Triangle{b, e, d}});
      else
        p.triangles.insert(p.triangles.end(), {Triangle{a, b, e}, Triangle{a, e, d}});
    }
  for (int c = 0; c <= nx; ++c)
    panel.outline.push_back(at(c, 0));
  for (int r = 1; r <= ny; ++r)
    panel.outline.push_back(at(nx, r));
  for (int c = nx - 1; c >= 0; --c)
    panel.outline.push_back(at(c, ny));
  for (int r = ny - 1; r > 0; --r)
    panel.outline.push_back(at(0, r));
  p.panels.push_back(panel);
  return g;
}

} // namespace sloper::garment
