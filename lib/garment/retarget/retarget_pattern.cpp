#include <sloper/garment/retarget/retarget_pattern.hpp>

#include <garment/retarget/drawn_pattern.hpp>
#include <sloper/base/units.hpp>

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace sloper::garment {

namespace {

constexpr double CORNER = 25 * units::PI / 180; // rad, of the outline at one mesh point

/// Outline of one panel with the points at which its edges end.
struct EdgedOutline {
  std::vector<int> vertices;    ///< counter-clockwise
  std::map<int, int> position;  ///< of a vertex in `vertices`
  std::vector<char> ends;       ///< by position: an edge ends here
  std::vector<int> edge_starts; ///< positions, ascending, first one may be > 0
  int n() const { return static_cast<int>(vertices.size()); }
  int next(int i, int step) const { return (i + step + n()) % n(); }
  /// +1 or -1 where b follows a on the outline, else 0.
  int step(int a, int b) const {
    const auto at = position.find(a), to = position.find(b);
    if (at == position.end() || to == position.end())
      return 0;
    if (next(at->second, 1) == to->second)
      return 1;
    return next(at->second, -1) == to->second ? -1 : 0;
  }
};

/// A stretch of a seam side that follows one panel's outline.
struct OutlineStretch {
  int panel, first, last, step; ///< vertices at its ends, direction
};

int panel_at(const Garment& garment, int vertex) {
  for (std::size_t k = 0; k < garment.panels.panels.size(); ++k) {
    const pattern::PanelInfo& p = garment.panels.panels[k];
    if (vertex >= p.first_vertex && vertex < p.first_vertex + p.n_vertices)
      return static_cast<int>(k);
  }
  return -1;
}

/// The stretches of a seam side; empty when part of it lies inside a panel.
std::vector<OutlineStretch> stretches_of(const Garment& garment,
                                         const std::vector<EdgedOutline>& outlines,
                                         const std::vector<int>& run) {
  std::vector<OutlineStretch> stretches;
  for (std::size_t i = 0; i + 1 < run.size(); ++i) {
    if (run[i] == run[i + 1])
      continue;
    const int panel = panel_at(garment, run[i]);
    if (panel != panel_at(garment, run[i + 1]))
      continue; // over to the next panel: the particle is the same
    const int step = outlines[panel].step(run[i], run[i + 1]);
    if (step == 0)
      return {};
    if (!stretches.empty() && stretches.back().panel == panel && stretches.back().last == run[i] &&
        stretches.back().step == step)
      stretches.back().last = run[i + 1];
    else
      stretches.push_back({panel, run[i], run[i + 1], step});
  }
  return stretches;
}

/// Whole edges along a stretch, in its direction.
void add_runs(const EdgedOutline& outline, const OutlineStretch& stretch,
              std::vector<pattern::Run>& runs) {
  const int from = outline.position.at(stretch.first), to = outline.position.at(stretch.last);
  const auto edge_from = [&](int start) {
    return static_cast<int>(
        std::lower_bound(outline.edge_starts.begin(), outline.edge_starts.end(), start) -
        outline.edge_starts.begin());
  };
  int at = from;
  do {
    int end = outline.next(at, stretch.step);
    while (!outline.ends[end])
      end = outline.next(end, stretch.step);
    if (stretch.step > 0)
      runs.push_back({stretch.panel, edge_from(at), 0, 1});
    else
      runs.push_back({stretch.panel, edge_from(end), 1, 0});
    at = end;
  } while (at != to);
}

void mark_corners(const Garment& shape, EdgedOutline& outline) {
  for (int i = 0; i < outline.n(); ++i) {
    const Vec2 &p = shape.panels.pattern[outline.vertices[i]],
               &before = shape.panels.pattern[outline.vertices[outline.next(i, -1)]],
               &after = shape.panels.pattern[outline.vertices[outline.next(i, 1)]];
    const Vec2 u = p - before, v = after - p;
    if (std::abs(std::atan2(u.x() * v.y() - u.y() * v.x(), u.dot(v))) > CORNER)
      outline.ends[i] = 1;
  }
}

/// Outlines with the places where edges end: those of the drawn pattern where it is known, else
/// corners; and the ends of seams.
std::vector<EdgedOutline> edged_outlines(const Garment& shape,
                                         const std::optional<DrawnPattern>& drawn) {
  std::vector<EdgedOutline> outlines;
  for (const pattern::PanelInfo& info : shape.panels.panels) {
    EdgedOutline outline;
    outline.vertices = info.outline;
    for (int i = 0; i < outline.n(); ++i)
      outline.position[outline.vertices[i]] = i;
    outline.ends.assign(outline.vertices.size(), 0);
    if (drawn) {
      const std::vector<int>& edge_of = drawn->edge_of[outlines.size()];
      for (int i = 0; i < outline.n(); ++i)
        outline.ends[i] = i == 0 || edge_of[i] != edge_of[i - 1];
    } else {
      mark_corners(shape, outline);
    }
    outlines.push_back(std::move(outline));
  }
  return outlines;
}

/// NAME for an edge that is still in one piece, NAME_1, NAME_2 ... for the pieces of one that a
/// seam ends on.
std::vector<std::string> edge_names(const EdgedOutline& outline, const pattern::Panel* drawn,
                                    const std::vector<int>* edge_of) {
  std::vector<std::string> names;
  std::map<int, int> pieces, piece;
  if (drawn)
    for (const int start : outline.edge_starts)
      ++pieces[(*edge_of)[start]];
  for (std::size_t e = 0; e < outline.edge_starts.size(); ++e) {
    std::string name = "e" + std::to_string(e);
    if (drawn) {
      const int from = (*edge_of)[outline.edge_starts[e]];
      name = drawn->edge(from).name;
      if (pieces[from] > 1) {
        name += "_" + std::to_string(++piece[from]);
        while (drawn->find_edge(name) >= 0)
          name += "_";
      }
    }
    names.push_back(name);
  }
  return names;
}

pattern::Panel panel_of(const Garment& garment, const pattern::PanelInfo& info,
                        const EdgedOutline& outline, const std::vector<std::string>& names) {
  pattern::Panel panel;
  panel.name = info.name;
  panel.grain = info.grain;
  panel.material = info.material;
  panel.layer = info.layer;
  panel.label = info.part;
  panel.hint.part = info.part;
  panel.loops.emplace_back();
  for (std::size_t e = 0; e < outline.edge_starts.size(); ++e) {
    pattern::PanelEdge edge{names[e], {}};
    int at = outline.edge_starts[e];
    do {
      const int to = outline.next(at, 1);
      edge.path.push_back(pattern::Segment::straight(garment.panels.pattern[outline.vertices[at]],
                                                     garment.panels.pattern[outline.vertices[to]]));
      at = to;
    } while (!outline.ends[at]);
    panel.loops[0].push_back(std::move(edge));
  }
  return panel;
}

double width_of(const std::vector<Vec2>& points) {
  double low = 1e300, high = -1e300;
  for (const Vec2& p : points) {
    low = std::min(low, p.x());
    high = std::max(high, p.x());
  }
  return high - low;
}

/// Where a panel is to start on the body that the cloth lies on now: an anchor goes with the
/// outline point nearest to it, a radius with the panel's width, a rigid placement with the panel's
/// cloth.
pattern::PlacementHint moved_hint(const pattern::PlacementHint& drawn,
                                  const std::vector<Vec2>& outline, const Garment& garment,
                                  const Garment& shape, const pattern::PanelInfo& info) {
  pattern::PlacementHint hint = drawn;
  if (hint.anchor) {
    const auto nearest =
        std::min_element(outline.begin(), outline.end(), [&](const Vec2& a, const Vec2& b) {
          return (a - *drawn.anchor).norm() < (b - *drawn.anchor).norm();
        });
    const int v = info.outline[nearest - outline.begin()];
    *hint.anchor += garment.panels.pattern[v] - *nearest;
    if (hint.height)
      hint.height = garment.position[garment.particle_of[v]].y() + (*drawn.anchor - *nearest).y();
  }
  if (hint.radius) {
    std::vector<Vec2> now;
    for (const int v : info.outline)
      now.push_back(garment.panels.pattern[v]);
    *hint.radius *= width_of(now) / width_of(outline);
  }
  if (hint.rigid) {
    Vec3 move = Vec3::Zero();
    for (int v = info.first_vertex; v < info.first_vertex + info.n_vertices; ++v)
      move += (garment.position[garment.particle_of[v]] - shape.position[shape.particle_of[v]]) /
              info.n_vertices;
    hint.rigid->topRightCorner<3, 1>() += move;
  }
  return hint;
}

/// A notch of the drawn panel on the new one's edges, as far between two mesh points as it was.
/// @param outline as drawn
pattern::Notch moved_notch(const pattern::Notch& drawn, const std::vector<Vec2>& outline,
                           const std::vector<int>& edge_of, const EdgedOutline& edged,
                           const pattern::Panel& panel) {
  const auto length = [&](int i) { return (outline[edged.next(i, 1)] - outline[i]).norm(); };
  const auto [first, last] = std::equal_range(edge_of.begin(), edge_of.end(), drawn.edge);
  if (first == last)
    return {-1, 0, drawn.kind}; // of an edge that is shorter than the mesh's
  int at = static_cast<int>(first - edge_of.begin());
  double left = 0;
  for (int i = at; i < last - edge_of.begin(); ++i)
    left += drawn.at * length(i);
  for (; at + 1 < last - edge_of.begin() && left > length(at); ++at)
    left -= length(at);
  // The new edge that this mesh edge is part of, and how far along it the notch lies.
  const auto start = std::upper_bound(edged.edge_starts.begin(), edged.edge_starts.end(), at) - 1;
  pattern::Notch notch{static_cast<int>(start - edged.edge_starts.begin()), 0, drawn.kind};
  const pattern::Path& path = panel.edge(notch.edge).path;
  double before = 0;
  for (int i = 0; i < at - *start; ++i)
    before += (path[i].p[3] - path[i].p[0]).norm();
  const pattern::Segment& on = path[at - *start];
  notch.at = std::min((before + std::min(left / length(at), 1.0) * (on.p[3] - on.p[0]).norm()) /
                          pattern::length(path),
                      1.0);
  return notch;
}

/// What the drawn pattern says of a panel and no mesh does.
void take_over(const DrawnPattern& drawn, std::size_t k, const Garment& garment,
               const Garment& shape, const EdgedOutline& edged, pattern::Pattern& result) {
  const pattern::Panel& from = drawn.pattern->panels[k];
  pattern::Panel& panel = result.panels[k];
  panel.label = from.label;
  panel.hint = moved_hint(from.hint, drawn.outlines[k], garment, shape, garment.panels.panels[k]);
  for (const pattern::Notch& notch : from.notches)
    if (notch.edge < std::ssize(from.loops[0]))
      if (const pattern::Notch moved =
              moved_notch(notch, drawn.outlines[k], drawn.edge_of[k], edged, panel);
          moved.edge >= 0)
        panel.notches.push_back(moved);
  const bool lines = !from.lines.empty(), holes = from.loops.size() > 1;
  if (lines || holes)
    result.findings.push_back({"retarget.lines-left-out"_id,
                               from.name + ": its " + (lines ? "inner lines" : "") +
                                   (lines && holes ? " and " : "") + (holes ? "holes" : "") +
                                   " are not in the regraded pattern"});
}

} // namespace

pattern::Pattern pattern_of(const Garment& garment, const Garment& shape) {
  pattern::Pattern result;
  result.name = garment.panels.name;
  result.source_format = "pattern";
  const std::optional<DrawnPattern> drawn = drawn_pattern(shape);
  std::vector<EdgedOutline> outlines = edged_outlines(shape, drawn);
  std::vector<std::array<std::vector<OutlineStretch>, 2>> sides;
  for (const pattern::MeshSeam& seam : garment.panels.seams) {
    sides.push_back(
        {stretches_of(garment, outlines, seam.a), stretches_of(garment, outlines, seam.b)});
    for (const auto& side : sides.back())
      for (const OutlineStretch& s : side)
        outlines[s.panel].ends[outlines[s.panel].position.at(s.first)] =
            outlines[s.panel].ends[outlines[s.panel].position.at(s.last)] = 1;
  }
  for (std::size_t k = 0; k < outlines.size(); ++k) {
    EdgedOutline& outline = outlines[k];
    if (outline.n() > 0 &&
        std::find(outline.ends.begin(), outline.ends.end(), 1) == outline.ends.end())
      outline.ends[0] = 1; // a round panel
    for (int i = 0; i < outline.n(); ++i)
      if (outline.ends[i])
        outline.edge_starts.push_back(i);
    const std::vector<std::string> names =
        edge_names(outline, drawn ? &drawn->pattern->panels[k] : nullptr,
                   drawn ? &drawn->edge_of[k] : nullptr);
    result.panels.push_back(panel_of(garment, garment.panels.panels[k], outline, names));
    if (drawn)
      take_over(*drawn, k, garment, shape, outline, result);
  }
  for (std::size_t s = 0; s < sides.size(); ++s) {
    const pattern::MeshSeam& from = garment.panels.seams[s];
    const bool inside = sides[s][0].empty() || sides[s][1].empty();
    if (inside || from.kind == "pleat") {
      result.findings.push_back({"retarget.seam-left-out"_id,
                                 "seam " + from.name +
                                     (inside ? " lies inside a panel and is left out"
                                             : " of a pleat is left out: fold and sew it again")});
      continue;
    }
    pattern::Seam seam;
    seam.name = from.name;
    seam.kind = from.kind;
    seam.open = from.open;
    for (const OutlineStretch& stretch : sides[s][0])
      add_runs(outlines[stretch.panel], stretch, seam.a);
    for (const OutlineStretch& stretch : sides[s][1])
      add_runs(outlines[stretch.panel], stretch, seam.b);
    if (drawn)
      for (const pattern::Seam& same : drawn->pattern->seams)
        if (same.name == from.name)
          seam.ease = same.ease;
    result.seams.push_back(std::move(seam));
  }
  return result;
}

std::string grade_table(const pattern::Pattern& before, const pattern::Pattern& after) {
  std::string csv = "kind,panel,edge,before_cm,after_cm,delta_cm\r\n";
  const auto line = [&](const char* kind, const std::string& panel, const std::string& edge,
                        double a, double b) {
    char text[256];
    std::snprintf(text, sizeof text, "%s,%s,%s,%.2f,%.2f,%+.2f\r\n", kind, panel.c_str(),
                  edge.c_str(), 100 * a, 100 * b, 100 * (b - a));
    csv += text;
  };
  const auto extent = [](const pattern::Panel& panel, const Vec2& direction) {
    double low = 1e300, high = -1e300;
    for (const auto& loop : panel.loops)
      for (const pattern::PanelEdge& e : loop)
        for (const pattern::Segment& s : e.path) {
          low = std::min(low, s.p[0].dot(direction));
          high = std::max(high, s.p[0].dot(direction));
        }
    return high - low;
  };
  for (std::size_t k = 0; k < before.panels.size() && k < after.panels.size(); ++k) {
    const pattern::Panel &a = before.panels[k], &b = after.panels[k];
    const Vec2 across(a.grain.y(), -a.grain.x());
    line("width", a.name, "", extent(a, across), extent(b, across));
    line("height", a.name, "", extent(a, a.grain), extent(b, a.grain));
    for (int e = 0; e < a.n_edges(); ++e)
      line("edge", a.name, a.edge(e).name, pattern::length(a.edge(e).path),
           pattern::length(b.edge(e).path));
  }
  for (std::size_t s = 0; s < before.seams.size() && s < after.seams.size(); ++s) {
    const pattern::Seam &a = before.seams[s], &b = after.seams[s];
    const double a_length = pattern::side_length(before, a.a),
                 b_length = pattern::side_length(after, b.a);
    line("seam", a.name, "", a_length, b_length);
    line("mismatch", a.name, "", a_length - pattern::side_length(before, a.b),
         b_length - pattern::side_length(after, b.b));
  }
  return csv;
}

} // namespace sloper::garment
