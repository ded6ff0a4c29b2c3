/// Our own pattern format, a file that people write: every unknown key is an error. Its schema is
/// pattern.schema.json beside this file.
#include <pattern/read/outline_json.hpp>
#include <sloper/base/text.hpp>
#include <sloper/base/units.hpp>
#include <sloper/io/json.hpp>
#include <sloper/pattern/read/read_pattern.hpp>

#include <algorithm>
#include <cmath>
#include <set>

namespace sloper::pattern {
namespace {

/// Mirrors a loop about x = 0 and reverses it, so that it keeps its sense.
std::vector<PanelEdge> mirrored(const std::vector<PanelEdge>& loop) {
  std::vector<PanelEdge> out;
  for (auto it = loop.rbegin(); it != loop.rend(); ++it) {
    PanelEdge e{it->name, reversed(it->path)};
    for (Segment& s : e.path)
      for (Vec2& p : s.p)
        p.x() = -p.x();
    out.push_back(std::move(e));
  }
  return out;
}

void read_fold(const io::Node& node, Panel& panel) {
  node.allow_only({"edge", "suffix"});
  const int fold = edge_named(panel, node.at("edge"));
  std::string suffix[2] = {"", "_mirror"};
  if (node.has("suffix"))
    for (std::size_t k = 0; k < 2; ++k)
      suffix[k] = node.at("suffix").at(k).string();
  if (!unfold(panel, fold, suffix[0], suffix[1]))
    node.fail("pattern.fold-not-straight"_id, "panel " + panel.name + ": the fold edge '" +
                                                  panel.edge(fold).name +
                                                  "' is not straight, or on a hole");
}

void read_place(const io::Node& node, Panel& panel, double unit) {
  node.allow_only({"part", "theta_deg", "radius", "anchor", "height", "rigid"});
  panel.hint.part = node.string("part", "");
  const char* parts[] = {"",      "torso", "neck",       "arm_l", "arm_r",
                         "leg_l", "leg_r", "lower_body", "head"};
  if (std::find(std::begin(parts), std::end(parts), panel.hint.part) == std::end(parts))
    node.fail("json.unknown-word"_id, "unknown part '" + panel.hint.part + "'",
              "known are torso, neck, head, arm_l, arm_r, leg_l, leg_r and lower_body");
  if (node.has("theta_deg"))
    panel.hint.theta = units::radians(node.at("theta_deg").number());
  if (node.has("radius"))
    panel.hint.radius = node.at("radius").number() * unit;
  if (node.has("anchor"))
    panel.hint.anchor = node.at("anchor").vec2() * unit;
  if (node.has("height"))
    panel.hint.height = node.at("height").number() * unit;
  if (node.has("rigid")) {
    const io::Node rigid = node.at("rigid");
    if (rigid.size() != 12)
      rigid.fail("pattern.not-rigid"_id, "is not a rigid motion",
                 "give three rows of four numbers: a rotation and a shift");
    Mat4 m = Mat4::Identity();
    for (std::size_t k = 0; k < 12; ++k)
      m(static_cast<long>(k / 4), static_cast<long>(k % 4)) =
          rigid.at(k).number() * (k % 4 == 3 ? unit : 1);
    if (!((m.topLeftCorner<3, 3>() * m.topLeftCorner<3, 3>().transpose() - Mat3::Identity())
              .cwiseAbs()
              .maxCoeff() < 1e-6))
      rigid.fail("pattern.not-rigid"_id, "the first three columns are not a rotation");
    panel.hint.rigid = m;
  }
}

int line_named(const Panel& panel, const io::Node& node) {
  const std::string name = node.string();
  std::vector<std::string> names;
  for (const InnerLine& line : panel.lines)
    names.push_back(line.name);
  const auto found = std::find(names.begin(), names.end(), name);
  if (found != names.end())
    return static_cast<int>(found - names.begin());
  node.fail("pattern.no-line"_id,
            "panel " + panel.name + " has no line '" + name + "'" + did_you_mean(name, names));
}

void read_lines(const io::Node& node, Panel& panel, double unit) {
  for (std::size_t k = 0; k < node.size(); ++k) {
    const io::Node item = node.at(k);
    item.allow_only({"name", "kind", "path", "factor", "width"});
    InnerLine line{item.at("name").string(), item.string("kind", "mark"),
                   read_path(item.at("path"), unit, nullptr)};
    const std::set<std::string> kinds = {"mark", "fold", "tape", "roll"};
    if (kinds.count(line.kind) == 0)
      item.at("kind").fail("json.unknown-word"_id, "'" + line.kind + "' is not a kind of line",
                           "give mark, fold, tape or roll");
    line.factor = item.number("factor", 1);
    line.width = item.number("width", 0.01 / unit) * unit;
    if (!(line.factor >= 0.05 && line.factor <= 20))
      item.at("factor").fail("json.out-of-range"_id,
                             "factor " + decimals(line.factor, 3) + " is out of range",
                             "give 0.05 to 20");
    if (!(line.width > 0))
      item.at("width").fail("pattern.too-small"_id, "the tape has no width");
    if (!(length(line.path) > 1e-3))
      item.fail("pattern.too-small"_id, "line '" + line.name + "' of panel " + panel.name + " is " +
                                            centimetres(length(line.path)) + " long");
    for (const InnerLine& other : panel.lines)
      if (other.name == line.name)
        item.fail("pattern.name-twice"_id,
                  "panel " + panel.name + " has two lines named '" + line.name + "'");
    panel.lines.push_back(std::move(line));
  }
}

/// After fold and mirror: edges are those of the whole panel.
void read_pleats(const io::Node& node, Panel& panel) {
  for (std::size_t k = 0; k < node.size(); ++k) {
    const io::Node item = node.at(k);
    item.allow_only({"name", "fold", "target", "edges"});
    Pleat pleat;
    pleat.fold = line_named(panel, item.at("fold"));
    pleat.target = line_named(panel, item.at("target"));
    pleat.name = item.string("name", panel.name + "-" + panel.lines[pleat.fold].name);
    if (pleat.fold == pleat.target)
      item.fail("pleat.malformed"_id, "pleat " + pleat.name + " folds a line onto itself");
    const io::Node edges = item.at("edges");
    if (edges.size() == 0)
      edges.fail("pleat.malformed"_id, "pleat " + pleat.name + " is not sewn along any edge");
    for (std::size_t e = 0; e < edges.size(); ++e)
      pleat.edges.push_back(edge_named(panel, edges.at(e)));
    panel.pleats.push_back(std::move(pleat));
  }
}

void read_panel(const io::Node& node, Pattern& pattern, double unit) {
  node.allow_only({"name", "outline", "holes", "grain", "material", "layer", "notches", "mirror_of",
                   "fold", "place", "label", "lines", "pleats"});
  Panel panel;
  panel.name = node.at("name").string();
  if (panel.name.empty() || pattern.find_panel(panel.name) >= 0)
    node.fail("pattern.name-twice"_id, panel.name.empty()
                                           ? "a panel has no name"
                                           : "there are two panels named '" + panel.name + "'");
  if (node.has("mirror_of")) {
    if (node.has("outline") || node.has("holes") || node.has("fold") || node.has("lines"))
      node.fail("pattern.mirror-and-outline"_id,
                "panel " + panel.name + " has both mirror_of and an outline");
    const Panel& other = pattern.panels[panel_named(pattern, node.at("mirror_of"))];
    for (const auto& loop : other.loops)
      panel.loops.push_back(mirrored(loop));
    panel.lines = other.lines;
    for (InnerLine& line : panel.lines) {
      for (Segment& s : line.path)
        for (Vec2& p : s.p)
          p.x() = -p.x();
      keep_side(line);
    }
    panel.grain = Vec2(-other.grain.x(), other.grain.y());
    panel.material = other.material;
    panel.layer = other.layer;
    panel.label = other.label;
  } else {
    panel.loops.push_back(read_loop(node.at("outline"), "edge", unit, panel.name));
    if (node.has("holes"))
      for (std::size_t k = 0; k < node.at("holes").size(); ++k) {
        node.at("holes").at(k);
        panel.loops.push_back(read_loop(node.at("holes").at(k), "edge", unit, panel.name));
      }
    if (node.has("lines"))
      read_lines(node.at("lines"), panel, unit);
    if (node.has("fold"))
      read_fold(node.at("fold"), panel);
  }
  if (node.has("pleats"))
    read_pleats(node.at("pleats"), panel);
  if (node.has("grain")) {
    panel.grain = node.at("grain").vec2();
    if (!(panel.grain.norm() > 0))
      node.at("grain").fail("pattern.too-small"_id,
                            "panel " + panel.name + ": the grain has no direction");
    if (!(std::abs(panel.grain.squaredNorm() - 1) < 1e-15))
      panel.grain.normalize(); // what is of unit length stays to the bit
  }
  panel.material = node.string("material", panel.material);
  panel.layer = node.integer("layer", panel.layer);
  panel.label = node.string("label", panel.label);
  if (node.has("place"))
    read_place(node.at("place"), panel, unit);
  if (node.has("notches"))
    for (std::size_t k = 0; k < node.at("notches").size(); ++k) {
      const io::Node notch = node.at("notches").at(k);
      notch.allow_only({"edge", "at", "kind"});
      const double at = notch.at("at").number();
      if (at < 0 || at > 1)
        notch.fail("json.out-of-range"_id, "a notch is at " + decimals(at, 3) + " of its edge",
                   "give a fraction from 0 to 1");
      panel.notches.push_back(
          {edge_named(panel, notch.at("edge")), at, notch.string("kind", "slit")});
    }
  for (int k = 0; k < panel.n_edges(); ++k)
    if (panel.find_edge(panel.edge(k).name) != k)
      node.fail("pattern.name-twice"_id,
                "panel " + panel.name + " has two edges named '" + panel.edge(k).name + "'");
  pattern.panels.push_back(std::move(panel));
}

std::vector<Run> read_side(const io::Node& node, const Pattern& pattern, bool against) {
  std::vector<Run> side;
  if (!node.is_array() || node.size() == 0)
    node.fail("json.wrong-type"_id, "a side of a seam is a list of runs");
  for (std::size_t k = 0; k < node.size(); ++k) {
    const io::Node item = node.at(k);
    item.allow_only({"panel", "edge", "from", "to"});
    Run run;
    run.panel = panel_named(pattern, item.at("panel"));
    run.edge = edge_named(pattern.panels[run.panel], item.at("edge"));
    run.from = item.number("from", against ? 1 : 0);
    run.to = item.number("to", against ? 0 : 1);
    for (double f : {run.from, run.to})
      if (f < 0 || f > 1)
        item.fail("json.out-of-range"_id,
                  "a run extends from " + decimals(run.from, 3) + " to " + decimals(run.to, 3) +
                      " of its edge",
                  "give fractions from 0 to 1");
    if (run.from == run.to)
      item.fail("pattern.too-small"_id, "a run has no length");
    side.push_back(run);
  }
  return side;
}

} // namespace

Pattern read_pattern_json(const io::Json& json, const std::string& file) {
  const io::Node root(json, file);
  root.allow_only({"format", "version", "generator", "length_unit", "name", "panels", "seams"});
  if (root.integer("version", 1) > 1)
    root.at("version").fail("json.newer-version"_id,
                            "version " + std::to_string(root.at("version").integer()) +
                                " is newer than version 1, the newest this program reads",
                            "update Sloper, or write version 1");
  if (!root.has("length_unit"))
    root.fail("json.missing-key"_id, "has no \"length_unit\"",
              "add for example \"length_unit\": \"cm\"");
  const double unit = unit_of(root.at("length_unit"));
  Pattern pattern;
  pattern.source_format = "pattern";
  pattern.name = root.string("name", "");
  const io::Node panels = root.at("panels");
  if (!panels.is_array() || panels.size() == 0)
    panels.fail("pattern.no-panels"_id, "there are no panels");
  for (std::size_t k = 0; k < panels.size(); ++k)
    read_panel(panels.at(k), pattern, unit);
  if (root.has("seams"))
    for (std::size_t k = 0; k < root.at("seams").size(); ++k) {
      const io::Node node = root.at("seams").at(k);
      node.allow_only({"name", "kind", "a", "b", "ease", "open"});
      Seam seam;
      seam.name = node.string("name", "seam " + std::to_string(k));
      seam.kind = node.string("kind", "seam");
      seam.ease = node.string("ease", "");
      if (node.has("open"))
        seam.open = node.at("open").boolean();
      if (seam.kind != "seam" && seam.kind != "dart" && seam.kind != "gather" &&
          seam.kind != "closure")
        node.at("kind").fail("json.unknown-word"_id, "unknown kind '" + seam.kind + "'",
                             "known are seam, dart, gather and closure");
      seam.a = read_side(node.at("a"), pattern, false);
      seam.b = read_side(node.at("b"), pattern, true);
      pattern.seams.push_back(std::move(seam));
    }
  return pattern;
}

} // namespace sloper::pattern
