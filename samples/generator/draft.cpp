#include "draft.hpp"
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <sloper/base/error.hpp>
namespace sloper::samples {
namespace {

Vec2 at(const Vec2& a, const std::vector<Vec2>& control, const Vec2& b, double t) {
  const double s = 1 - t;
  if (control.empty())
    return s * a + t * b;
  return s * s * s * a + 3 * s * s * t * control[0] + 3 * s * t * t * control[1] + t * t * t * b;
}

double length_of(const std::vector<Vec2>& points) {
  double sum = 0;
  for (std::size_t i = 1; i < points.size(); ++i)
    sum += (points[i] - points[i - 1]).norm();
  return sum;
}

double cross(const Vec2& a, const Vec2& b) {
  return a.x() * b.y() - a.y() * b.x();
}

bool segments_cross(const Vec2& a, const Vec2& b, const Vec2& c, const Vec2& d) {
  const double s = cross(b - a, c - a), t = cross(b - a, d - a), u = cross(d - c, a - c),
               v = cross(d - c, b - c);
  return s * t < 0 && u * v < 0;
}

bool is_simple(const std::vector<Vec2>& loop) {
  const std::size_t n = loop.size();
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t j = i + 2; j < n; ++j)
      if (!(i == 0 && j + 1 == n) &&
          segments_cross(loop[i], loop[i + 1], loop[j], loop[(j + 1) % n]))
        return false;
  return true;
}

} // namespace

void Draft::sew(const std::string& panel_a, const std::string& edge_a, const std::string& panel_b,
                const std::string& edge_b, double ease, const std::string& kind) {
  seams.push_back({panel_a + "." + edge_a, panel_a, edge_a, panel_b, edge_b, kind, false, ease});
}

void Draft::remove(const std::string& panel) {
  panels.erase(std::remove_if(panels.begin(), panels.end(),
                              [&](const DraftPanel& p) { return p.name == panel; }),
               panels.end());
  seams.erase(
      std::remove_if(seams.begin(), seams.end(),
                     [&](const DraftSeam& s) { return s.panel_a == panel || s.panel_b == panel; }),
      seams.end());
}

const DraftPanel& Draft::panel(const std::string& wanted) const {
  for (const DraftPanel& p : panels)
    if (p.name == wanted)
      return p;
  throw Error(ErrorKind::INTERNAL, "general.internal"_id, "", name, "no panel \"" + wanted + "\"");
}

int edge_index(const DraftPanel& panel, const std::string& edge) {
  for (std::size_t i = 0; i < panel.edges.size(); ++i)
    if (panel.edges[i].name == edge)
      return static_cast<int>(i);
  throw Error(ErrorKind::INTERNAL, "general.internal"_id, "", panel.name,
              "no edge \"" + edge + "\"");
}

std::vector<Vec2> edge_points(const DraftPanel& panel, int edge, int n) {
  const Vec2 &a = panel.points[edge], &b = panel.points[(edge + 1) % panel.points.size()];
  std::vector<Vec2> points;
  for (int i = 0; i <= n; ++i)
    points.push_back(at(a, panel.edges[edge].control, b, static_cast<double>(i) / n));
  return points;
}

double edge_length(const DraftPanel& panel, const std::string& edge) {
  return length_of(edge_points(panel, edge_index(panel, edge), 256));
}

std::vector<Vec2> outline_points(const DraftPanel& panel, int per_edge) {
  std::vector<Vec2> loop;
  for (std::size_t e = 0; e < panel.edges.size(); ++e) {
    const std::vector<Vec2> points =
        edge_points(panel, static_cast<int>(e), panel.edges[e].control.empty() ? 1 : per_edge);
    loop.insert(loop.end(), points.begin(), points.end() - 1);
  }
  return loop;
}

