/// Taking edits back: the opposite edit where it is exact, else the touched panels as they were.
#include <pattern/edit/edit_tools.hpp>
#include <pattern/read/outline_json.hpp>
#include <sloper/io/json.hpp>
#include <sloper/pattern/edit/edits.hpp>

#include <algorithm>

namespace sloper::pattern {
namespace {

/// A panel to the last bit, m: what our own format leaves out (world placement) and rounds (inches)
/// is kept.
io::Json panel_state(const Panel& p) {
  io::Json loops = io::Json::array();
  for (const auto& loop : p.loops) {
    io::Json edges = io::Json::array();
    for (const PanelEdge& e : loop) {
      io::Json path = io::Json::array();
      for (const Segment& s : e.path) {
        io::Json segment = io::Json::array({s.line ? 1 : 0});
        for (const Vec2& x : s.p) {
          segment.push_back(x.x());
          segment.push_back(x.y());
        }
        path.push_back(segment);
      }
      edges.push_back({{"edge", e.name}, {"segments", path}});
    }
    loops.push_back(edges);
  }
  io::Json out = {{"name", p.name},         {"loops", loops},   {"grain", io::to_json(p.grain)},
                  {"material", p.material}, {"layer", p.layer}, {"label", p.label}};
  io::Json notches = io::Json::array(), hint = io::Json::object();
  for (const Notch& n : p.notches)
    notches.push_back({{"edge", n.edge}, {"at", n.at}, {"kind", n.kind}});
  out["notches"] = notches;
  if (!p.lines.empty()) {
    io::Json lines = io::Json::array(), pleats = io::Json::array();
    for (const InnerLine& line : p.lines) {
      io::Json path = io::Json::array();
      for (const Segment& s : line.path) {
        io::Json segment = io::Json::array({s.line ? 1 : 0});
        for (const Vec2& x : s.p) {
          segment.push_back(x.x());
          segment.push_back(x.y());
        }
        path.push_back(segment);
      }
      lines.push_back({{"name", line.name},
                       {"kind", line.kind},
                       {"segments", path},
                       {"factor", line.factor},
                       {"width", line.width}});
    }
    for (const Pleat& pleat : p.pleats)
      pleats.push_back({{"name", pleat.name},
                        {"fold", pleat.fold},
                        {"target", pleat.target},
                        {"edges", pleat.edges}});
    out["lines"] = lines;
    out["pleats"] = pleats;
  }
  if (!p.hint.part.empty())
    hint["part"] = p.hint.part;
  if (p.hint.theta)
    hint["theta"] = *p.hint.theta;
  if (p.hint.anchor)
    hint["anchor"] = io::to_json(*p.hint.anchor);
  if (p.hint.radius)
    hint["radius"] = *p.hint.radius;
  if (p.hint.height)
    hint["height"] = *p.hint.height;
  if (p.hint.rigid) {
    io::Json m = io::Json::array();
    for (long r = 0; r < 4; ++r)
      for (long c = 0; c < 4; ++c)
        m.push_back((*p.hint.rigid)(r, c));
    hint["rigid"] = m;
  }
  out["hint"] = hint;
  return out;
}

Path path_from(const io::Node& segments) {
  if (!segments.is_array() || segments.size() == 0)
    segments.fail("edit.damaged-undo"_id, "the edge has no segments");
  Path path;
  for (std::size_t s = 0; s < segments.size(); ++s) {
    const io::Node numbers = segments.at(s);
    if (numbers.size() != 9)
      numbers.fail("edit.damaged-undo"_id, "a segment needs 9 numbers");
    Segment segment;
    segment.line = numbers.at(0).number() != 0;
    for (std::size_t i = 0; i < 4; ++i)
      segment.p[i] = Vec2(numbers.at(1 + 2 * i).number(), numbers.at(2 + 2 * i).number());
    path.push_back(segment);
  }
  return path;
}

Panel panel_from(const io::Node& node) {
  Panel p;
  p.name = node.at("name").string();
  p.grain = node.at("grain").vec2();
  p.material = node.string("material", "");
  p.layer = node.integer("layer", 0);
  p.label = node.string("label", "");
  const io::Node loops = node.at("loops");
  if (!loops.is_array() || loops.size() == 0)
    loops.fail("edit.damaged-undo"_id, "the panel has no outline");
  for (std::size_t l = 0; l < loops.size(); ++l) {
    const io::Node edges = loops.at(l);
    if (!edges.is_array() || edges.size() == 0)
      edges.fail("edit.damaged-undo"_id, "the loop has no edges");
    p.loops.push_back({});
    for (std::size_t k = 0; k < edges.size(); ++k) {
      const io::Node segments = edges.at(k).at("segments");
      p.loops.back().push_back({edges.at(k).at("edge").string(), path_from(segments)});
    }
    for (std::size_t k = 0; k < p.loops.back().size(); ++k)
      if (const double gap = (p.loops.back()[k].path.back().p[3] -
                              p.loops.back()[(k + 1) % p.loops.back().size()].path.front().p[0])
                                 .norm();
          gap > 1e-4)
        edges.fail("edit.damaged-undo"_id, "the outline of panel " + p.name + " is open by " +
                                               centimetres(gap) + " after edge " +
                                               p.loops.back()[k].name);
  }
  const io::Node notches = node.at("notches"), hint = node.at("hint");
  for (std::size_t k = 0; k < notches.size(); ++k) {
    const Notch n{notches.at(k).at("edge").integer(), notches.at(k).at("at").number(),
                  notches.at(k).string("kind", "")};
    if (n.edge < 0 || n.edge >= p.n_edges())
      notches.at(k).fail("edit.damaged-undo"_id,
                         "edge " + std::to_string(n.edge) + " does not exist");
    p.notches.push_back(n);
  }
  if (node.has("lines")) {
    for (std::size_t k = 0; k < node.at("lines").size(); ++k) {
      const io::Node line = node.at("lines").at(k);
      p.lines.push_back({line.at("name").string(), line.string("kind", "mark"),
                         path_from(line.at("segments")), line.number("factor", 1),
                         line.number("width", 0.01)});
    }
    for (std::size_t k = 0; k < node.at("pleats").size(); ++k) {
      const io::Node item = node.at("pleats").at(k);
      Pleat pleat{
          item.at("name").string(), item.at("fold").integer(), item.at("target").integer(), {}};
      for (std::size_t e = 0; e < item.at("edges").size(); ++e) {
        pleat.edges.push_back(item.at("edges").at(e).integer());
        if (pleat.edges.back() < 0 || pleat.edges.back() >= p.n_edges())
          item.fail("edit.damaged-undo"_id,
                    "pleat " + pleat.name + " is sewn along an edge that does not exist");
      }
      for (int line : {pleat.fold, pleat.target})
        if (line < 0 || line >= std::ssize(p.lines))
          item.fail("edit.damaged-undo"_id,
                    "pleat " + pleat.name + " folds along a line that does not exist");
      p.pleats.push_back(std::move(pleat));
    }
  }
  p.hint.part = hint.string("part", "");
  if (hint.has("theta"))
    p.hint.theta = hint.at("theta").number();
  if (hint.has("anchor"))
    p.hint.anchor = hint.at("anchor").vec2();
  if (hint.has("radius"))
    p.hint.radius = hint.at("radius").number();
  if (hint.has("height"))
    p.hint.height = hint.at("height").number();
  if (hint.has("rigid")) {
    Mat4 m;
    if (hint.at("rigid").size() != 16)
      hint.at("rigid").fail("edit.damaged-undo"_id, "a placement needs 16 numbers");
    for (long k = 0; k < 16; ++k)
      m(k / 4, k % 4) = hint.at("rigid").at(static_cast<std::size_t>(k)).number();
    p.hint.rigid = m;
  }
  return p;
}

io::Json seams_state(const Pattern& pattern) {
  io::Json out = io::Json::array();
  for (const Seam& s : pattern.seams) {
    io::Json seam = {{"name", s.name}, {"kind", s.kind}, {"ease", s.ease}};
    if (s.open)
      seam["open"] = true;
    for (const auto* side : {&s.a, &s.b}) {
      io::Json runs = io::Json::array();
      for (const Run& r : *side)
        runs.push_back({r.panel, r.edge, r.from, r.to});
      seam[side == &s.a ? "a" : "b"] = runs;
    }
    out.push_back(seam);
  }
  return out;
}

/// What brings `after` back to `before`.
io::Json restore_edit(const Pattern& before, const Pattern& after) {
  io::Json order = io::Json::array(), panels = io::Json::array();
  for (const Panel& p : before.panels) {
    order.push_back(p.name);
    const int k = after.find_panel(p.name);
    const io::Json state = panel_state(p);
    if (k < 0 || panel_state(after.panels[k]) != state)
      panels.push_back(state);
  }
  io::Json edit = {{"edit", "restore"}, {"order", order}, {"panels", panels}};
  const io::Json seams = seams_state(before);
  if (seams != seams_state(after) || before.panels.size() != after.panels.size())
    edit["seams"] = seams;
  return edit;
}

/// The opposite of an edit that its opposite undoes to the last bit; null for others.
io::Json opposite(const io::Json& edit) {
  const std::string what = edit["edit"].get<std::string>();
  io::Json out = edit;
  if (what == "move-point" || what == "move-edge") {
    for (auto& x : out["by"])
      x = -x.get<double>();
    return out;
  }
  if ((what == "take-in" || what == "let-out") && edit.contains("panel")) {
    out["edit"] = what == "take-in" ? "let-out" : "take-in";
    return out;
  }
  if (what == "open" || what == "close") {
    out["edit"] = what == "open" ? "close" : "open";
    return out;
  }
  return nullptr;
}

} // namespace

void restore(Pattern& pattern, const io::Node& node) {
  node.allow_only({"edit", "order", "panels", "seams"});
  std::vector<Panel> panels;
  const io::Node order = node.at("order"), given = node.at("panels");
  for (std::size_t k = 0; k < order.size(); ++k) {
    const std::string name = order.at(k).string();
    bool found = false;
    for (std::size_t g = 0; g < given.size() && !found; ++g)
      if (given.at(g).at("name").string() == name) {
        panels.push_back(panel_from(given.at(g)));
        found = true;
      }
    if (found)
      continue;
    panels.push_back(pattern.panels[panel_named(pattern, order.at(k))]);
  }
  if (panels.empty())
    order.fail("edit.no-panel-left"_id, "no panel would be left");
  std::vector<Seam> seams = pattern.seams;
  if (node.has("seams")) {
    seams.clear();
    for (std::size_t k = 0; k < node.at("seams").size(); ++k) {
      const io::Node item = node.at("seams").at(k);
      Seam seam{item.at("name").string(),
                item.string("kind", "seam"),
                {},
                {},
                item.string("ease", ""),
                item.has("open") && item.at("open").boolean()};
      for (const char* side : {"a", "b"})
        for (std::size_t r = 0; r < item.at(side).size(); ++r) {
          const io::Node run = item.at(side).at(r);
          (side[0] == 'a' ? seam.a : seam.b)
              .push_back({run.at(0).integer(), run.at(1).integer(), run.at(2).number(),
                          run.at(3).number()});
        }
      seams.push_back(std::move(seam));
    }
  }
  for (const Seam& seam : seams)
    for (const auto* side : {&seam.a, &seam.b}) {
      if (side->empty())
        node.fail("edit.damaged-undo"_id, "seam " + seam.name + " has an empty side");
      for (const Run& run : *side)
        if (run.panel < 0 || run.panel >= std::ssize(panels) || run.edge < 0 ||
            run.edge >= panels[run.panel].n_edges() ||
            !(run.from >= 0 && run.from <= 1 && run.to >= 0 && run.to <= 1))
          node.fail("edit.damaged-undo"_id,
                    "seam " + seam.name + " runs along an edge that does not exist");
    }
  pattern.panels = std::move(panels);
  pattern.seams = std::move(seams);
}

io::Json inverse_edits(const Pattern& before, const io::Json& json, const std::string& file,
                       const std::string& tool) {
  io::Json out = io::new_document("edits", 1, tool);
  out["length_unit"] = json.at("length_unit");
  Pattern pattern = before;
  Pattern probe = before;
  apply_edits(probe, json, file); // so that a fault is named by its place in the file
  io::Json one = json;
  one["edits"] = io::Json::array();
  apply_edits(pattern, one, file); // onto the grid
  std::vector<io::Json> steps;
  const io::Node edits = io::Node(json, file).at("edits");
  for (std::size_t k = 0; k < edits.size(); ++k) {
    const Pattern last = pattern;
    one["edits"] = io::Json::array({edits.at(k).json()});
    apply_edits(pattern, one, file);
    io::Json back = opposite(edits.at(k).json());
    // Inner lines follow the outline along curves, which no opposite undoes to the last bit.
    if (std::any_of(last.panels.begin(), last.panels.end(),
                    [](const Panel& p) { return !p.lines.empty(); }))
      back = nullptr;
    steps.push_back(back.is_null() ? restore_edit(last, pattern) : back);
  }
  std::reverse(steps.begin(), steps.end());
  out["edits"] = io::Json::array();
  for (io::Json& step : steps)
    out["edits"].push_back(std::move(step));
  return out;
}

} // namespace sloper::pattern
