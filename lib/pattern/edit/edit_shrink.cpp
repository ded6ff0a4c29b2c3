/// Cloth that shrinks: along a curve, along an edge, in a strip, or all of a panel along warp and
/// weft.
#include <pattern/edit/edit_tools.hpp>
#include <pattern/read/outline_json.hpp>
#include <sloper/base/text.hpp>
#include <sloper/io/json.hpp>

#include <algorithm>
#include <cmath>

namespace sloper::pattern {
namespace {

/// Elastic tape along a curve: rest lengths change along it, the outline does not.
void add_tape(Panel& p, const io::Node& node, double unit) {
  InnerLine tape{"", "tape", read_path(node.at("curve"), unit, nullptr), factor(node, "factor"),
                 node.number("width", 0.01 / unit) * unit};
  for (Segment& s : tape.path)
    for (Vec2& q : s.p)
      q = snapped(q);
  const auto [low, high] = extent(p);
  for (const Segment& s : tape.path)
    for (const Vec2& q : s.p)
      if (!((low - q).maxCoeff() < 0.1 && (q - high).maxCoeff() < 0.1))
        node.at("curve").fail("edit.outside-panel"_id, "the tape extends beyond panel " + p.name,
                              "draw it inside");
  if (!(pattern::length(tape.path) > 0.005))
    node.at("curve").fail("edit.too-small"_id,
                          "the tape is too short (" + centimetres(pattern::length(tape.path)) + ")",
                          "draw at least 0.5 cm");
  if (!(tape.width > 0 && tape.width < 1))
    node.at("width").fail("json.out-of-range"_id,
                          "a tape " + centimetres(tape.width) + " wide is out of range",
                          "give a width above 0 and below 100 cm");
  const auto taken = [&](const std::string& name) {
    return std::any_of(p.lines.begin(), p.lines.end(),
                       [&](const InnerLine& l) { return l.name == name; });
  };
  tape.name = node.string("name", "tape");
  if (node.has("name") && taken(tape.name))
    node.at("name").fail("edit.name-taken"_id,
                         "panel " + p.name + " already has a line '" + tape.name + "'");
  for (int k = 2; taken(tape.name); ++k)
    tape.name = "tape" + std::to_string(k);
  p.lines.push_back(std::move(tape));
}

/// Cloth between two parallel lines, across them.
void shrink_strip(Panel& p, const io::Node& node, double unit) {
  const io::Node strip = node.at("strip");
  strip.allow_only({"from", "to"});
  const Vec2 from = strip.at("from").vec2() * unit, across = strip.at("to").vec2() * unit - from;
  const double width = across.norm(), f = factor(node, "factor");
  if (!(width > 1e-4))
    strip.fail("edit.too-small"_id, "the strip is too narrow (" + centimetres(width) + ")",
               "give more than 0.01 cm");
  const Vec2 along = across / width, c = from + 0.5 * across;
  map_panel(p, [&](const Vec2& q) {
    const double s = (q - c).dot(along), inside = std::clamp(s, -0.5 * width, 0.5 * width);
    return Vec2(q + (f - 1) * inside * along);
  });
}

} // namespace

void shrink(Pattern& pattern, const io::Node& node, double unit) {
  node.allow_only(
      {"edit", "panel", "warp", "weft", "edge", "factor", "strip", "curve", "width", "name"});
  Panel& p = edited_panel(pattern, node);
  if (node.has("curve"))
    return add_tape(p, node, unit);
  if (node.has("edge")) {
    const int e = edited_edge(p, node);
    return set_length(p, e, factor(node, "factor") * pattern::length(p.edge(e).path), "middle");
  }
  if (node.has("strip"))
    return shrink_strip(p, node, unit);
  const double warp = factor(node, "warp"), weft = factor(node, "weft");
  const Vec2 c = middle(p), u = p.grain, v(-u.y(), u.x());
  map_panel(p, [&](const Vec2& q) {
    return Vec2(c + warp * (q - c).dot(u) * u + weft * (q - c).dot(v) * v);
  });
}

} // namespace sloper::pattern
