#pragma once
#include <sloper/garment/garment.hpp>

namespace sloper::support {

/// One rectangular panel of n x n squares, 0.3 m wide, warp along y; `place` says where a pattern
/// point is.
template<class F> garment::Garment make_sheet(int n, F&& place) {
  garment::Garment g;
  pattern::PanelInfo panel;
  panel.name = "sheet";
  panel.n_vertices = (n + 1) * (n + 1);
  panel.n_triangles = 2 * n * n;
  g.panels.panels.push_back(panel);
  for (int r = 0; r <= n; ++r)
    for (int c = 0; c <= n; ++c) {
      const double s = static_cast<double>(c) / n, t = static_cast<double>(r) / n;
      g.panels.pattern.emplace_back(0.3 * s, 0.3 * t);
      g.panels.ids.push_back({0, s, t});
      g.particle_of.push_back(std::ssize(g.particle_of));
      g.position.push_back(place(g.panels.pattern.back()));
    }
  g.panels.placed = g.position;
  for (int r = 0; r < n; ++r)
    for (int c = 0; c < n; ++c) {
      const int a = r * (n + 1) + c, b = a + 1, d = a + n + 1, e = d + 1;
      g.panels.triangles.push_back({a, b, e});
      g.panels.triangles.push_back({a, e, d});
    }
  return g;
}

inline Vec3 flat(const Vec2& p) {
  return {p.x(), 1 + p.y(), 0};
}

} // namespace sloper::support
