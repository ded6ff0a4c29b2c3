#include <garment/scene/fold_edges.hpp>
#include <garment/scene/panel_runs.hpp>
#include <sloper/pattern/mesh/fold_lines.hpp>
#include <sloper/pattern/mesh/folds.hpp>

#include <algorithm>
#include <cmath>

namespace sloper::garment {

namespace {

constexpr double NEARLY_ALL = 0.8; // of a line on the cloth: its ends may lie between vertices
constexpr double BESIDE = 0.75;    // edge lengths from the outline: nearer, lines get no vertices
constexpr double SAMPLE = 0.002;   // m between places that are looked at on the cloth
constexpr double ON_CLOTH = -1e-6; // least barycentric weight of a place in a triangle
constexpr double NO_AREA = 1e-18;  // of a triangle, m2

/// Weights of p in a triangle.
Vec3 weights_in(const std::array<Vec2, 3>& t, const Vec2& p) {
  const Vec2 e = t[1] - t[0], f = t[2] - t[0], d = p - t[0];
  const double area = e.x() * f.y() - e.y() * f.x();
  if (std::abs(area) < NO_AREA)
    return Vec3::Constant(-1e300);
  const double v = (d.x() * f.y() - d.y() * f.x()) / area,
               w = (e.x() * d.y() - e.y() * d.x()) / area;
  return {1 - v - w, v, w};
}

/// The triangle of a panel that p lies in, or that it is the least outside of.
/// @param corner  place of a vertex, in the coordinates of p
template<class Corner>
std::pair<int, Vec3> triangle_at(const Garment& garment, const pattern::PanelInfo& panel,
                                 const Vec2& p, Corner corner) {
  std::pair<int, Vec3> best{panel.first_triangle, Vec3::Constant(-1e300)};
  for (int f = panel.first_triangle; f < panel.first_triangle + panel.n_triangles; ++f) {
    const Triangle& t = garment.panels.triangles[f];
    const Vec3 w = weights_in({corner(t[0]), corner(t[1]), corner(t[2])}, p);
    if (w.minCoeff() > best.second.minCoeff())
      best = {f, w};
  }
  return best;
}

/// Pattern coordinates of a place by (s, t), which of an edited panel is no longer linear.
Vec2 pattern_place(const Garment& garment, const pattern::PanelInfo& panel, const Vec2& at) {
  const auto [f, w] = triangle_at(garment, panel, at, [&](int v) {
    return Vec2(garment.panels.ids[v].s, garment.panels.ids[v].t);
  });
  Vec2 place = Vec2::Zero();
  for (int k = 0; k < 3; ++k)
    place += w[k] * garment.panels.pattern[garment.panels.triangles[f][k]];
  return place;
}

/// Distance of p from the panel's outline, m.
double from_outline(const Garment& garment, const pattern::PanelInfo& panel, const Vec2& p) {
  double least = 1e300;
  for (std::size_t k = 0; k < panel.outline.size(); ++k) {
    const Vec2& a = garment.panels.pattern[panel.outline[k]];
    const Vec2 d = garment.panels.pattern[panel.outline[(k + 1) % panel.outline.size()]] - a;
    const double s = std::clamp((p - a).dot(d) / d.squaredNorm(), 0.0, 1.0);
    least = std::min(least, (a + s * d - p).norm());
  }
  return least;
}

/// How much of a path runs over the panel's triangles, away from its outline, m.
double length_on_cloth(const Garment& garment, const pattern::PanelInfo& panel,
                       const pattern::Path& path) {
  const pattern::ArcLength arc(path);
  const int n = static_cast<int>(std::ceil(arc.length() / SAMPLE));
  int inside = 0;
  for (int k = 0; k < n; ++k) {
    const Vec2 p = arc.at(arc.length() * (k + 0.5) / n);
    const auto [f, w] =
        triangle_at(garment, panel, p, [&](int v) { return garment.panels.pattern[v]; });
    inside += w.minCoeff() >= ON_CLOTH &&
              from_outline(garment, panel, p) > BESIDE * garment.panels.edge_length;
  }
  return n > 0 ? arc.length() * inside / n : 0;
}

} // namespace

pattern::Path fold_path(const Garment& garment, const SceneCrease& crease) {
  const pattern::PanelInfo& panel = panel_named(garment, crease.run.panel);
  std::vector<Vec2> points{pattern_place(garment, panel, crease.run.from)};
  for (const Vec2& place : crease.via)
    points.push_back(pattern_place(garment, panel, place));
  points.push_back(pattern_place(garment, panel, crease.run.to));
  return pattern::curve_through(points);
}

bool is_meshed(const Garment& garment, const SceneCrease& crease) {
  const pattern::PanelInfo& panel = panel_named(garment, crease.run.panel);
  const pattern::Path path = fold_path(garment, crease);
  double meshed = 0;
  for (const auto& [a, b] : pattern::edges_along(garment.panels, panel, path))
    meshed += (garment.panels.pattern[a] - garment.panels.pattern[b]).norm();
  return meshed > 0 && meshed >= NEARLY_ALL * length_on_cloth(garment, panel, path);
}

std::vector<std::array<int, 2>> fold_edges(const Garment& garment, const SceneCrease& crease) {
  std::vector<std::array<int, 2>> out;
  const auto add = [&](int a, int b) { out.push_back({std::min(a, b), std::max(a, b)}); };
  if (is_meshed(garment, crease)) {
    const pattern::PanelInfo& panel = panel_named(garment, crease.run.panel);
    for (const auto& [a, b] :
         pattern::edges_along(garment.panels, panel, fold_path(garment, crease)))
      add(particle_at(garment, a), particle_at(garment, b));
  } else {
    std::vector<Vec2> places{crease.run.from};
    places.insert(places.end(), crease.via.begin(), crease.via.end());
    places.push_back(crease.run.to);
    for (std::size_t k = 0; k + 1 < places.size(); ++k) {
      const std::vector<int> run =
          fold_particles(garment, {crease.run.panel, places[k], places[k + 1]});
      for (std::size_t i = 0; i + 1 < run.size(); ++i)
        add(run[i], run[i + 1]);
    }
  }
  std::sort(out.begin(), out.end());
  out.erase(std::unique(out.begin(), out.end()), out.end());
  return out;
}

} // namespace sloper::garment
