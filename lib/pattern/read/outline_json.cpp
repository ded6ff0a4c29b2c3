#include <pattern/read/outline_json.hpp>

#include <cmath>

namespace sloper::pattern {

double unit_of(const io::Node& node) {
  const std::string unit = node.string();
  if (unit == "m")
    return 1;
  if (unit == "cm")
    return 0.01;
  if (unit == "mm")
    return 0.001;
  if (unit == "in")
    return 0.0254;
  node.fail("json.unknown-word"_id, "unknown unit '" + unit + "'", "known are m, cm, mm and in");
}

/// Members of a path item with its letter: two for each point; 0 of a letter that is not known.
static std::size_t size_of_item(const std::string& letter) {
  if (letter == "M" || letter == "L")
    return 3;
  if (letter == "Q")
    return 5; // two points
  if (letter == "C")
    return 7;                   // three points
  return letter == "A" ? 6 : 0; // radius, two flags, a point
}

Path read_path(const io::Node& node, double unit, const Vec2* start) {
  Path path;
  std::optional<Vec2> at;
  if (start)
    at = *start;
  for (std::size_t k = 0; k < node.size(); ++k) {
    const io::Node item = node.at(k);
    if (!item.is_array() || item.size() == 0)
      item.fail("pattern.bad-path"_id, "a path item is a list like [\"L\", x, y]");
    const std::string what = item.at(0).string();
    const std::size_t count = size_of_item(what);
    if (count == 0)
      item.fail("pattern.bad-path"_id, "unknown path letter '" + what + "'",
                "known are M, L, Q, C and A");
    if (item.size() != count)
      item.fail("pattern.bad-path"_id, "'" + what + "' takes " + std::to_string(count - 1) +
                                           " numbers, not " + std::to_string(item.size() - 1));
    const auto point = [&](std::size_t i) {
      return Vec2(item.at(i).number() * unit, item.at(i + 1).number() * unit);
    };
    const Vec2 to = point(count - 2);
    if (what == "M") {
      if (k != 0)
        item.fail("pattern.bad-path"_id, "M is allowed only at the start of a path");
      at = to;
      continue;
    }
    if (!at)
      item.fail("pattern.bad-path"_id, "the path has no start", "begin with [\"M\", x, y]");
    if (what == "L")
      path.push_back(Segment::straight(*at, to));
    if (what == "Q")
      path.push_back(Segment::quadratic(*at, point(1), to));
    if (what == "C")
      path.push_back(Segment::cubic(*at, point(1), point(3), to));
    if (what == "A") {
      const double radius = item.at(1).number() * unit;
      if (!(radius > 0))
        item.fail("pattern.bad-path"_id, "the radius is not positive");
      const Path arc =
          circle_arc(*at, to, radius, item.at(2).number() != 0, item.at(3).number() != 0);
      path.insert(path.end(), arc.begin(), arc.end());
    }
    at = to;
  }
  if (path.empty())
    node.fail("pattern.bad-path"_id, "the path has no segments", "give at least one L, Q, C or A");
  return path;
}

std::vector<PanelEdge> read_loop(const io::Node& node, const char* key, double unit,
                                 const std::string& panel) {
  std::vector<PanelEdge> loop;
  if (!node.is_array() || node.size() < 2)
    node.fail("pattern.too-few-edges"_id,
              "the outline of panel " + panel + " has fewer than two edges");
  for (std::size_t k = 0; k < node.size(); ++k) {
    const io::Node item = node.at(k);
    const std::string name = item.at(key).string();
    for (const PanelEdge& e : loop)
      if (e.name == name)
        item.fail("pattern.name-twice"_id,
                  "panel " + panel + " has two edges named '" + name + "'");
    const Vec2* start = loop.empty() ? nullptr : &loop.back().path.back().p[3];
    loop.push_back({name, read_path(item.at("path"), unit, start)});
  }
  for (std::size_t k = 0; k < loop.size(); ++k) {
    Vec2& end = loop[k].path.back().p[3];
    const PanelEdge& next = loop[(k + 1) % loop.size()];
    const double gap = (next.path.front().p[0] - end).norm();
    if (!(gap <= 1e-4))
      node.fail("pattern.outline-open"_id,
                "the outline of panel " + panel + " is open: edge '" + loop[k].name + "' ends " +
                    centimetres(gap) + " from where '" + next.name + "' starts",
                "close the gap");
    end = next.path.front().p[0];
  }
  return loop;
}

int panel_named(const Pattern& pattern, const io::Node& node) {
  const std::string name = node.string();
  const int k = pattern.find_panel(name);
  if (k >= 0)
    return k;
  std::vector<std::string> names;
  for (const Panel& p : pattern.panels)
    names.push_back(p.name);
  node.fail("pattern.no-panel"_id, "there is no panel '" + name + "'" + did_you_mean(name, names));
}

int edge_named(const Panel& panel, const io::Node& node) {
  const std::string name = node.string();
  const int k = panel.find_edge(name);
  if (k >= 0)
    return k;
  std::vector<std::string> names;
  for (const auto& loop : panel.loops)
    for (const PanelEdge& e : loop)
      names.push_back(e.name);
  node.fail("pattern.no-edge"_id,
            "panel " + panel.name + " has no edge '" + name + "'" + did_you_mean(name, names));
}

} // namespace sloper::pattern
