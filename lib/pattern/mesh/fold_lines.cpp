#include <pattern/mesh/roll_lines.hpp>
#include <sloper/base/error.hpp>
#include <sloper/pattern/mesh/fold_lines.hpp>
#include <sloper/pattern/mesh/folds.hpp>

#include <algorithm>
#include <cmath>

namespace sloper::pattern {

namespace {

constexpr double SAMPLE = 0.001;    // m between the points by which a path is known
constexpr int LEAST_SAMPLES = 16;   // of a path, however short
constexpr int MOST_SAMPLES = 2000;  // of a path, however long
constexpr int HALVINGS = 20;        // of a sample, to where the path crosses the outline: 1 nm
constexpr int SIDE_SAMPLES = 16;    // of a sewn run, to see on which side of a line it is
constexpr double LEAST_LINE = 0.01; // m: shorter stretches on the panel are none

std::vector<Vec2> sampled(const ArcLength& arc) {
  const int n = static_cast<int>(
      std::clamp(arc.length() / SAMPLE, double(LEAST_SAMPLES), double(MOST_SAMPLES)));
  std::vector<Vec2> points;
  for (int k = 0; k <= n; ++k)
    points.push_back(arc.at(arc.length() * k / n));
  return points;
}

/// Outer loop as a closed line.
std::vector<Vec2> outline_of(const Panel& panel) {
  std::vector<Vec2> out;
  for (const PanelEdge& edge : panel.loops[0]) {
    const ArcLength arc(edge.path);
    const std::vector<Vec2> points = sampled(arc);
    out.insert(out.end(), points.begin(), points.end() - 1);
  }
  return out;
}

bool is_inside(const std::vector<Vec2>& loop, const Vec2& p) {
  bool inside = false;
  for (std::size_t i = 0, j = loop.size() - 1; i < loop.size(); j = i++) {
    const Vec2 &a = loop[i], &b = loop[j];
    const bool spans = (a.y() > p.y()) != (b.y() > p.y());
    if (spans && p.x() < (b.x() - a.x()) * (p.y() - a.y()) / (b.y() - a.y()) + a.x())
      inside = !inside;
  }
  return inside;
}

/// Where between an arc length inside the loop and one outside of it the loop is crossed.
double crossing(const ArcLength& arc, const std::vector<Vec2>& loop, double in, double out) {
  for (int k = 0; k < HALVINGS; ++k) {
    const double middle = 0.5 * (in + out);
    (is_inside(loop, arc.at(middle)) ? in : out) = middle;
  }
  return in;
}

/// Stretches of arc length on the panel, in order.
std::vector<std::array<double, 2>> stretches_inside(const ArcLength& arc,
                                                    const std::vector<Vec2>& loop) {
  const auto n = static_cast<int>(sampled(arc).size()) - 1;
  std::vector<std::array<double, 2>> out;
  double before = 0;
  bool was_inside = false;
  for (int k = 0; k <= n; ++k) {
    const double s = arc.length() * k / n;
    const bool inside = is_inside(loop, arc.at(s));
    if (inside && !was_inside)
      out.push_back({k == 0 ? 0 : crossing(arc, loop, s, before), s});
    if (was_inside)
      out.back()[1] = inside ? s : crossing(arc, loop, before, s);
    was_inside = inside;
    before = s;
  }
  out.erase(std::remove_if(out.begin(), out.end(),
                           [](const auto& s) { return s[1] - s[0] < LEAST_LINE; }),
            out.end());
  return out;
}

/// Moves an end of a path by a little.
void move_end(Path& path, bool last, const Vec2& to) {
  Segment& s = last ? path.back() : path.front();
  s.p[last ? 3 : 0] = to;
  if (s.line)
    s = Segment::straight(s.p[0], s.p[3]);
}

} // namespace

Path curve_through(const std::vector<Vec2>& points) {
  const std::size_t n = points.size();
  if (n == 2)
    return {Segment::straight(points[0], points[1])};
  std::vector<double> step;
  for (std::size_t k = 0; k + 1 < n; ++k)
    step.push_back((points[k + 1] - points[k]).norm());
  const auto slope = [&](std::size_t k) { return Vec2((points[k + 1] - points[k]) / step[k]); };
  std::vector<Vec2> tangent(n);
  for (std::size_t k = 1; k + 1 < n; ++k)
    tangent[k] = (step[k] * slope(k - 1) + step[k - 1] * slope(k)) / (step[k - 1] + step[k]);
  tangent[0] = 2 * slope(0) - tangent[1];
  tangent[n - 1] = 2 * slope(n - 2) - tangent[n - 2];
  Path path;
  for (std::size_t k = 0; k + 1 < n; ++k)
    path.push_back(Segment::cubic(points[k], points[k] + step[k] / 3 * tangent[k],
                                  points[k + 1] - step[k] / 3 * tangent[k + 1], points[k + 1]));
  return path;
}

Path on_panel(const Panel& panel, const Path& path, double snap_m, const std::string& file,
              const std::string& place) {
  const std::vector<Vec2> loop = outline_of(panel);
  const ArcLength arc(path);
  const std::vector<std::array<double, 2>> inside = stretches_inside(arc, loop);
  if (inside.empty())
    throw input_error("scene.fold-off-panel"_id, file, place, "misses panel " + panel.name,
                      "give places on its cloth; of a curved panel, places to go through (via)");
  if (inside.size() > 1)
    throw input_error("scene.fold-off-panel"_id, file, place,
                      "leaves panel " + panel.name + " for " +
                          centimetres(inside[1][0] - inside[0][1]) + " and comes back",
                      "give places to go through (via)");
  Path out = arc.between(inside[0][0], inside[0][1]);
  const bool ends_at_outline[] = {inside[0][0] > 0, inside[0][1] < arc.length()};
  for (const bool last : {false, true}) {
    const Vec2 end = last ? out.back().p[3] : out.front().p[0];
    if (!ends_at_outline[last] && on_outline(panel, end).edge < 0)
      continue;
    for (const PanelEdge& edge : panel.loops[0])
      if ((edge.path.front().p[0] - end).norm() < snap_m)
        move_end(out, last, edge.path.front().p[0]);
  }
  return out;
}

InnerLine roll_line(const Pattern& pattern, int panel, const std::string& name, const Path& path) {
  InnerLine line{name, "roll", path};
  Panel alone = pattern.panels[panel];
  alone.lines = {line};
  const RollLines rolls(alone);
  double left = 0, right = 0; // m of sewn outline
  for (const Seam& seam : pattern.seams)
    for (const auto* side : {&seam.a, &seam.b})
      for (const Run& run : *side) {
        if (run.panel != panel)
          continue;
        const ArcLength arc(alone.edge(run.edge).path);
        for (int k = 0; k < SIDE_SAMPLES; ++k) {
          const double at = run.from + (run.to - run.from) * (k + 0.5) / SIDE_SAMPLES;
          const double of = std::abs(run.to - run.from) * arc.length() / SIDE_SAMPLES;
          (rolls.across(arc.at(at * arc.length())).first > 0 ? left : right) += of;
        }
      }
  if (left > right)
    line.path = reversed(line.path);
  return line;
}

} // namespace sloper::pattern
