#include <sloper/base/error.hpp>
#include <sloper/render/maps.hpp>

#include <algorithm>
#include <cmath>

namespace sloper::render {

namespace {

constexpr double SAME = 1e-6; // of s and t: the same vertex

/// Triangles of one panel of a garment over (s, t), sorted into the rows and columns of a grid.
class PanelLookup {
public:
  PanelLookup(const garment::Garment& g, int panel) : m_garment(g), m_cells(N * N) {
    const pattern::PanelInfo& info = g.panels.panels[panel];
    for (int f = info.first_triangle; f < info.first_triangle + info.n_triangles; ++f) {
      Vec2 low(1e9, 1e9), high(-1e9, -1e9);
      for (int v : g.panels.triangles[f]) {
        low = low.cwiseMin(at(v));
        high = high.cwiseMax(at(v));
      }
      for (int y = cell(low.y() - REACH); y <= cell(high.y() + REACH); ++y)
        for (int x = cell(low.x() - REACH); x <= cell(high.x() + REACH); ++x)
          m_cells[y * N + x].push_back(f);
    }
  }
  /// The world point at (s, t), or at the nearest place of a triangle next to it.
  bool find(const Vec2& st, Vec3& point) const {
    double best = 2 * REACH;
    bool found = false;
    for (int f : m_cells[cell(st.y()) * N + cell(st.x())]) {
      const Triangle& t = m_garment.panels.triangles[f];
      const Vec2 a = at(t[0]), b = at(t[1]) - a, c = at(t[2]) - a, p = st - a;
      const double area = b.x() * c.y() - c.x() * b.y();
      if (std::abs(area) < 1e-14)
        continue;
      Vec3 w(0, (p.x() * c.y() - c.x() * p.y()) / area, (b.x() * p.y() - p.x() * b.y()) / area);
      w.x() = 1 - w.y() - w.z();
      const Vec3 inside = w.cwiseMax(0.0) / w.cwiseMax(0.0).sum();
      const double off = (a + inside.y() * b + inside.z() * c - st).norm(); // 0 inside
      if (off >= best)
        continue;
      best = off;
      found = true;
      point = Vec3::Zero();
      for (int k = 0; k < 3; ++k)
        point += inside[k] * m_garment.position[m_garment.particle_of[t[k]]];
      if (off < SAME * SAME)
        break;
    }
    return found;
  }

private:
  static constexpr int N = 24;
  static constexpr double REACH = 0.01;
  Vec2 at(int v) const { return {m_garment.panels.ids[v].s, m_garment.panels.ids[v].t}; }
  static int cell(double x) { return std::clamp(static_cast<int>(x * N), 0, N - 1); }
  const garment::Garment& m_garment;
  std::vector<std::vector<int>> m_cells;
};

} // namespace

std::vector<double> drape_difference(const garment::Garment& a, const garment::Garment& b) {
  std::vector<double> result(a.particle_of.size(), NO_VALUE);
  bool common = false;
  for (const pattern::PanelInfo& panel : a.panels.panels) {
    const auto like =
        std::find_if(b.panels.panels.begin(), b.panels.panels.end(),
                     [&](const pattern::PanelInfo& other) { return other.name == panel.name; });
    if (like == b.panels.panels.end())
      continue;
    common = true;
    const PanelLookup lookup(b, static_cast<int>(like - b.panels.panels.begin()));
    for (int v = panel.first_vertex; v < panel.first_vertex + panel.n_vertices; ++v) {
      const int other = like->first_vertex + v - panel.first_vertex;
      const pattern::StableId& id = a.panels.ids[v];
      const Vec3& p = a.position[a.particle_of[v]];
      Vec3 q;
      // Equal meshes keep their order: then no search is needed.
      if (v - panel.first_vertex < like->n_vertices &&
          std::abs(b.panels.ids[other].s - id.s) < SAME &&
          std::abs(b.panels.ids[other].t - id.t) < SAME)
        result[v] = (p - b.position[b.particle_of[other]]).norm();
      else if (lookup.find({id.s, id.t}, q))
        result[v] = (p - q).norm();
    }
  }
  if (!common)
    throw Error(ErrorKind::USAGE, "render.not-two-drapes"_id, "", "--map difference",
                "the two garments have no panel name in common", "give two drapes of one pattern");
  return result;
}

} // namespace sloper::render
