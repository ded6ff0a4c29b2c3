#include <pattern/edit/edit_tools.hpp>
#include <pattern/read/outline_json.hpp>
#include <sloper/base/text.hpp>
#include <sloper/io/json.hpp>
#include <sloper/pattern/edit/edits.hpp>
#include <sloper/pattern/mesh/folds.hpp>
#include <sloper/pattern/read/read_pattern.hpp>

#include <algorithm>
#include <cmath>
#include <functional>

namespace sloper::pattern {
namespace {

constexpr double GRID = 1.0 / (1 << 30); // m: sums of multiples are exact

/// Adds `by` to a path with weights that fall from w0 at its start to w1 at its end, by control
/// point number: they do not depend on the shape, so that adding -by undoes it exactly.
void drag(Path& path, const Vec2& by, double w0, double w1) {
  const double n = 3.0 * static_cast<double>(path.size());
  for (std::size_t s = 0; s < path.size(); ++s)
    for (std::size_t k = 0; k < 4; ++k) {
      const double t = (3.0 * static_cast<double>(s) + static_cast<double>(k)) / n;
      path[s].p[k] += snapped(Vec2((w0 + t * (w1 - w0)) * by));
    }
}

struct Place {
  std::vector<PanelEdge>* loop;
  std::size_t at;
  PanelEdge& edge() const { return (*loop)[at]; }
  PanelEdge& before() const { return (*loop)[(at + loop->size() - 1) % loop->size()]; }
  PanelEdge& after() const { return (*loop)[(at + 1) % loop->size()]; }
};

Place place_of_edge(Panel& panel, int edge) {
  std::size_t k = static_cast<std::size_t>(edge);
  for (auto& loop : panel.loops) {
    if (k < loop.size())
      return {&loop, k};
    k -= loop.size();
  }
  return {&panel.loops[0], 0};
}

/// Moves an edge's ends by two vectors; the edge follows in between, its neighbours with their near
/// ends.
void move_ends(const Place& place, const Vec2& start, const Vec2& end) {
  drag(place.edge().path, start, 1, 0);
  drag(place.edge().path, end, 0, 1);
  if (place.loop->size() == 1)
    return;
  drag(place.before().path, start, 0, 1);
  drag(place.after().path, end, 1, 0);
}

/// After edits of edges: lines that end on an edge go with it, at the same fraction of its length.
void carry_lines(const Panel& before, Panel& after) {
  for (std::size_t k = 0; k < after.lines.size(); ++k) {
    Path& path = after.lines[k].path;
    Vec2 move[2];
    for (const bool last : {false, true}) {
      const Vec2 end = last ? path.back().p[3] : path.front().p[0];
      const OnOutline on = on_outline(before, end);
      move[last] = Vec2::Zero();
      if (on.edge < 0)
        continue;
      const ArcLength old(before.edge(on.edge).path), now(after.edge(on.edge).path);
      move[last] = now.at(on.at * now.length()) - old.at(on.at * old.length());
    }
    if (move[0].norm() + move[1].norm() > 1e-12) {
      drag(path, move[0], 1, 0);
      drag(path, move[1], 0, 1);
    }
  }
}

/// Moves an edge inwards, square to its chord.
void move_inward(const io::Node& node, Panel& panel, int edge, double by) {
  const Place place = place_of_edge(panel, edge);
  const Vec2 chord = place.edge().path.back().p[3] - place.edge().path.front().p[0];
  if (chord.norm() < 1e-6)
    node.fail("edit.no-direction"_id, "edge " + place.edge().name +
                                          " is a closed curve, so it has no direction to move in");
  const Vec2 move = snapped(Vec2(Vec2(-chord.y(), chord.x()).normalized() * by));
  drag(place.edge().path, move, 1, 1);
  if (place.loop->size() > 1) {
    drag(place.before().path, move, 0, 1);
    drag(place.after().path, move, 1, 0);
  }
}

const Seam& seam_named(const Pattern& pattern, const io::Node& node) {
  const std::string name = node.string();
  const auto seam = std::find_if(pattern.seams.begin(), pattern.seams.end(),
                                 [&](const Seam& s) { return s.name == name; });
  if (seam != pattern.seams.end())
    return *seam;
  std::vector<std::string> names;
  for (const Seam& s : pattern.seams)
    names.push_back(s.name);
  node.fail("edit.no-seam"_id, "there is no seam '" + name + "'" + did_you_mean(name, names));
}

/// Opens a seam, or closes one that is open. An edit that changes nothing is a mistake, and would
/// have no opposite.
void open_seam(Pattern& pattern, const io::Node& node, bool open) {
  node.allow_only({"edit", "seam"});
  const Seam& found = seam_named(pattern, node.at("seam"));
  Seam& seam = pattern.seams[&found - pattern.seams.data()];
  if (seam.kind == "dart" || seam.kind == "pleat")
    node.at("seam").fail("edit.cannot-open"_id,
                         seam.name + " is a " + seam.kind + " and cannot be opened",
                         "name a seam or a closure");
  if (seam.open == open)
    node.at("seam").fail("edit.already-so"_id,
                         "seam " + seam.name + " is already " + (open ? "open" : "closed"));
  seam.open = open;
}

double positive_length(const io::Node& node, double unit) {
  const double length = node.at("length").number() * unit;
  if (!(length > 1e-4))
    node.at("length").fail("edit.too-small"_id,
                           "the length is too short (" + centimetres(length) + ")",
                           "give more than 0.01 cm");
  return length;
}

void move_point(Pattern& pattern, const io::Node& node, double unit) {
  node.allow_only({"edit", "panel", "edge", "end", "by"});
  Panel& p = edited_panel(pattern, node);
  const std::string end = node.string("end", "start");
  if (end != "start" && end != "end")
    node.at("end").fail("json.unknown-word"_id, "'" + end + "' is not an end of an edge",
                        "give start or end");
  const Vec2 by = snapped(Vec2(node.at("by").vec2() * unit)), none(0, 0);
  move_ends(place_of_edge(p, edited_edge(p, node)), end == "start" ? by : none,
            end == "end" ? by : none);
}

void move_edge(Pattern& pattern, const io::Node& node, double unit) {
  node.allow_only({"edit", "panel", "edge", "by"});
  Panel& p = edited_panel(pattern, node);
  const Vec2 by = snapped(Vec2(node.at("by").vec2() * unit));
  const Place place = place_of_edge(p, edited_edge(p, node));
  drag(place.edge().path, by, 1, 1);
  if (place.loop->size() > 1) {
    drag(place.before().path, by, 0, 1);
    drag(place.after().path, by, 1, 0);
  }
}

/// Inwards along one edge, or half of it along each side of a seam. @param sign 1 takes in, -1 lets
/// out
void take_in(Pattern& pattern, const io::Node& node, double unit, double sign) {
  node.allow_only({"edit", "panel", "edge", "seam", "by"});
  const double by = sign * node.at("by").number() * unit;
  if (!node.has("seam")) {
    Panel& p = edited_panel(pattern, node);
    move_inward(node, p, edited_edge(p, node), by);
    return;
  }
  const Seam& seam = seam_named(pattern, node.at("seam"));
  for (const auto* side : {&seam.a, &seam.b})
    for (const Run& run : *side)
      move_inward(node, pattern.panels[run.panel], run.edge, 0.5 * by);
}

void bend(Pattern& pattern, const io::Node& node, double unit) {
  node.allow_only({"edit", "panel", "edge", "by"});
  Panel& p = edited_panel(pattern, node);
  // The middle of a cubic lies at three quarters from its chord to its two handles.
  const Vec2 by = node.at("by").vec2() * (unit * 4 / 3);
  Path& path = place_of_edge(p, edited_edge(p, node)).edge().path;
  const double n = static_cast<double>(path.size());
  if (path.size() == 1) {
    if (path[0].line)
      path[0] =
          Segment::cubic(path[0].p[0], path[0].at(1.0 / 3), path[0].at(2.0 / 3), path[0].p[3]);
    path[0].p[1] += by;
    path[0].p[2] += by;
    return;
  }
  for (std::size_t s = 0; s < path.size();
       ++s) // along a chain the middle moves by `by`, the ends not at all
    for (std::size_t k = 0; k < 4; ++k) {
      const double t = (static_cast<double>(s) + static_cast<double>(k) / 3) / n;
      path[s].p[k] += 3 * t * (1 - t) * by;
    }
}

/// Of one edge, or of both sides of a seam, their edges in proportion.
void set_lengths(Pattern& pattern, const io::Node& node, double unit) {
  node.allow_only({"edit", "panel", "edge", "seam", "length", "fixed"});
  const double length = positive_length(node, unit);
  const std::string fixed = node.string("fixed", "start");
  if (fixed != "start" && fixed != "end" && fixed != "middle")
    node.at("fixed").fail("json.unknown-word"_id, "'" + fixed + "' cannot be fixed",
                          "give start, end or middle");
  if (!node.has("seam")) {
    Panel& p = edited_panel(pattern, node);
    set_length(p, edited_edge(p, node), length, fixed);
    return;
  }
  const Seam& seam = seam_named(pattern, node.at("seam"));
  for (const auto* side : {&seam.a, &seam.b}) {
    const double ratio = length / side_length(pattern, *side);
    for (const Run& run : *side) {
      Panel& p = pattern.panels[run.panel];
      set_length(p, run.edge, ratio * pattern::length(p.edge(run.edge).path), fixed);
    }
  }
}

/// A panel that lies on one side of a line would be moved or left as it is, but not lengthened.
void refuse_line_beside(const Panel& panel, const Vec2& at, const Vec2& along, const io::Node& node,
                        double unit) {
  constexpr int STEPS = 16; // along a segment of the outline
  double low = 1e300, high = -1e300;
  for (const PanelEdge& e : panel.loops[0])
    for (const Segment& s : e.path)
      for (int k = 0; k <= STEPS; ++k) {
        const double beyond = (s.at(k / double(STEPS)) - at).dot(along);
        low = std::min(low, beyond);
        high = std::max(high, beyond);
      }
  if (low <= 0 && high > 0)
    return;
  const double line = at.dot(along);
  const auto in_unit = [&](double metres) {
    return io::Json(std::round(1000 * metres / unit) / 1000).dump();
  };
  node.at("at").fail("edit.line-does-not-cut"_id,
                     "the line lies beside panel " + panel.name + ": measured along \"along\" at " +
                         in_unit(line) + ", the panel from " + in_unit(line + low) + " to " +
                         in_unit(line + high) + ", in the unit of the document",
                     "give a point of the panel, or name another panel");
}

/// What lies beyond a line goes along. @param sign 1 lengthens, -1 shortens
void lengthen(Pattern& pattern, const io::Node& node, double unit, double sign) {
  node.allow_only({"edit", "panel", "at", "along", "by"});
  const Vec2 at = node.at("at").vec2() * unit, direction = node.at("along").vec2();
  if (!(direction.norm() > 0))
    node.at("along").fail("edit.no-direction"_id,
                          "the vector has no length, so it gives no direction");
  const Vec2 along = direction.normalized(),
             by = snapped(Vec2(along * node.at("by").number() * unit * sign));
  Panel& panel = edited_panel(pattern, node);
  refuse_line_beside(panel, at, along, node, unit);
  map_panel(panel, [&](const Vec2& p) { return (p - at).dot(along) > 0 ? Vec2(p + by) : p; });
}

/// The panel that an edit names, or all.
template<class Change>
void change_panels(Pattern& pattern, const io::Node& node, const Change& change) {
  if (node.has("panel"))
    return change(edited_panel(pattern, node));
  for (Panel& p : pattern.panels)
    change(p);
}

void scale(Pattern& pattern, const io::Node& node, double) {
  node.allow_only({"edit", "panel", "x", "y"});
  const double x = factor(node, "x"), y = factor(node, "y");
  change_panels(pattern, node, [&](Panel& p) {
    const Vec2 c = middle(p);
    map_panel(p, [&](const Vec2& q) {
      return Vec2(c.x() + x * (q.x() - c.x()), c.y() + y * (q.y() - c.y()));
    });
  });
}

void grade(Pattern& pattern, const io::Node& node, double unit) {
  node.allow_only({"edit", "panel", "width", "height"});
  const double width = node.number("width", 0) * unit, height = node.number("height", 0) * unit;
  change_panels(pattern, node, [&](Panel& p) {
    const auto [low, high] = extent(p);
    const Vec2 c = 0.5 * (low + high), size = high - low,
               factor((size.x() + width) / size.x(), (size.y() + height) / size.y());
    if (!(factor.minCoeff() > 0.2))
      node.fail("edit.too-small"_id, "panel " + p.name + " is " + centimetres(size.x()) + " by " +
                                         centimetres(size.y()) +
                                         ": too small to grade by that much");
    map_panel(p, [&](const Vec2& q) { return Vec2(c + factor.cwiseProduct(q - c)); });
  });
}

struct Edit {
  const char* name;
  void (*apply)(Pattern& pattern, const io::Node& node, double unit);
  bool drags_edges = false; ///< lines that end on an edge go with it
};

const Edit EDITS[] = {
    {"move-point", move_point, true},
    {"move-edge", move_edge, true},
    {"bend", bend, true},
    {"add-point", [](Pattern& p, const io::Node& n, double) { add_point(p, n); }},
    {"set-length", set_lengths, true},
    {"take-in", [](Pattern& p, const io::Node& n, double unit) { take_in(p, n, unit, 1); }, true},
    {"let-out", [](Pattern& p, const io::Node& n, double unit) { take_in(p, n, unit, -1); }, true},
    {"lengthen", [](Pattern& p, const io::Node& n, double unit) { lengthen(p, n, unit, 1); }},
    {"shorten", [](Pattern& p, const io::Node& n, double unit) { lengthen(p, n, unit, -1); }},
    {"scale", scale},
    {"grade", grade},
    {"shrink", shrink, true},
    {"split", split_panel},
    {"cut", split_panel},
    {"join", [](Pattern& p, const io::Node& n, double) { join_panels(p, n); }},
    {"add-dart", add_dart},
    {"rotate-dart", [](Pattern& p, const io::Node& n, double) { rotate_dart(p, n); }},
    {"open", [](Pattern& p, const io::Node& n, double) { open_seam(p, n, true); }},
    {"close", [](Pattern& p, const io::Node& n, double) { open_seam(p, n, false); }},
    {"restore", [](Pattern& p, const io::Node& n, double) { restore(p, n); }},
};

const Edit& edit_named(const io::Node& node) {
  const std::string what = node.at("edit").string();
  std::vector<std::string> names;
  std::string known;
  for (const Edit& edit : EDITS) {
    if (what == edit.name)
      return edit;
    const bool last = &edit == std::end(EDITS) - 1;
    if (!names.empty())
      known += last ? " and " : ", ";
    known += edit.name;
    names.emplace_back(edit.name);
  }
  node.at("edit").fail("edit.unknown"_id, "unknown edit '" + what + "'" + did_you_mean(what, names),
                       "known are " + known);
}

} // namespace

void set_length(Panel& panel, int edge, double length, const std::string& fixed) {
  const Place place = place_of_edge(panel, edge);
  Path& path = place.edge().path;
  const double factor = length / pattern::length(path);
  const Vec2 a = path.front().p[0], b = path.back().p[3];
  Vec2 about = a;
  if (fixed == "end")
    about = b;
  if (fixed == "middle")
    about = 0.5 * (a + b);
  for (Segment& s : path)
    for (Vec2& p : s.p)
      p = snapped(Vec2(about + factor * (p - about)));
  if (place.loop->size() == 1)
    return;
  drag(place.before().path, path.front().p[0] - a, 0, 1);
  drag(place.after().path, path.back().p[3] - b, 1, 0);
  // The ends must meet to the last bit.
  place.before().path.back().p[3] = path.front().p[0];
  place.after().path.front().p[0] = path.back().p[3];
}

Vec2 snapped(const Vec2& p) {
  return {std::nearbyint(p.x() / GRID) * GRID, std::nearbyint(p.y() / GRID) * GRID};
}

void apply_edits(Pattern& pattern, const io::Json& json, const std::string& file) {
  const io::Node root(json, file);
  if (const std::string format = root.at("format").string(); format != "edits")
    root.at("format").fail("json.wrong-format"_id, "is a \"" + format + "\" document, not edits",
                           "write \"format\": \"edits\"");
  root.allow_only({"format", "version", "generator", "length_unit", "edits"});
  if (root.integer("version", 1) > 1)
    root.at("version").fail("json.newer-version"_id,
                            "the version is newer than version 1, the newest this program reads",
                            "update Sloper, or write version 1");
  const double unit = unit_of(root.at("length_unit"));
  const auto onto_grid =
      [&] { // after each edit, so that a log in one piece and in many gives the same
        for (Panel& p : pattern.panels)
          map_panel(p, [](const Vec2& q) { return q; });
      };
  onto_grid();
  const io::Node edits = root.at("edits");
  for (std::size_t k = 0; k < edits.size(); ++k) {
    std::vector<Panel> lined;
    for (const Panel& p : pattern.panels)
      if (!p.lines.empty())
        lined.push_back(p);
    const Edit& edit = edit_named(edits.at(k));
    edit.apply(pattern, edits.at(k), unit);
    if (edit.drags_edges && !edits.at(k).has("warp") && !edits.at(k).has("strip"))
      for (const Panel& before : lined)
        if (const int p = pattern.find_panel(before.name); p >= 0)
          carry_lines(before, pattern.panels[p]);
    onto_grid();
    for (const Panel& p : pattern.panels) {
      std::vector<Path> loop;
      for (const PanelEdge& e : p.loops[0])
        loop.push_back(e.path);
      if (const double area = signed_area(loop); !(area > 0))
        edits.at(k).fail("edit.turned-inside-out"_id,
                         "panel " + p.name +
                             " is turned inside out: its outline now runs clockwise around " +
                             std::to_string(std::lround(std::min(1e9, -1e4 * area))) + " cm2");
      if (const auto fault = fault_of(p))
        edits.at(k).fail("pattern.faulty-outline"_id,
                         "panel " + p.name + (fault->place.empty() ? "" : ": " + fault->place) +
                             ": " + fault->fact,
                         fault->next);
    }
  }
}

} // namespace sloper::pattern
