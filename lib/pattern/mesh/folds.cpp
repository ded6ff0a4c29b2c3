#include <pattern/edit/edit_tools.hpp>
#include <pattern/mesh/roll_lines.hpp>
#include <pattern/panel_words.hpp>
#include <sloper/base/error.hpp>
#include <sloper/base/units.hpp>
#include <sloper/pattern/mesh/folds.hpp>

#include <algorithm>
#include <cmath>

namespace sloper::pattern {
namespace {

constexpr double LAYER_DEPTH = 0.003; // m between the layers of a pleat at the start
constexpr double ROLL_DEPTH = 0.008;  // m by which a turned lapel starts over what it lies on
constexpr double ROLL_WIDTH = 0.012;  // m beside the roll line within which it gets there
// Degrees between a turned lapel, or a collar's leaf, and what it is turned over, at the start:
// seams close under it. A leaf nearer to its stand ended beneath the fronts, which come from
// outside.
constexpr double LAPEL_STANDS_OFF = 30, LEAF_STANDS_OFF = 80;
constexpr int OUTLINE_SAMPLES = 16; // of an edge, to see on which side of a roll line it is
constexpr double NEARLY =
    0.97; // of the distance from fold to target: both folds of a box pleat must not touch

constexpr double ROWS_BEYOND = 2; // of triangles beyond a roll line: a single one cannot lie flat
constexpr double MOST_TIMES_FINER = 8; // than usual are the edges of a panel with roll lines

/// A pleat on one edge: fractions of its length.
struct Stretch {
  const Pleat* pleat;
  int edge;
  double target, middle, fold, beyond;
};

[[noreturn]] void fail(MessageId id, const std::string& file, const Panel& panel,
                       const Pleat& pleat, const std::string& fact, const std::string& next) {
  throw input_error(id, file, panel.name + ": pleat " + pleat.name, fact, next);
}

/// Where a line ends on an edge, or a negative number.
double end_on(const Panel& panel, const InnerLine& line, int edge) {
  for (const Vec2& end : {line.path.front().p[0], line.path.back().p[3]})
    if (const OnOutline on = on_outline(panel, end); on.edge == edge)
      return on.at;
  return -1;
}

Stretch stretch_of(const Panel& panel, const Pleat& pleat, int edge, const std::string& file) {
  const InnerLine &fold = panel.lines[pleat.fold], &target = panel.lines[pleat.target];
  const double f = end_on(panel, fold, edge), t = end_on(panel, target, edge),
               length = pattern::length(panel.edge(edge).path);
  for (const auto& [at, line] : {std::pair(f, &fold), std::pair(t, &target)})
    if (at < 0)
      fail("pleat.line-off-edge"_id, file, panel, pleat,
           "line " + line->name + " does not end on edge " + panel.edge(edge).name,
           "draw it to within 0.20 cm of the edge");
  if (std::abs(f - t) * length < 2 * LINE_ON_EDGE)
    fail("pleat.does-not-fit"_id, file, panel, pleat,
         "it is " + centimetres(std::abs(f - t) * length) + " wide", "draw its lines apart");
  const Stretch out{&pleat, edge, t, 0.5 * (f + t), f, f + 0.5 * (f - t)};
  if (out.beyond < 0 || out.beyond > 1)
    fail("pleat.does-not-fit"_id, file, panel, pleat,
         "its upper layer reaches " + centimetres(std::max(-out.beyond, out.beyond - 1) * length) +
             " past the end of edge " + panel.edge(edge).name,
         "fold less, or move it inwards");
  return out;
}

/// No cloth lies in two pleats.
void check_apart(const Panel& panel, const std::vector<Stretch>& stretches,
                 const std::string& file) {
  for (std::size_t i = 0; i < stretches.size(); ++i)
    for (std::size_t j = i + 1; j < stretches.size(); ++j) {
      const Stretch &a = stretches[i], &b = stretches[j];
      if (a.edge != b.edge)
        continue;
      const double overlap = std::min(std::max(a.target, a.beyond), std::max(b.target, b.beyond)) -
                             std::max(std::min(a.target, a.beyond), std::min(b.target, b.beyond));
      const double metres = overlap * pattern::length(panel.edge(a.edge).path);
      if (metres > 1e-4)
        fail("pleat.does-not-fit"_id, file, panel, *b.pleat,
             "overlaps pleat " + a.pleat->name + " by " + centimetres(metres) + " on edge " +
                 panel.edge(a.edge).name,
             "a pleat takes one and a half times the distance of its lines");
    }
}

/// The line halfway between two, both sampled evenly and walked in the same direction.
Path halfway(const Path& a, const Path& b) {
  const ArcLength one(a), two(b);
  const bool turned = (one.at(0) - two.at(0)).squaredNorm() +
                          (one.at(one.length()) - two.at(two.length())).squaredNorm() >
                      (one.at(0) - two.at(two.length())).squaredNorm() +
                          (one.at(one.length()) - two.at(0)).squaredNorm();
  const auto at = [&](double f) {
    return Vec2(0.5 * (one.at(f * one.length()) + two.at((turned ? 1 - f : f) * two.length())));
  };
  return {Segment::straight(at(0), at(1))};
}

/// A leaf turned over on its seam: a mirror image without stretch, across the seam's chord.
void turn_over_whole(const Panel& panel, const PanelMesh& mesh, const PanelInfo& info,
                     Folding& out) {
  const auto roll = std::find_if(panel.lines.begin(), panel.lines.end(),
                                 [](const InnerLine& line) { return line.kind == "roll"; });
  const Vec2 from = roll->path.front().p[0], along = roll->path.back().p[3] - from;
  for (int v = info.first_vertex; v < info.first_vertex + info.n_vertices; ++v) {
    const Vec2 x = mesh.pattern[v];
    out.shift[v] += 2 * (from + (x - from).dot(along) / along.squaredNorm() * along - x);
  }
}

/// Turns the cloth of a panel over its roll lines.
void turn_over(const RollLines& rolls, double stands_off, const PanelMesh& mesh,
               const PanelInfo& info, Folding& out) {
  for (int v = info.first_vertex; v < info.first_vertex + info.n_vertices; ++v) {
    const Vec2 x = mesh.pattern[v];
    const auto [beyond, image] = rolls.across(x);
    if (!(beyond > 0))
      continue;
    const double t = std::min(beyond / ROLL_WIDTH, 1.0), off = units::radians(stands_off);
    const Vec2 foot = 0.5 * (x + image);
    out.shift[v] += foot + std::cos(off) * (image - foot) - x;
    out.depth[v] -= ROLL_DEPTH * t * (2 - t) + std::sin(off) * beyond;
  }
}

/// Places along the outer loop.
std::vector<Vec2> outline_samples(const Panel& panel) {
  std::vector<Vec2> out;
  for (const PanelEdge& edge : panel.loops[0]) {
    const ArcLength arc(edge.path);
    for (int k = 0; k < OUTLINE_SAMPLES; ++k)
      out.push_back(arc.at(arc.length() * k / OUTLINE_SAMPLES));
  }
  return out;
}

/// Of a path from a closed line, m: half of it is farther. Its ends may lie on the line.
double median_distance(const Path& path, const std::vector<Vec2>& closed) {
  const ArcLength arc(path);
  std::vector<double> distances;
  for (int k = 0; k <= OUTLINE_SAMPLES; ++k) {
    const Vec2 p = arc.at(arc.length() * k / OUTLINE_SAMPLES);
    double least = 1e300;
    for (std::size_t i = 0; i < closed.size(); ++i) {
      const Vec2 a = closed[i], along = closed[(i + 1) % closed.size()] - a;
      const double t =
          std::clamp((p - a).dot(along) / std::max(along.squaredNorm(), 1e-18), 0.0, 1.0);
      least = std::min(least, (a + t * along - p).norm());
    }
    distances.push_back(least);
  }
  std::nth_element(distances.begin(), distances.begin() + OUTLINE_SAMPLES / 2, distances.end());
  return distances[OUTLINE_SAMPLES / 2];
}

void fold_panel(Pattern& pattern, int p, const std::string& file) {
  Panel& panel = pattern.panels[p];
  panel.lines.erase(std::remove_if(panel.lines.begin(), panel.lines.end(),
                                   [](const InnerLine& l) { return l.kind == "tape"; }),
                    panel.lines.end());
  std::vector<Stretch> stretches;
  for (const Pleat& pleat : panel.pleats)
    for (int edge : pleat.edges)
      stretches.push_back(stretch_of(panel, pleat, edge, file));
  check_apart(panel, stretches, file);
  std::vector<InnerLine> middles;
  for (const Pleat& pleat : panel.pleats)
    middles.push_back({pleat.name + "-middle", "fold",
                       halfway(panel.lines[pleat.fold].path, panel.lines[pleat.target].path)});
  panel.lines.insert(panel.lines.end(), middles.begin(), middles.end());
  std::vector<std::pair<int, double>> places;
  for (InnerLine& line : panel.lines)
    for (const bool last : {false, true}) {
      Vec2& end = last ? line.path.back().p[3] : line.path.front().p[0];
      const OnOutline on = on_outline(panel, end);
      if (on.edge < 0)
        continue;
      double at = on.at; // a pleat's middle lies halfway along the edge
      for (const Stretch& s : stretches)
        if (s.edge == on.edge &&
            std::abs(at - s.middle) * length(panel.edge(on.edge).path) < LINE_ON_EDGE)
          at = s.middle;
      const ArcLength arc(panel.edge(on.edge).path);
      end = arc.at(at * arc.length());
      Segment& s = last ? line.path.back() : line.path.front();
      if (s.line)
        s = Segment::straight(s.p[0], s.p[3]);
      places.push_back({on.edge, at});
    }
  for (const Stretch& s : stretches)
    places.push_back({s.edge, s.beyond});
  const std::vector<Pleat> pleats = panel.pleats; // the stretches point to these from here on
  for (Stretch& s : stretches)
    s.pleat = &pleats[s.pleat - panel.pleats.data()];
  const std::vector<Origin> origin = cut_edges(pattern, p, places);
  // What lies under a pleat leaves the seams that were there.
  const auto pieces = [&](const Stretch& s, double from, double to) {
    std::vector<Run> out;
    for (std::size_t e = 0; e < origin.size(); ++e)
      if (origin[e].edge == s.edge && origin[e].from > std::min(from, to) - 1e-6 &&
          origin[e].to < std::max(from, to) + 1e-6)
        out.push_back({p, static_cast<int>(e), from < to ? 0.0 : 1.0, from < to ? 1.0 : 0.0});
    if (from > to)
      std::reverse(out.begin(), out.end());
    return out;
  };
  for (const Stretch& s : stretches) {
    const std::vector<Run> hidden = pieces(s, s.target, s.fold);
    for (Seam& seam : pattern.seams)
      for (auto* side : {&seam.a, &seam.b}) {
        if (seam.kind == "pleat")
          continue;
        side->erase(std::remove_if(side->begin(), side->end(),
                                   [&](const Run& r) {
                                     return std::any_of(
                                         hidden.begin(), hidden.end(), [&](const Run& h) {
                                           return h.panel == r.panel && h.edge == r.edge;
                                         });
                                   }),
                    side->end());
        if (side->empty())
          throw input_error("pleat.does-not-fit"_id, file, "seam " + seam.name,
                            "pleat " + s.pleat->name + " covers all of one side of the seam",
                            "sew the upper layer");
      }
    const std::vector<Run> under = pieces(s, s.target, s.middle),
                           back = pieces(s, s.fold, s.middle), upper = pieces(s, s.fold, s.beyond);
    for (const auto* side : {&under, &back, &upper})
      if (side->size() != 1)
        throw input_error("pleat.does-not-fit"_id, file,
                          pattern.panels[p].name + ": pleat " + s.pleat->name,
                          "another line ends between its lines",
                          "move the end of that line off the cloth of the pleat");
    pattern.seams.push_back({s.pleat->name + "-under", "pleat", under, upper, ""});
    pattern.seams.push_back({s.pleat->name + "-back", "pleat", back, upper, ""});
  }
}

} // namespace

OnOutline on_outline(const Panel& panel, const Vec2& p) {
  OnOutline best;
  double least = LINE_ON_EDGE;
  for (std::size_t e = 0; e < panel.loops[0].size(); ++e) {
    const ArcLength arc(panel.loops[0][e].path);
    const int n = static_cast<int>(std::max(16.0, std::min(2000.0, arc.length() / 0.001)));
    for (int k = 0; k < n; ++k) { // on the chord between two points of the curve
      const Vec2 a = arc.at(arc.length() * k / n), along = arc.at(arc.length() * (k + 1) / n) - a;
      const double t = along.squaredNorm() > 0
                           ? std::clamp((p - a).dot(along) / along.squaredNorm(), 0.0, 1.0)
                           : 0.0;
      if (const double d = (p - a - t * along).norm(); d < least) {
        least = d;
        best = {static_cast<int>(e), (k + t) / n};
      }
    }
  }
  return best;
}

Pattern with_folds(const Pattern& pattern, const std::string& file) {
  Pattern out = pattern;
  for (std::size_t p = 0; p < out.panels.size(); ++p)
    if (!out.panels[p].lines.empty())
      fold_panel(out, static_cast<int>(p), file);
  return out;
}

/// Layers that a pleat lays over the one below it, at `s` across the pleat: 0 at the line that it
/// is folded to, 1 at the fold.
static double layers_above(double s) {
  if (s < -0.5 || s > 1)
    return 0;
  if (s < 0)
    return 4 * (0.5 + s);
  return s < 0.5 ? 2 + 2 * s : 6 * (1 - s); // 3 in the middle
}

Folding fold_panels(const Pattern& pattern, const PanelMesh& mesh) {
  Folding out;
  for (std::size_t p = 0; p < pattern.panels.size(); ++p) {
    const Panel& panel = pattern.panels[p];
    const RollLines rolls(panel);
    if (out.shift.empty() && (!panel.pleats.empty() || !rolls.empty())) {
      out.shift.assign(mesh.pattern.size(), Vec2::Zero());
      out.depth.assign(mesh.pattern.size(), 0);
    }
    if (turned_whole(panel))
      turn_over_whole(panel, mesh, mesh.panels[p], out);
    else if (!rolls.empty()) {
      const bool collar = panel.hint.part == "neck" || says_neck(words_of(pattern, p));
      turn_over(rolls, collar ? LEAF_STANDS_OFF : LAPEL_STANDS_OFF, mesh, mesh.panels[p], out);
    }
    for (const Pleat& pleat : panel.pleats) {
      const Path &fold = panel.lines[pleat.fold].path, &target = panel.lines[pleat.target].path;
      const Vec2 f0 = fold.front().p[0], f1 = fold.back().p[3];
      Vec2 t0 = target.front().p[0], t1 = target.back().p[3];
      if ((f1 - f0).dot(t1 - t0) < 0)
        std::swap(t0, t1);
      const PanelInfo& info = mesh.panels[p];
      for (int v = info.first_vertex; v < info.first_vertex + info.n_vertices; ++v) {
        const Vec2 x = mesh.pattern[v];
        const double along = std::clamp((x - f0).dot(f1 - f0) / (f1 - f0).squaredNorm(), 0.0, 1.0);
        const Vec2 f = f0 + along * (f1 - f0), t = t0 + along * (t1 - t0), across = f - t;
        const double s = (x - t).dot(across) / across.squaredNorm();
        out.shift[v] -= NEARLY * (s < 0.5 ? 0.0 : std::min(2 * s - 1, 1.0)) * across;
        out.depth[v] = std::max(out.depth[v], LAYER_DEPTH * layers_above(s));
      }
    }
  }
  return out;
}

bool turned_whole(const Panel& panel) {
  const RollLines rolls(panel);
  if (rolls.empty())
    return false;
  for (const Vec2& x : outline_samples(panel))
    if (rolls.across(x).first < -LINE_ON_EDGE)
      return false;
  return true;
}

double edge_length_for_rolls(const Panel& panel, double usual) {
  if (turned_whole(panel))
    return usual;
  const std::vector<Vec2> outline = outline_samples(panel);
  double length = usual;
  for (const InnerLine& line : panel.lines) {
    if (line.kind != "roll")
      continue;
    Panel alone = panel;
    alone.lines = {line};
    const RollLines roll(alone);
    double beyond = 0;
    for (const Vec2& x : outline)
      beyond = std::max(beyond, roll.across(x).first);
    length = std::min({length, beyond / ROWS_BEYOND, median_distance(line.path, outline)});
  }
  return std::max(length, usual / MOST_TIMES_FINER);
}

std::vector<std::array<int, 2>> edges_along(const PanelMesh& mesh, const PanelInfo& panel,
                                            const Path& path) {
  const ArcLength arc(path);
  const int n = static_cast<int>(std::max(16.0, std::min(2000.0, arc.length() / 0.001)));
  std::vector<Vec2> points;
  for (int k = 0; k <= n; ++k)
    points.push_back(arc.at(arc.length() * k / n));
  std::vector<char> on(static_cast<std::size_t>(panel.n_vertices), 0);
  for (std::size_t v = 0; v < on.size(); ++v) {
    const Vec2& x = mesh.pattern[static_cast<std::size_t>(panel.first_vertex) + v];
    for (std::size_t i = 0; i + 1 < points.size() && !on[v]; ++i) {
      const Vec2 d = points[i + 1] - points[i];
      const double s = std::clamp((x - points[i]).dot(d) / d.squaredNorm(), 0.0, 1.0);
      on[v] = (x - points[i] - s * d).norm() < LINE_ON_EDGE;
    }
  }
  std::vector<std::array<int, 2>> out;
  for (int f = panel.first_triangle; f < panel.first_triangle + panel.n_triangles; ++f)
    for (std::size_t k = 0; k < 3; ++k) {
      const Triangle& t = mesh.triangles[f];
      const int a = std::min(t[k], t[(k + 1) % 3]), b = std::max(t[k], t[(k + 1) % 3]);
      if (on[a - panel.first_vertex] && on[b - panel.first_vertex])
        out.push_back({a, b});
    }
  std::sort(out.begin(), out.end());
  out.erase(std::unique(out.begin(), out.end()), out.end());
  return out;
}

std::vector<std::array<int, 2>> pleat_edges(const PanelMesh& mesh) {
  std::vector<std::array<int, 2>> out;
  for (std::size_t p = 0;
       mesh.source && p < std::min(mesh.panels.size(), mesh.source->panels.size()); ++p) {
    const Panel& panel = mesh.source->panels[p];
    const PanelInfo& info = mesh.panels[p];
    std::vector<Path> lines;
    for (const InnerLine& line : panel.lines)
      if (line.kind == "roll")
        lines.push_back(line.path);
    for (const Pleat& pleat : panel.pleats) {
      lines.push_back(panel.lines[pleat.fold].path);
      lines.push_back(halfway(lines.back(), panel.lines[pleat.target].path));
    }
    for (const Path& line : lines) {
      const std::vector<std::array<int, 2>> edges = edges_along(mesh, info, line);
      out.insert(out.end(), edges.begin(), edges.end());
    }
  }
  std::sort(out.begin(), out.end());
  out.erase(std::unique(out.begin(), out.end()), out.end());
  return out;
}

std::vector<std::array<double, 3>> tape_scales(const PanelMesh& mesh) {
  std::vector<std::array<double, 3>> out;
  if (!mesh.source)
    return out;
  for (std::size_t p = 0; p < std::min(mesh.panels.size(), mesh.source->panels.size()); ++p)
    for (const InnerLine& tape : mesh.source->panels[p].lines) {
      if (tape.kind != "tape")
        continue;
      if (out.empty())
        out.assign(mesh.triangles.size(), {1, 1, 1});
      const ArcLength arc(tape.path);
      const int n = std::max(8, static_cast<int>(std::ceil(arc.length() / 0.004)));
      std::vector<Vec2> points;
      for (int k = 0; k <= n; ++k)
        points.push_back(arc.at(arc.length() * k / n));
      const double reach =
          0.5 * std::max(tape.width, 1.2 * mesh.edge_length); // a row of triangles at least
      const PanelInfo& info = mesh.panels[p];
      for (int f = info.first_triangle; f < info.first_triangle + info.n_triangles; ++f)
        for (std::size_t k = 0; k < 3; ++k) {
          const Triangle& t = mesh.triangles[f];
          const Vec2 &a = mesh.pattern[t[k]], &b = mesh.pattern[t[(k + 1) % 3]];
          const Vec2 middle = 0.5 * (a + b);
          double least = reach;
          Vec2 along = Vec2::Zero();
          for (std::size_t i = 0; i + 1 < points.size(); ++i) {
            const Vec2 d = points[i + 1] - points[i];
            const double s = std::clamp((middle - points[i]).dot(d) / d.squaredNorm(), 0.0, 1.0),
                         off = (middle - points[i] - s * d).norm();
            if (off < least) {
              least = off;
              along = d.normalized();
            }
          }
          if (along.squaredNorm() > 0) // a stretch by `factor` along the tape, none across it
            out[f][k] *= std::sqrt(1 + (tape.factor * tape.factor - 1) *
                                           std::pow((b - a).normalized().dot(along), 2));
        }
    }
  return out;
}

} // namespace sloper::pattern
