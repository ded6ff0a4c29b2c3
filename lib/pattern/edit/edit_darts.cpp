/// Edits of darts: add-dart (into an edge, or a fisheye inside a panel) and rotate-dart.
#include <pattern/edit/edit_tools.hpp>
#include <pattern/read/outline_json.hpp>
#include <sloper/base/text.hpp>
#include <sloper/io/json.hpp>

#include <algorithm>
#include <cmath>

namespace sloper::pattern {
namespace {

bool inside(const Panel& panel, const Vec2& p) {
  bool in = false;
  for (const PanelEdge& e : panel.loops[0]) {
    const ArcLength arc(e.path);
    const int n = 64 * static_cast<int>(e.path.size());
    for (int k = 0; k < n; ++k) {
      const Vec2 a = arc.at(arc.length() * k / n), b = arc.at(arc.length() * (k + 1) / n);
      if ((a.y() > p.y()) != (b.y() > p.y()) &&
          p.x() < a.x() + (p.y() - a.y()) / (b.y() - a.y()) * (b.x() - a.x()))
        in = !in;
    }
  }
  return in;
}

} // namespace

void add_dart(Pattern& pattern, const io::Node& node, double unit) {
  node.allow_only(
      {"edit", "panel", "edge", "at", "width", "tip", "name", "center", "length", "along"});
  const int index = panel_named(pattern, node.at("panel"));
  const Panel panel = pattern.panels[index];
  const double width = node.at("width").number() * unit;
  if (!(width > 1e-3))
    node.at("width").fail("edit.too-small"_id,
                          "the dart is too narrow (" + centimetres(width) + ")",
                          "give more than 0.1 cm");
  std::string name = node.string("name", panel.name + "-dart");
  for (int k = 2; std::any_of(pattern.seams.begin(), pattern.seams.end(),
                              [&](const Seam& s) { return s.name == name; });
       ++k) {
    if (node.has("name"))
      node.at("name").fail("edit.name-taken"_id, "seam '" + name + "' already exists");
    name = panel.name + "-dart" + std::to_string(k);
  }
  const std::string leg_a = free_edge_name(panel, name + "_a"),
                    leg_b = free_edge_name(panel, name + "_b");
  std::vector<Piece> pieces = pieces_of(panel);
  if (node.has("center")) { // a fisheye: a hole whose two sides are sewn together
    const double half = 0.5 * node.at("length").number() * unit;
    const Vec2 center = node.at("center").vec2() * unit,
               direction = node.has("along") ? node.at("along").vec2() : Vec2(0, 1);
    if (!(half > width) || !(direction.norm() > 0))
      node.at("length").fail("edit.bad-dart"_id, "a fisheye dart must be longer than it is wide",
                             "give its length along the middle");
    const Vec2 u = direction.normalized(), v(-u.y(), u.x());
    const Vec2 corner[4] = {
        snapped(Vec2(center - half * u)), snapped(Vec2(center + 0.5 * width * v)),
        snapped(Vec2(center + half * u)), snapped(Vec2(center - 0.5 * width * v))};
    for (const Vec2& c : corner)
      if (!inside(panel, c))
        node.at("center").fail("edit.outside-panel"_id,
                               "the dart extends beyond panel " + panel.name,
                               "move its center, or make it smaller");
    Rebuilt out = rebuilt(panel, pieces, all_holes(panel));
    const int first = out.panel.n_edges(); // clockwise: left side up, right side down
    out.panel.loops.push_back(
        {{leg_a,
          {Segment::straight(corner[0], corner[1]), Segment::straight(corner[1], corner[2])}},
         {leg_b,
          {Segment::straight(corner[2], corner[3]), Segment::straight(corner[3], corner[0])}}});
    out.origin.push_back({});
    out.origin.push_back({});
    replace_panel(pattern, index, {std::move(out)}, node);
    pattern.seams.push_back({name, "dart", {{index, first, 0, 1}}, {{index, first + 1, 1, 0}}, ""});
    return;
  }
  const std::size_t k = static_cast<std::size_t>(outer_edge(panel, node, "edge"));
  const double total = length(panel.edge(static_cast<int>(k)).path), at = fraction(node, "at");
  const double from = at - 0.5 * width / total, to = at + 0.5 * width / total;
  if (from * total < AT_CORNER || (1 - to) * total < AT_CORNER)
    node.at("at").fail("edit.outside-panel"_id,
                       "a dart of " + centimetres(width) + " at " + decimals(at, 3) + " of " +
                           panel.edge(static_cast<int>(k)).name + " (" + centimetres(total) +
                           ") extends past the end of the edge",
                       "move it inwards");
  const Vec2 tip = snapped(Vec2(node.at("tip").vec2() * unit));
  if (!inside(panel, tip))
    node.at("tip").fail("edit.outside-panel"_id, "the tip lies outside of panel " + panel.name);
  const Piece whole = pieces[k];
  auto [one, rest] = cut_piece(whole, from);
  auto [gone, two] = cut_piece(rest, (to - from) / (1 - from));
  two.edge.name = whole.edge.name + "_2";
  const std::vector<Piece> instead = {one, straight(leg_a, end_of(one), tip),
                                      straight(leg_b, tip, start_of(two)), two};
  pieces.erase(pieces.begin() + static_cast<long>(k));
  pieces.insert(pieces.begin() + static_cast<long>(k), instead.begin(), instead.end());
  replace_panel(pattern, index, {rebuilt(panel, pieces, all_holes(panel))}, node);
  pattern.seams.push_back({name,
                           "dart",
                           {{index, static_cast<int>(k) + 1, 0, 1}},
                           {{index, static_cast<int>(k) + 2, 1, 0}},
                           ""});
}

void rotate_dart(Pattern& pattern, const io::Node& node) {
  node.allow_only({"edit", "dart", "edge", "at"});
  const std::string name = node.at("dart").string();
  const auto seam = std::find_if(pattern.seams.begin(), pattern.seams.end(),
                                 [&](const Seam& s) { return s.name == name; });
  if (seam == pattern.seams.end())
    node.at("dart").fail("edit.no-seam"_id, "there is no seam '" + name + "'");
  if (seam->a.size() != 1 || seam->b.size() != 1 || seam->a[0].panel != seam->b[0].panel)
    node.at("dart").fail("edit.bad-dart"_id, "seam " + name + " is not a dart");
  const int index = seam->a[0].panel;
  const Panel panel = pattern.panels[index];
  const int n = std::ssize(panel.loops[0]);
  int leg = seam->a[0].edge, second = seam->b[0].edge;
  if ((second + 1) % n == leg)
    std::swap(leg, second);
  if (leg >= n || second >= n || (leg + 1) % n != second)
    node.at("dart").fail("edit.bad-dart"_id, "seam " + name + " is not a dart at an edge",
                         "only darts that end in the outline can be rotated");
  std::vector<Piece> pieces = pieces_of(panel);
  const Piece one = pieces[leg], two = pieces[second];
  const Vec2 tip = end_of(one), a = start_of(one), b = end_of(two);
  if (std::abs((a - tip).norm() - (b - tip).norm()) > 1e-3)
    node.at("dart").fail("edit.bad-dart"_id,
                         "the legs of dart " + name + " differ by " +
                             centimetres(std::abs((a - tip).norm() - (b - tip).norm())),
                         "make them equal first");
  const std::size_t wanted = static_cast<std::size_t>(outer_edge(panel, node, "edge"));
  if (static_cast<int>(wanted) == leg || static_cast<int>(wanted) == second)
    node.at("edge").fail("edit.bad-dart"_id, "the dart cannot open in its own leg");
  // The new opening; the legs stay beside each other while it is made.
  const std::size_t opening = corner_at(pieces, wanted, fraction(node, "at"));
  const auto find = [&](int edge) {
    std::size_t k = 0;
    while (pieces[k].origin.edge != edge)
      ++k;
    return k;
  };
  const std::size_t first = find(leg), last = (first + 1) % pieces.size(),
                    after = (last + 1) % pieces.size();
  if (opening == first || opening == after)
    node.at("at").fail("edit.bad-dart"_id, "the dart already opens there");
  std::vector<Piece> turned = walk(pieces, after, opening), still = walk(pieces, opening, first);
  // The shorter part of the outline between dart and opening turns about the tip until the legs
  // meet.
  const auto total = [](const std::vector<Piece>& list) {
    double sum = 0;
    for (const Piece& piece : list)
      sum += length(piece.edge.path);
    return sum;
  };
  const double between =
      std::atan2((a - tip).y(), (a - tip).x()) - std::atan2((b - tip).y(), (b - tip).x());
  const bool all_but = total(still) < total(turned);
  const Eigen::Matrix2d turn = Eigen::Rotation2Dd(all_but ? -between : between).toRotationMatrix();
  for (Piece& piece : all_but ? still : turned)
    for (Segment& s : piece.edge.path)
      for (Vec2& p : s.p)
        p = snapped(Vec2(tip + turn * (p - tip)));
  if (all_but)
    still.back().edge.path.back().p[3] = b;
  else
    turned.front().edge.path.front().p[0] = a;
  Piece new_one = straight(one.edge.name, end_of(turned.back()), tip),
        new_two = straight(two.edge.name, tip, start_of(still.front()));
  new_one.origin = one.origin;
  new_two.origin = two.origin;
  std::vector<Piece> outer = still;
  outer.insert(outer.end(), turned.begin(), turned.end());
  outer.push_back(new_one);
  outer.push_back(new_two);
  replace_panel(pattern, index, {rebuilt(panel, outer, all_holes(panel))}, node);
}

} // namespace sloper::pattern
