/// Edits that change what edges and panels there are: split, cut, add-point, join. Darts are in
/// edit_darts.cpp.
#include <pattern/edit/edit_tools.hpp>
#include <pattern/read/outline_json.hpp>
#include <sloper/base/units.hpp>
#include <sloper/io/json.hpp>

#include <algorithm>
#include <cmath>

namespace sloper::pattern {
namespace {

double side(const Vec2& p, const Vec2& a, const Vec2& along) {
  return along.x() * (p - a).y() - along.y() * (p - a).x();
}

/// Where the line crosses the outer loop: (piece, fraction), corners once.
std::vector<std::pair<std::size_t, double>> crossings(const std::vector<Piece>& pieces,
                                                      const Vec2& a, const Vec2& along) {
  std::vector<std::pair<std::size_t, double>> out;
  std::vector<Vec2> found;
  constexpr int N = 256;
  for (std::size_t k = 0; k < pieces.size(); ++k) {
    const ArcLength arc(pieces[k].edge.path);
    const auto value = [&](double f) { return side(arc.at(f * arc.length()), a, along); };
    for (int i = 0; i < N; ++i) {
      double low = static_cast<double>(i) / N, high = static_cast<double>(i + 1) / N;
      double v0 = value(low), v1 = value(high);
      if (std::abs(v0) < 1e-9)
        v0 = 0;
      if (std::abs(v1) < 1e-9)
        v1 = 0;
      if (v0 * v1 > 0 || v1 == 0)
        continue; // an end on the line belongs to the next stretch
      if (v0 != 0)
        for (int turn = 0; turn < 60; ++turn) {
          const double middle = 0.5 * (low + high);
          (value(middle) * v0 > 0 ? low : high) = middle;
        }
      const Vec2 p = arc.at(low * arc.length());
      if (std::any_of(found.begin(), found.end(),
                      [&](const Vec2& q) { return (p - q).norm() < AT_CORNER; }))
        continue;
      found.push_back(p);
      out.push_back({k, low});
    }
  }
  return out;
}

} // namespace

void split_panel(Pattern& pattern, const io::Node& node, double unit) {
  node.allow_only({"edit", "panel", "from", "to", "names", "sew"});
  const int index = panel_named(pattern, node.at("panel"));
  const Panel panel = pattern.panels[index];
  const Vec2 from = node.at("from").vec2() * unit, to = node.at("to").vec2() * unit;
  if (!((to - from).norm() > 1e-4))
    node.at("to").fail("edit.no-direction"_id, "the line has no direction");
  std::vector<Piece> pieces = pieces_of(panel);
  auto hits = crossings(pieces, from, to - from);
  if (hits.size() != 2)
    node.fail("edit.line-does-not-cut"_id,
              "the line crosses the outline of " + panel.name + " in " +
                  std::to_string(hits.size()) + " places",
              "give a line that crosses it twice");
  // The second first, so that the first keeps its number. A: what lies to the left of the line.
  std::size_t k1 = corner_at(pieces, hits[1].first, hits[1].second);
  if (hits[0].first == hits[1].first)
    hits[0].second /= hits[1].second; // of what is left of the piece
  const std::size_t n_between = pieces.size();
  const std::size_t k0 = corner_at(pieces, hits[0].first, hits[0].second);
  if (pieces.size() > n_between && k1 > hits[0].first)
    ++k1;
  if (k1 >= pieces.size())
    k1 = 0;
  std::vector<Piece> one = walk(pieces, k0, k1), two = walk(pieces, k1, k0);
  if (one.empty() || two.empty())
    node.fail("edit.line-does-not-cut"_id, "the line runs along an edge of " + panel.name,
              "give a line through its inside");
  double left = 0;
  for (const Piece& piece : one)
    left += side(piece.edge.path[0].at(0.5), from, to - from);
  if (left < 0)
    std::swap(one, two);
  std::string names[2] = {panel.name + "_1", panel.name + "_2"};
  if (node.has("names"))
    for (std::size_t k = 0; k < 2; ++k)
      names[k] = node.at("names").at(k).string();
  for (const std::string& name : names)
    if (name.empty() || names[0] == names[1] ||
        (pattern.find_panel(name) >= 0 && name != panel.name))
      node.fail("edit.name-taken"_id, "the name '" + name + "' is already in use",
                "give two free names");
  const std::string cut = free_edge_name(panel, "cut");
  const Vec2 a0 = start_of(one.front()), a1 = end_of(one.back());
  one.push_back(straight(cut, a1, a0));
  two.push_back(straight(cut, a0, a1));
  std::vector<std::size_t> holes[2];
  for (std::size_t h = 1; h < panel.loops.size(); ++h) {
    int n_left = 0, n = 0;
    for (const PanelEdge& e : panel.loops[h])
      for (const Segment& s : e.path)
        for (double t : {0.0, 0.5}) {
          n_left += side(s.at(t), from, to - from) > 0;
          ++n;
        }
    if (n_left != 0 && n_left != n)
      node.fail("edit.line-does-not-cut"_id, "the line crosses a hole of " + panel.name,
                "cut beside it");
    holes[n_left ? 0 : 1].push_back(h);
  }
  std::vector<Rebuilt> both = {rebuilt(panel, one, holes[0]), rebuilt(panel, two, holes[1])};
  both[0].panel.name = names[0];
  both[1].panel.name = names[1];
  for (std::size_t k = 0; k < 2; ++k) // a line that the cut crosses is in neither
    keep_lines(both[k].panel, [&](const InnerLine& line) {
      const ArcLength arc(line.path);
      for (int i = 0; i <= 16; ++i)
        if (side(arc.at(arc.length() * i / 16), from, to - from) * (k == 0 ? 1 : -1) < -1e-9)
          return false;
      return true;
    });
  const int other = std::ssize(pattern.panels);
  const int edge_one = static_cast<int>(one.size()) - 1,
            edge_two = static_cast<int>(two.size()) - 1;
  replace_panel(pattern, index, std::move(both), node);
  if (node.at("edit").string() == "split" && node.boolean("sew", true))
    pattern.seams.push_back({names[0] + "-" + names[1],
                             "seam",
                             {{index, edge_one, 0, 1}},
                             {{other, edge_two, 1, 0}},
                             ""});
}

void add_point(Pattern& pattern, const io::Node& node) {
  node.allow_only({"edit", "panel", "edge", "at", "names"});
  const int index = panel_named(pattern, node.at("panel"));
  const Panel panel = pattern.panels[index];
  const std::size_t k = static_cast<std::size_t>(outer_edge(panel, node, "edge"));
  const double at = fraction(node, "at"), total = length(panel.edge(static_cast<int>(k)).path);
  if (std::min(at, 1 - at) * total < AT_CORNER)
    node.at("at").fail("edit.already-so"_id, "the edge already has a corner there");
  std::vector<Piece> pieces = pieces_of(panel);
  corner_at(pieces, k, at);
  if (node.has("names"))
    for (std::size_t i = 0; i < 2; ++i)
      pieces[k + i].edge.name = node.at("names").at(i).string();
  replace_panel(pattern, index, {rebuilt(panel, pieces, all_holes(panel))}, node);
}

void join_panels(Pattern& pattern, const io::Node& node) {
  node.allow_only({"edit", "seam", "name"});
  const std::string name = node.at("seam").string();
  const auto seam = std::find_if(pattern.seams.begin(), pattern.seams.end(),
                                 [&](const Seam& s) { return s.name == name; });
  if (seam == pattern.seams.end())
    node.at("seam").fail("edit.no-seam"_id, "there is no seam '" + name + "'");
  const auto whole = [](const std::vector<Run>& side) {
    return side.size() == 1 && std::min(side[0].from, side[0].to) < 1e-9 &&
           std::max(side[0].from, side[0].to) > 1 - 1e-9;
  };
  if (!whole(seam->a) || !whole(seam->b))
    node.at("seam").fail("edit.cannot-join"_id,
                         "seam " + name + " does not join one whole edge to another",
                         "split the edges first");
  Run a = seam->a[0], b = seam->b[0];
  if (a.panel == b.panel)
    node.at("seam").fail("edit.cannot-join"_id, "seam " + name + " joins panel " +
                                                    pattern.panels[a.panel].name + " to itself");
  if ((a.from < a.to) == (b.from < b.to))
    node.at("seam").fail("edit.cannot-join"_id,
                         "seam " + name +
                             " joins the outside of one panel to the inside of the other");
  const Panel p = pattern.panels[a.panel], q = pattern.panels[b.panel];
  if (a.edge >= std::ssize(p.loops[0]) || b.edge >= std::ssize(q.loops[0]))
    node.at("seam").fail("edit.cannot-join"_id, "seam " + name + " is on a hole");
  const Path &pa = p.edge(a.edge).path, &pb = q.edge(b.edge).path;
  // q turns and moves so that its edge lies on p's, the other way round.
  const Vec2 da = pa.back().p[3] - pa.front().p[0], db = pb.front().p[0] - pb.back().p[3];
  if (!(da.norm() > 1e-6 && db.norm() > 1e-6))
    node.at("seam").fail("edit.cannot-join"_id,
                         "the edges of seam " + name + " are closed curves and cannot be joined");
  const double angle = std::atan2(da.y(), da.x()) - std::atan2(db.y(), db.x());
  const Eigen::Matrix2d turn = std::abs(std::remainder(angle, 2 * units::PI)) < 1e-9
                                   ? Eigen::Matrix2d(Eigen::Matrix2d::Identity())
                                   : Eigen::Rotation2Dd(angle).toRotationMatrix();
  const Vec2 middle_a = 0.5 * (pa.back().p[3] + pa.front().p[0]),
             middle_b = 0.5 * (pb.back().p[3] + pb.front().p[0]);
  const auto map = [&](const Vec2& x) { return snapped(Vec2(middle_a + turn * (x - middle_b))); };
  const ArcLength arc_a(pa), arc_b(pb);
  double worst = 0;
  for (int k = 0; k <= 32; ++k)
    worst = std::max(
        worst,
        (arc_a.at(arc_a.length() * k / 32) - map(arc_b.at(arc_b.length() * (32 - k) / 32))).norm());
  if (worst > 1e-3)
    node.at("seam").fail("edit.cannot-join"_id,
                         "the edges of seam " + name + " are " + centimetres(worst) +
                             " apart when laid on each other",
                         "join panels along congruent edges");

  Panel out = p;
  out.name = node.string("name", p.name);
  if (out.name != p.name && out.name != q.name && pattern.find_panel(out.name) >= 0)
    node.at("name").fail("edit.name-taken"_id, "the name '" + out.name + "' is already in use");
  std::vector<int> new_p(static_cast<std::size_t>(p.n_edges()), -1),
      new_q(static_cast<std::size_t>(q.n_edges()), -1);
  out.loops.assign(1, {});
  const int np = static_cast<int>(p.loops[0].size()), nq = static_cast<int>(q.loops[0].size());
  std::vector<std::pair<bool, int>> order; // (from q, edge)
  for (int k = 0; k < np; ++k) {
    if (k != a.edge)
      order.push_back({false, k});
    else
      for (int i = 1; i < nq; ++i)
        order.push_back({true, (b.edge + i) % nq});
  }
  const auto moved = [&](PanelEdge e) {
    for (Segment& s : e.path)
      for (Vec2& x : s.p)
        x = map(x);
    if (p.find_edge(e.name) >= 0)
      e.name = free_edge_name(p, e.name + "_" + q.name);
    return e;
  };
  for (const auto& [other, k] : order) {
    (other ? new_q : new_p)[k] = static_cast<int>(out.loops[0].size());
    out.loops[0].push_back(other ? moved(q.loops[0][k]) : p.loops[0][k]);
  }
  for (std::size_t k = 0; k < out.loops[0].size();
       ++k) { // ends meet to the last bit, p's corners stay
    PanelEdge &e = out.loops[0][k], &next = out.loops[0][(k + 1) % out.loops[0].size()];
    if (order[k].first)
      e.path.back().p[3] = next.path.front().p[0];
    else
      next.path.front().p[0] = e.path.back().p[3];
  }
  int edge = static_cast<int>(out.loops[0].size()), edge_p = np, edge_q = nq;
  for (std::size_t h = 1; h < p.loops.size(); ++h) {
    for (std::size_t k = 0; k < p.loops[h].size(); ++k)
      new_p[edge_p++] = edge++;
    out.loops.push_back(p.loops[h]);
  }
  for (std::size_t h = 1; h < q.loops.size(); ++h) {
    std::vector<PanelEdge> loop;
    for (const PanelEdge& e : q.loops[h]) {
      loop.push_back(moved(e));
      new_q[edge_q++] = edge++;
    }
    out.loops.push_back(loop);
  }
  for (InnerLine line : q.lines) {
    for (Segment& s : line.path)
      for (Vec2& x : s.p)
        x = map(x);
    const auto taken = [&] {
      return std::any_of(out.lines.begin(), out.lines.end(),
                         [&](const InnerLine& l) { return l.name == line.name; });
    };
    while (taken())
      line.name += "_" + q.name;
    out.lines.push_back(std::move(line));
  }
  out.pleats.clear();
  for (const auto& [from, numbers, first] :
       {std::tuple<const Panel*, const std::vector<int>*, int>{&p, &new_p, 0},
        {&q, &new_q, static_cast<int>(p.lines.size())}})
    for (Pleat pleat : from->pleats) {
      pleat.fold += first;
      pleat.target += first;
      for (int& e : pleat.edges)
        e = (*numbers)[e];
      pleat.edges.erase(std::remove(pleat.edges.begin(), pleat.edges.end(), -1), pleat.edges.end());
      if (!pleat.edges.empty())
        out.pleats.push_back(std::move(pleat));
    }
  out.notches.clear();
  for (const auto& [from, numbers] :
       {std::pair<const Panel*, const std::vector<int>*>{&p, &new_p}, {&q, &new_q}})
    for (Notch notch : from->notches)
      if ((notch.edge = (*numbers)[notch.edge]) >= 0)
        out.notches.push_back(notch);
  pattern.seams.erase(seam);
  for (Seam& s : pattern.seams)
    for (auto* list : {&s.a, &s.b})
      for (Run& run : *list) {
        if (run.panel == a.panel)
          run.edge = new_p[run.edge];
        else if (run.panel == b.panel) {
          run.edge = new_q[run.edge];
          run.panel = a.panel;
        }
        if (run.panel > b.panel)
          --run.panel;
      }
  pattern.panels[a.panel] = std::move(out);
  pattern.panels.erase(pattern.panels.begin() + b.panel);
}

} // namespace sloper::pattern