DraftPanel mirrored(const DraftPanel& panel, const std::string& name, const std::string& part) {
  DraftPanel m = panel;
  m.name = name;
  const std::size_t n = panel.points.size();
  const auto flip = [](const Vec2& p) { return Vec2(-p.x(), p.y()); };
  for (std::size_t i = 0; i < n; ++i) {
    // Point i of the mirror is point n - i; edge i then is old edge n - 1 - i, run backwards.
    m.points[i] = flip(panel.points[(n - i) % n]);
    const DraftEdge& old = panel.edges[n - 1 - i];
    m.edges[i] = {old.name, {}};
    for (auto c = old.control.rbegin(); c != old.control.rend(); ++c)
      m.edges[i].control.push_back(flip(*c));
  }
  m.grain = flip(panel.grain);
  m.placement.part = part;
  m.placement.anchor = flip(panel.placement.anchor);
  // Arms and legs have mirrored frames of their own; around the trunk the angle itself turns.
  if (part == panel.placement.part)
    m.placement.theta_deg = -panel.placement.theta_deg;
  return m;
}

void split_edge(DraftPanel& panel, const std::string& edge, double fraction,
                const std::string& first, const std::string& second) {
  const int e = edge_index(panel, edge);
  const Vec2 a = panel.points[e], b = panel.points[(e + 1) % panel.points.size()];
  const std::vector<Vec2> c = panel.edges[e].control;
  DraftEdge one{first, {}}, two{second, {}};
  Vec2 middle = a + fraction * (b - a);
  if (!c.empty()) {
    const std::vector<Vec2> fine = edge_points(panel, e, 512);
    const double want = fraction * length_of(fine);
    double sum = 0, t = 1;
    for (std::size_t i = 1; i < fine.size(); ++i) {
      const double step = (fine[i] - fine[i - 1]).norm();
      if (sum + step >= want) {
        t = (static_cast<double>(i) - 1 + (want - sum) / step) / 512;
        break;
      }
      sum += step;
    }
    const auto mix = [t](const Vec2& p, const Vec2& q) {
      return Vec2(p + t * (q - p));
    }; // de Casteljau
    const Vec2 ac = mix(a, c[0]), cc = mix(c[0], c[1]), cb = mix(c[1], b), acc = mix(ac, cc),
               ccb = mix(cc, cb);
    middle = mix(acc, ccb);
    one.control = {ac, acc};
    two.control = {ccb, cb};
  }
  panel.edges[e] = one;
  panel.edges.insert(panel.edges.begin() + e + 1, two);
  panel.points.insert(panel.points.begin() + e + 1, middle);
}

std::vector<std::string> draft_faults(const Draft& draft) {
  std::vector<std::string> faults;
  for (const DraftPanel& p : draft.panels) {
    const std::vector<Vec2> loop = outline_points(p);
    double area = 0;
    for (std::size_t i = 0; i < loop.size(); ++i)
      area += 0.5 * cross(loop[i], loop[(i + 1) % loop.size()]);
    if (area <= 0)
      faults.push_back(p.name + ": outline runs clockwise");
    if (!is_simple(loop))
      faults.push_back(p.name + ": outline crosses itself");
  }
  for (const DraftSeam& s : draft.seams) {
    const double a = edge_length(draft.panel(s.panel_a), s.edge_a),
                 b = edge_length(draft.panel(s.panel_b), s.edge_b);
    if (std::abs(a / b - 1 - s.ease) > 0.01) {
      char text[160];
      std::snprintf(text, sizeof text, "%s.%s is %.1f mm, %s.%s is %.1f mm", s.panel_a.c_str(),
                    s.edge_a.c_str(), 1000 * a, s.panel_b.c_str(), s.edge_b.c_str(), 1000 * b);
      faults.push_back(text);
    }
  }
  return faults;
}

double solve(double low, double high, const std::function<double(double)>& f) {
  const double f_low = f(low), f_high = f(high);
  if (f_low * f_high > 0)
    return std::abs(f_low) < std::abs(f_high) ? low : high;
  for (int k = 0; k < 60; ++k) {
    const double mid = 0.5 * (low + high);
    (f(mid) * f_low > 0 ? low : high) = mid;
  }
  return 0.5 * (low + high);
}

} // namespace sloper::samples
