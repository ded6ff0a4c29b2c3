#include "join_panels.hpp"

#include <pattern/seams/seam_sides.hpp>

#include <cmath>

namespace sloper::pattern::fit::detail {
namespace {

std::size_t at(int k) {
  return static_cast<std::size_t>(k);
}

bool says(const std::string& name, const char* word) {
  return name.find(word) != std::string::npos;
}

} // namespace

bool can_join(const Pattern& pattern, const Seam& seam) {
  if (seam.a.size() != 1 || seam.b.size() != 1 || seam.a[0].panel == seam.b[0].panel)
    return false;
  const Panel &a = pattern.panels[at(seam.a[0].panel)], &b = pattern.panels[at(seam.b[0].panel)];
  if (a.loops.size() != 1 || b.loops.size() != 1)
    return false;
  const SeamSide x = measure_side(pattern, seam.a[0].panel, seam.a[0].edge, 1),
                 y = measure_side(pattern, seam.b[0].panel, seam.b[0].edge, 1);
  if (std::abs(x.length - y.length) > 1e-4 || std::abs(x.bulge) > 1e-3 ||
      std::abs(y.bulge) > 1e-3 || x.length < 0.08)
    return false;
  // The outline goes on straight, or nearly, at both ends.
  if (x.corner_start + y.corner_end > 3.6 || x.corner_end + y.corner_start > 3.6)
    return false;
  const bool sleeves = says(a.name, "sleeve") && says(b.name, "sleeve") && x.place.y() > 0.5;
  if (sleeves)
    return true;
  if (!says(a.name, "torso") && !says(a.name, "skirt"))
    return false;
  const auto mirrors = panel_mirrors(pattern);
  for (const PanelMirror& m : mirrors[at(seam.a[0].panel)])
    if (m.panel == seam.b[0].panel &&
        m.image(seam.a[0].edge, static_cast<int>(a.loops[0].size())) == seam.b[0].edge)
      return true;
  return false;
}

void join(Pattern& pattern, std::size_t index) {
  const Seam seam = pattern.seams[index];
  const int p = seam.a[0].panel, q = seam.b[0].panel, e = seam.a[0].edge, f = seam.b[0].edge;
  Panel &a = pattern.panels[at(p)], &b = pattern.panels[at(q)];
  const Path &own = a.edge(e).path, &other = b.edge(f).path;
  const Vec2 start = own.front().p[0], end = own.back().p[3], from = other.back().p[3],
             to = other.front().p[0];
  const double turn = std::atan2((end - start).y(), (end - start).x()) -
                      std::atan2((to - from).y(), (to - from).x());
  const Eigen::Rotation2Dd rotate(turn);
  const auto moved = [&](const Vec2& v) { return Vec2(start + rotate * (v - from)); };
  const bool sleeve = says(a.name, "sleeve");
  const int n = static_cast<int>(a.loops[0].size()), m = static_cast<int>(b.loops[0].size());
  std::vector<PanelEdge> loop;
  for (int k = 1; k < n; ++k)
    loop.push_back(a.loops[0][at((e + k) % n)]);
  for (int k = 1; k < m; ++k) {
    PanelEdge edge = b.loops[0][at((f + k) % m)];
    for (Segment& s : edge.path)
      for (Vec2& v : s.p)
        v = moved(v);
    loop.push_back(std::move(edge));
  }
  if (sleeve) { // towards the shoulder: the wider end
    const auto width = [&](const Vec2& v) {
      double w = 0;
      for (const PanelEdge& g : loop)
        if ((g.path.front().p[0] - v).norm() < 0.6 * (end - start).norm())
          w = std::max(w, (g.path.front().p[0] - v).norm());
      return w;
    };
    a.grain = (end - start).normalized() * (width(end) > width(start) ? 1 : -1);
  }
  a.loops[0] = std::move(loop);
  pattern.seams.erase(pattern.seams.begin() + static_cast<long>(index));
  for (Seam& s : pattern.seams)
    for (auto* side : {&s.a, &s.b})
      for (Run& run : *side) {
        if (run.panel == p)
          run.edge = (run.edge - e - 1 + n) % n;
        else if (run.panel == q) {
          run.panel = p;
          run.edge = n - 1 + (run.edge - f - 1 + m) % m;
        }
        if (run.panel > q)
          --run.panel;
      }
  pattern.panels.erase(pattern.panels.begin() + q);
}

} // namespace sloper::pattern::fit::detail
