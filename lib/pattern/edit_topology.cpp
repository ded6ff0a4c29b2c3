/// Edits that change what edges and panels there are: split, cut, join, add-dart, rotate-dart.
#include <io/json.hpp>
#include <pattern/edit_tools.hpp>
#include <pattern/outline_json.hpp>

#include <algorithm>
#include <cmath>

namespace sloper::pattern {
namespace {

constexpr double AT_CORNER = 2e-4; // m: nearer than this to an edge's end is its end

/// An edge of the outer loop while it is taken apart.
struct Piece {
  PanelEdge edge;
  Origin origin;
};

std::vector<Piece> pieces_of(const Panel& panel) {
  std::vector<Piece> out;
  for (std::size_t k = 0; k < panel.loops[0].size(); ++k) out.push_back({panel.loops[0][k], {static_cast<int>(k), 0, 1}});
  return out;
}

const Vec2& start_of(const Piece& piece) { return piece.edge.path.front().p[0]; }
const Vec2& end_of(const Piece& piece) { return piece.edge.path.back().p[3]; }

/// Cuts a piece at a fraction of its length; the parts are named name_1 and name_2.
std::pair<Piece, Piece> cut_piece(const Piece& piece, double at) {
  const ArcLength arc(piece.edge.path);
  const double s = at * arc.length(), middle = piece.origin.from + at * (piece.origin.to - piece.origin.from);
  Piece one{{piece.edge.name + "_1", arc.between(0, s)}, {piece.origin.edge, piece.origin.from, middle}};
  Piece two{{piece.edge.name + "_2", arc.between(s, arc.length())}, {piece.origin.edge, middle, piece.origin.to}};
  const Vec2 corner = snapped(end_of(one));
  one.edge.path.back().p[3] = two.edge.path.front().p[0] = corner;
  for (auto* p : {&one.edge.path.back(), &two.edge.path.front()})
    if (p->line) *p = Segment::straight(p->p[0], p->p[3]);
  return {one, two};
}

Piece straight(const std::string& name, const Vec2& a, const Vec2& b) { return {{name, {Segment::straight(a, b)}}, {}}; }

/// Makes sure that a corner lies at a fraction of a piece. @return the index of the piece that starts there
std::size_t corner_at(std::vector<Piece>& pieces, std::size_t k, double at) {
  const double length = pattern::length(pieces[k].edge.path);
  if (at * length < AT_CORNER) return k;
  if ((1 - at) * length < AT_CORNER) return (k + 1) % pieces.size();
  auto [one, two] = cut_piece(pieces[k], at);
  pieces[k] = one;
  pieces.insert(pieces.begin() + static_cast<long>(k) + 1, two);
  return k + 1;
}

Rebuilt rebuilt(const Panel& like, const std::vector<Piece>& outer, const std::vector<std::size_t>& holes) {
  Rebuilt out;
  out.panel = like;
  out.panel.loops.clear(), out.panel.notches.clear();
  out.panel.loops.push_back({});
  for (const Piece& piece : outer) {
    PanelEdge edge = piece.edge;
    if (out.panel.find_edge(edge.name) >= 0) edge.name = free_edge_name(out.panel, edge.name + "_");
    out.panel.loops[0].push_back(std::move(edge)), out.origin.push_back(piece.origin);
  }
  for (std::size_t h : holes) {
    int edge = 0;
    for (std::size_t l = 0; l < h; ++l) edge += static_cast<int>(like.loops[l].size());
    for (std::size_t k = 0; k < like.loops[h].size(); ++k) out.origin.push_back({edge + static_cast<int>(k), 0, 1});
    out.panel.loops.push_back(like.loops[h]);
  }
  return out;
}

std::vector<std::size_t> all_holes(const Panel& panel) {
  std::vector<std::size_t> out;
  for (std::size_t h = 1; h < panel.loops.size(); ++h) out.push_back(h);
  return out;
}

std::vector<Piece> walk(const std::vector<Piece>& pieces, std::size_t from, std::size_t to) {
  std::vector<Piece> out;
  for (std::size_t k = from; k != to; k = (k + 1) % pieces.size()) out.push_back(pieces[k]);
  return out;
}

double side(const Vec2& p, const Vec2& a, const Vec2& along) { return along.x() * (p - a).y() - along.y() * (p - a).x(); }

/// Where the line crosses the outer loop: (piece, fraction), corners once.
std::vector<std::pair<std::size_t, double>> crossings(const std::vector<Piece>& pieces, const Vec2& a, const Vec2& along) {
  std::vector<std::pair<std::size_t, double>> out;
  std::vector<Vec2> found;
  constexpr int N = 256;
  for (std::size_t k = 0; k < pieces.size(); ++k) {
    const ArcLength arc(pieces[k].edge.path);
    const auto value = [&](double f) { return side(arc.at(f * arc.length()), a, along); };
    for (int i = 0; i < N; ++i) {
      double low = static_cast<double>(i) / N, high = static_cast<double>(i + 1) / N;
      double v0 = value(low), v1 = value(high);
      if (std::abs(v0) < 1e-9) v0 = 0;
      if (std::abs(v1) < 1e-9) v1 = 0;
      if (v0 * v1 > 0 || v1 == 0) continue; // an end on the line belongs to the next stretch
      if (v0 != 0)
        for (int turn = 0; turn < 60; ++turn) {
          const double middle = 0.5 * (low + high);
          (value(middle) * v0 > 0 ? low : high) = middle;
        }
      const Vec2 p = arc.at(low * arc.length());
      if (std::any_of(found.begin(), found.end(), [&](const Vec2& q) { return (p - q).norm() < AT_CORNER; })) continue;
      found.push_back(p);
      out.push_back({k, low});
    }
  }
  return out;
}

int outer_edge(const Panel& panel, const io::Node& node, const char* key) {
  const int edge = edge_named(panel, node.at(key));
  if (edge >= static_cast<int>(panel.loops[0].size())) node.at(key).fail("edge '" + panel.edge(edge).name + "' is on a hole", "name an edge of the outline");
  return edge;
}

double fraction(const io::Node& node, const char* key) {
  const double at = node.at(key).number();
  if (!(at >= 0 && at <= 1)) node.at(key).fail(std::to_string(at) + " is no place on an edge", "give a fraction from 0 to 1");
  return at;
}

bool inside(const Panel& panel, const Vec2& p) {
  bool in = false;
  for (const PanelEdge& e : panel.loops[0]) {
    const ArcLength arc(e.path);
    const int n = 64 * static_cast<int>(e.path.size());
    for (int k = 0; k < n; ++k) {
      const Vec2 a = arc.at(arc.length() * k / n), b = arc.at(arc.length() * (k + 1) / n);
      if ((a.y() > p.y()) != (b.y() > p.y()) && p.x() < a.x() + (p.y() - a.y()) / (b.y() - a.y()) * (b.x() - a.x())) in = !in;
    }
  }
  return in;
}

} // namespace

std::vector<Origin> cut_edges(Pattern& pattern, int p, const std::vector<std::pair<int, double>>& places) {
  const Panel panel = pattern.panels[static_cast<std::size_t>(p)];
  std::vector<std::pair<int, double>> order = places; // the last first, so that what comes before keeps its number
  std::sort(order.begin(), order.end(), [](const auto& a, const auto& b) { return a > b; });
  std::vector<Piece> pieces = pieces_of(panel);
  std::vector<double> left(pieces.size(), 1); // fraction of each edge that its first piece still has
  for (const auto& [edge, at] : order) {
    double& whole = left[static_cast<std::size_t>(edge)];
    const std::size_t before = pieces.size();
    if (at < whole) corner_at(pieces, static_cast<std::size_t>(edge), at / whole);
    if (pieces.size() > before) whole = at;
  }
  Rebuilt out = rebuilt(panel, pieces, all_holes(panel));
  const std::vector<Origin> origin = out.origin;
  static const io::Json NOTHING;
  replace_panel(pattern, p, {std::move(out)}, io::Node(NOTHING, panel.name));
  return origin;
}

void keep_lines(Panel& panel, const std::function<bool(const InnerLine&)>& pass) {
  std::vector<int> number;
  std::vector<InnerLine> kept;
  for (const InnerLine& line : panel.lines) {
    number.push_back(pass(line) ? static_cast<int>(kept.size()) : -1);
    if (number.back() >= 0) kept.push_back(line);
  }
  std::vector<Pleat> pleats;
  for (Pleat pleat : panel.pleats) {
    pleat.fold = number[static_cast<std::size_t>(pleat.fold)], pleat.target = number[static_cast<std::size_t>(pleat.target)];
    if (pleat.fold >= 0 && pleat.target >= 0 && !pleat.edges.empty()) pleats.push_back(pleat);
  }
  panel.lines = std::move(kept), panel.pleats = std::move(pleats);
}

std::string free_edge_name(const Panel& panel, const std::string& wanted) {
  std::string name = wanted;
  for (int k = 2; panel.find_edge(name) >= 0; ++k) name = wanted + std::to_string(k);
  return name;
}

void replace_panel(Pattern& pattern, int p, std::vector<Rebuilt> panels, const io::Node& node) {
  const Panel old = pattern.panels[static_cast<std::size_t>(p)];
  std::vector<int> index;
  for (std::size_t k = 0; k < panels.size(); ++k) index.push_back(k == 0 ? p : static_cast<int>(pattern.panels.size() + k - 1));
  struct Stretch {
    double from, to;
    int panel, edge;
  };
  std::vector<std::vector<Stretch>> stretches(static_cast<std::size_t>(old.n_edges()));
  for (std::size_t k = 0; k < panels.size(); ++k)
    for (std::size_t e = 0; e < panels[k].origin.size(); ++e)
      if (const Origin& o = panels[k].origin[e]; o.edge >= 0)
        stretches[static_cast<std::size_t>(o.edge)].push_back({o.from, o.to, index[k], static_cast<int>(e)});
  for (auto& list : stretches) std::sort(list.begin(), list.end(), [](const Stretch& a, const Stretch& b) { return a.from < b.from; });
  for (Seam& seam : pattern.seams)
    for (auto* side : {&seam.a, &seam.b}) {
      std::vector<Run> runs;
      for (const Run& run : *side) {
        if (run.panel != p) {
          runs.push_back(run);
          continue;
        }
        std::vector<Run> parts;
        const double low = std::min(run.from, run.to), high = std::max(run.from, run.to);
        for (const Stretch& s : stretches[static_cast<std::size_t>(run.edge)]) {
          const double from = std::max(low, s.from), to = std::min(high, s.to), span = s.to - s.from;
          if (to - from < 1e-9) continue;
          const auto local = [&](double f) { return f - s.from < 1e-9 ? 0.0 : s.to - f < 1e-9 ? 1.0 : (f - s.from) / span; };
          parts.push_back({s.panel, s.edge, local(from), local(to)});
        }
        if (run.from > run.to) {
          std::reverse(parts.begin(), parts.end());
          for (Run& part : parts) std::swap(part.from, part.to);
        }
        runs.insert(runs.end(), parts.begin(), parts.end());
      }
      if (runs.empty()) node.fail("nothing would be left of a side of seam " + seam.name, "take out the seam first, or cut elsewhere");
      *side = std::move(runs);
    }
  for (const Notch& notch : old.notches)
    for (const Stretch& s : stretches[static_cast<std::size_t>(notch.edge)])
      if (notch.at >= s.from && notch.at <= s.to && s.to > s.from) {
        Panel& panel = panels[static_cast<std::size_t>(std::find(index.begin(), index.end(), s.panel) - index.begin())].panel;
        panel.notches.push_back({s.edge, (notch.at - s.from) / (s.to - s.from), notch.kind});
        break;
      }
  for (std::size_t k = 0; k < panels.size(); ++k)
    for (Pleat& pleat : panels[k].panel.pleats) {
      std::vector<int> edges;
      for (int e : pleat.edges)
        for (const Stretch& s : stretches[static_cast<std::size_t>(e)])
          if (s.panel == index[k]) edges.push_back(s.edge);
      pleat.edges = std::move(edges);
    }
  for (std::size_t k = 0; k < panels.size(); ++k) {
    if (k == 0) pattern.panels[static_cast<std::size_t>(p)] = std::move(panels[k].panel);
    else pattern.panels.push_back(std::move(panels[k].panel));
  }
}

void split_panel(Pattern& pattern, const io::Node& node, double unit) {
  node.allow_only({"edit", "panel", "from", "to", "names", "sew"});
  const int index = panel_named(pattern, node.at("panel"));
  const Panel panel = pattern.panels[static_cast<std::size_t>(index)];
  const Vec2 from = node.at("from").vec2() * unit, to = node.at("to").vec2() * unit;
  if (!((to - from).norm() > 1e-4)) node.at("to").fail("the line has no direction");
  std::vector<Piece> pieces = pieces_of(panel);
  auto hits = crossings(pieces, from, to - from);
  if (hits.size() != 2)
    node.fail("the line crosses the outline of " + panel.name + " in " + std::to_string(hits.size()) + " places", "give a line that crosses it twice");
  // The second first, so that the first keeps its number. A: what lies to the left of the line.
  std::size_t k1 = corner_at(pieces, hits[1].first, hits[1].second);
  if (hits[0].first == hits[1].first) hits[0].second /= hits[1].second; // of what is left of the piece
  const std::size_t n_between = pieces.size();
  const std::size_t k0 = corner_at(pieces, hits[0].first, hits[0].second);
  if (pieces.size() > n_between && k1 > hits[0].first) ++k1;
  if (k1 >= pieces.size()) k1 = 0;
  std::vector<Piece> one = walk(pieces, k0, k1), two = walk(pieces, k1, k0);
  if (one.empty() || two.empty()) node.fail("the line runs along an edge of " + panel.name, "give a line through its inside");
  double left = 0;
  for (const Piece& piece : one) left += side(piece.edge.path[0].at(0.5), from, to - from);
  if (left < 0) std::swap(one, two);
  std::string names[2] = {panel.name + "_1", panel.name + "_2"};
  if (node.has("names"))
    for (std::size_t k = 0; k < 2; ++k) names[k] = node.at("names").at(k).string();
  for (const std::string& name : names)
    if (name.empty() || names[0] == names[1] || (pattern.find_panel(name) >= 0 && name != panel.name))
      node.fail("the name '" + name + "' is taken", "give two free names");
  const std::string cut = free_edge_name(panel, "cut");
  const Vec2 a0 = start_of(one.front()), a1 = end_of(one.back());
  one.push_back(straight(cut, a1, a0)), two.push_back(straight(cut, a0, a1));
  std::vector<std::size_t> holes[2];
  for (std::size_t h = 1; h < panel.loops.size(); ++h) {
    int n_left = 0, n = 0;
    for (const PanelEdge& e : panel.loops[h])
      for (const Segment& s : e.path)
        for (double t : {0.0, 0.5}) n_left += side(s.at(t), from, to - from) > 0, ++n;
    if (n_left != 0 && n_left != n) node.fail("the line goes through a hole of " + panel.name, "cut beside it");
    holes[n_left ? 0 : 1].push_back(h);
  }
  std::vector<Rebuilt> both = {rebuilt(panel, one, holes[0]), rebuilt(panel, two, holes[1])};
  both[0].panel.name = names[0], both[1].panel.name = names[1];
  for (std::size_t k = 0; k < 2; ++k) // a line that the cut crosses is in neither
    keep_lines(both[k].panel, [&](const InnerLine& line) {
      const ArcLength arc(line.path);
      for (int i = 0; i <= 16; ++i)
        if (side(arc.at(arc.length() * i / 16), from, to - from) * (k == 0 ? 1 : -1) < -1e-9) return false;
      return true;
    });
  const int other = static_cast<int>(pattern.panels.size());
  const int edge_one = static_cast<int>(one.size()) - 1, edge_two = static_cast<int>(two.size()) - 1;
  replace_panel(pattern, index, std::move(both), node);
  if (node.at("edit").string() == "split" && node.boolean("sew", true))
    pattern.seams.push_back({names[0] + "-" + names[1], "seam", {{index, edge_one, 0, 1}}, {{other, edge_two, 1, 0}}, ""});
}

void add_point(Pattern& pattern, const io::Node& node) {
  node.allow_only({"edit", "panel", "edge", "at", "names"});
  const int index = panel_named(pattern, node.at("panel"));
  const Panel panel = pattern.panels[static_cast<std::size_t>(index)];
  const std::size_t k = static_cast<std::size_t>(outer_edge(panel, node, "edge"));
  const double at = fraction(node, "at"), total = length(panel.edge(static_cast<int>(k)).path);
  if (std::min(at, 1 - at) * total < AT_CORNER) node.at("at").fail("there is a corner already");
  std::vector<Piece> pieces = pieces_of(panel);
  corner_at(pieces, k, at);
  if (node.has("names"))
    for (std::size_t i = 0; i < 2; ++i) pieces[k + i].edge.name = node.at("names").at(i).string();
  replace_panel(pattern, index, {rebuilt(panel, pieces, all_holes(panel))}, node);
}

void join_panels(Pattern& pattern, const io::Node& node) {
  node.allow_only({"edit", "seam", "name"});
  const std::string name = node.at("seam").string();
  const auto seam = std::find_if(pattern.seams.begin(), pattern.seams.end(), [&](const Seam& s) { return s.name == name; });
  if (seam == pattern.seams.end()) node.at("seam").fail("there is no seam '" + name + "'");
  const auto whole = [](const std::vector<Run>& side) {
    return side.size() == 1 && std::min(side[0].from, side[0].to) < 1e-9 && std::max(side[0].from, side[0].to) > 1 - 1e-9;
  };
  if (!whole(seam->a) || !whole(seam->b)) node.at("seam").fail("seam " + name + " does not join one whole edge to another", "split the edges first");
  Run a = seam->a[0], b = seam->b[0];
  if (a.panel == b.panel) node.at("seam").fail("seam " + name + " joins panel " + pattern.panels[static_cast<std::size_t>(a.panel)].name + " to itself");
  if ((a.from < a.to) == (b.from < b.to)) node.at("seam").fail("seam " + name + " joins an outside to an inside");
  const Panel p = pattern.panels[static_cast<std::size_t>(a.panel)], q = pattern.panels[static_cast<std::size_t>(b.panel)];
  if (a.edge >= static_cast<int>(p.loops[0].size()) || b.edge >= static_cast<int>(q.loops[0].size())) node.at("seam").fail("seam " + name + " is on a hole");
  const Path &pa = p.edge(a.edge).path, &pb = q.edge(b.edge).path;
  // q turns and moves so that its edge lies on p's, the other way round.
  const Vec2 da = pa.back().p[3] - pa.front().p[0], db = pb.front().p[0] - pb.back().p[3];
  if (!(da.norm() > 1e-6 && db.norm() > 1e-6)) node.at("seam").fail("the edges of seam " + name + " end where they start");
  const double angle = std::atan2(da.y(), da.x()) - std::atan2(db.y(), db.x());
  const Eigen::Matrix2d turn =
      std::abs(std::remainder(angle, 2 * M_PI)) < 1e-9 ? Eigen::Matrix2d(Eigen::Matrix2d::Identity()) : Eigen::Rotation2Dd(angle).toRotationMatrix();
  const Vec2 middle_a = 0.5 * (pa.back().p[3] + pa.front().p[0]), middle_b = 0.5 * (pb.back().p[3] + pb.front().p[0]);
  const auto map = [&](const Vec2& x) { return snapped(Vec2(middle_a + turn * (x - middle_b))); };
  const ArcLength arc_a(pa), arc_b(pb);
  double worst = 0;
  for (int k = 0; k <= 32; ++k) worst = std::max(worst, (arc_a.at(arc_a.length() * k / 32) - map(arc_b.at(arc_b.length() * (32 - k) / 32))).norm());
  if (worst > 1e-3)
    node.at("seam").fail("the edges of seam " + name + " are " + centimetres(worst) + " apart when laid on each other", "join panels along congruent edges");

  Panel out = p;
  out.name = node.string("name", p.name);
  if (out.name != p.name && out.name != q.name && pattern.find_panel(out.name) >= 0) node.at("name").fail("the name '" + out.name + "' is taken");
  std::vector<int> new_p(static_cast<std::size_t>(p.n_edges()), -1), new_q(static_cast<std::size_t>(q.n_edges()), -1);
  out.loops.assign(1, {});
  const int np = static_cast<int>(p.loops[0].size()), nq = static_cast<int>(q.loops[0].size());
  std::vector<std::pair<bool, int>> order; // (from q, edge)
  for (int k = 0; k < np; ++k) {
    if (k != a.edge) order.push_back({false, k});
    else
      for (int i = 1; i < nq; ++i) order.push_back({true, (b.edge + i) % nq});
  }
  const auto moved = [&](PanelEdge e) {
    for (Segment& s : e.path)
      for (Vec2& x : s.p) x = map(x);
    if (p.find_edge(e.name) >= 0) e.name = free_edge_name(p, e.name + "_" + q.name);
    return e;
  };
  for (const auto& [other, k] : order) {
    (other ? new_q : new_p)[static_cast<std::size_t>(k)] = static_cast<int>(out.loops[0].size());
    out.loops[0].push_back(other ? moved(q.loops[0][static_cast<std::size_t>(k)]) : p.loops[0][static_cast<std::size_t>(k)]);
  }
  for (std::size_t k = 0; k < out.loops[0].size(); ++k) { // ends meet to the last bit, p's corners stay
    PanelEdge &e = out.loops[0][k], &next = out.loops[0][(k + 1) % out.loops[0].size()];
    if (order[k].first) e.path.back().p[3] = next.path.front().p[0];
    else next.path.front().p[0] = e.path.back().p[3];
  }
  int edge = static_cast<int>(out.loops[0].size()), edge_p = np, edge_q = nq;
  for (std::size_t h = 1; h < p.loops.size(); ++h) {
    for (std::size_t k = 0; k < p.loops[h].size(); ++k) new_p[static_cast<std::size_t>(edge_p++)] = edge++;
    out.loops.push_back(p.loops[h]);
  }
  for (std::size_t h = 1; h < q.loops.size(); ++h) {
    std::vector<PanelEdge> loop;
    for (const PanelEdge& e : q.loops[h]) loop.push_back(moved(e)), new_q[static_cast<std::size_t>(edge_q++)] = edge++;
    out.loops.push_back(loop);
  }
  for (InnerLine line : q.lines) {
    for (Segment& s : line.path)
      for (Vec2& x : s.p) x = map(x);
    const auto taken = [&] { return std::any_of(out.lines.begin(), out.lines.end(), [&](const InnerLine& l) { return l.name == line.name; }); };
    while (taken()) line.name += "_" + q.name;
    out.lines.push_back(std::move(line));
  }
  out.pleats.clear();
  for (const auto& [from, numbers, first] :
       {std::tuple<const Panel*, const std::vector<int>*, int>{&p, &new_p, 0}, {&q, &new_q, static_cast<int>(p.lines.size())}})
    for (Pleat pleat : from->pleats) {
      pleat.fold += first, pleat.target += first;
      for (int& e : pleat.edges) e = (*numbers)[static_cast<std::size_t>(e)];
      pleat.edges.erase(std::remove(pleat.edges.begin(), pleat.edges.end(), -1), pleat.edges.end());
      if (!pleat.edges.empty()) out.pleats.push_back(std::move(pleat));
    }
  out.notches.clear();
  for (const auto& [from, numbers] : {std::pair<const Panel*, const std::vector<int>*>{&p, &new_p}, {&q, &new_q}})
    for (Notch notch : from->notches)
      if ((notch.edge = (*numbers)[static_cast<std::size_t>(notch.edge)]) >= 0) out.notches.push_back(notch);
  pattern.seams.erase(seam);
  for (Seam& s : pattern.seams)
    for (auto* list : {&s.a, &s.b})
      for (Run& run : *list) {
        if (run.panel == a.panel) run.edge = new_p[static_cast<std::size_t>(run.edge)];
        else if (run.panel == b.panel) run.edge = new_q[static_cast<std::size_t>(run.edge)], run.panel = a.panel;
        if (run.panel > b.panel) --run.panel;
      }
  pattern.panels[static_cast<std::size_t>(a.panel)] = std::move(out);
  pattern.panels.erase(pattern.panels.begin() + b.panel);
}

void add_dart(Pattern& pattern, const io::Node& node, double unit) {
  node.allow_only({"edit", "panel", "edge", "at", "width", "tip", "name", "center", "length", "along"});
  const int index = panel_named(pattern, node.at("panel"));
  const Panel panel = pattern.panels[static_cast<std::size_t>(index)];
  const double width = node.at("width").number() * unit;
  if (!(width > 1e-3)) node.at("width").fail("a dart of " + centimetres(width) + " is none", "give more than 0.1 cm");
  std::string name = node.string("name", panel.name + "-dart");
  for (int k = 2; std::any_of(pattern.seams.begin(), pattern.seams.end(), [&](const Seam& s) { return s.name == name; }); ++k) {
    if (node.has("name")) node.at("name").fail("there is a seam '" + name + "' already");
    name = panel.name + "-dart" + std::to_string(k);
  }
  const std::string leg_a = free_edge_name(panel, name + "_a"), leg_b = free_edge_name(panel, name + "_b");
  std::vector<Piece> pieces = pieces_of(panel);
  if (node.has("center")) { // a fisheye: a hole whose two sides are sewn together
    const double half = 0.5 * node.at("length").number() * unit;
    const Vec2 center = node.at("center").vec2() * unit, way = node.has("along") ? node.at("along").vec2() : Vec2(0, 1);
    if (!(half > width) || !(way.norm() > 0)) node.at("length").fail("a fisheye dart is longer than it is wide", "give its length along the middle");
    const Vec2 u = way.normalized(), v(-u.y(), u.x());
    const Vec2 corner[4] = {snapped(Vec2(center - half * u)), snapped(Vec2(center + 0.5 * width * v)), snapped(Vec2(center + half * u)),
                            snapped(Vec2(center - 0.5 * width * v))};
    for (const Vec2& c : corner)
      if (!inside(panel, c)) node.at("center").fail("the dart leaves panel " + panel.name, "move its center, or make it smaller");
    Rebuilt out = rebuilt(panel, pieces, all_holes(panel));
    const int first = out.panel.n_edges(); // clockwise: left side up, right side down
    out.panel.loops.push_back({{leg_a, {Segment::straight(corner[0], corner[1]), Segment::straight(corner[1], corner[2])}},
                               {leg_b, {Segment::straight(corner[2], corner[3]), Segment::straight(corner[3], corner[0])}}});
    out.origin.push_back({}), out.origin.push_back({});
    replace_panel(pattern, index, {std::move(out)}, node);
    pattern.seams.push_back({name, "dart", {{index, first, 0, 1}}, {{index, first + 1, 1, 0}}, ""});
    return;
  }
  const std::size_t k = static_cast<std::size_t>(outer_edge(panel, node, "edge"));
  const double total = length(panel.edge(static_cast<int>(k)).path), at = fraction(node, "at");
  const double from = at - 0.5 * width / total, to = at + 0.5 * width / total;
  if (from * total < AT_CORNER || (1 - to) * total < AT_CORNER)
    node.at("at").fail("a dart of " + centimetres(width) + " at " + std::to_string(at) + " of " + panel.edge(static_cast<int>(k)).name + " (" +
                           centimetres(total) + ") goes past its end",
                       "move it inwards");
  const Vec2 tip = snapped(Vec2(node.at("tip").vec2() * unit));
  if (!inside(panel, tip)) node.at("tip").fail("the tip lies outside of panel " + panel.name);
  const Piece whole = pieces[k];
  auto [one, rest] = cut_piece(whole, from);
  auto [gone, two] = cut_piece(rest, (to - from) / (1 - from));
  two.edge.name = whole.edge.name + "_2";
  const std::vector<Piece> instead = {one, straight(leg_a, end_of(one), tip), straight(leg_b, tip, start_of(two)), two};
  pieces.erase(pieces.begin() + static_cast<long>(k));
  pieces.insert(pieces.begin() + static_cast<long>(k), instead.begin(), instead.end());
  replace_panel(pattern, index, {rebuilt(panel, pieces, all_holes(panel))}, node);
  pattern.seams.push_back({name, "dart", {{index, static_cast<int>(k) + 1, 0, 1}}, {{index, static_cast<int>(k) + 2, 1, 0}}, ""});
}

void rotate_dart(Pattern& pattern, const io::Node& node) {
  node.allow_only({"edit", "dart", "edge", "at"});
  const std::string name = node.at("dart").string();
  const auto seam = std::find_if(pattern.seams.begin(), pattern.seams.end(), [&](const Seam& s) { return s.name == name; });
  if (seam == pattern.seams.end()) node.at("dart").fail("there is no seam '" + name + "'");
  if (seam->a.size() != 1 || seam->b.size() != 1 || seam->a[0].panel != seam->b[0].panel) node.at("dart").fail("seam " + name + " is no dart");
  const int index = seam->a[0].panel;
  const Panel panel = pattern.panels[static_cast<std::size_t>(index)];
  const int n = static_cast<int>(panel.loops[0].size());
  int leg = seam->a[0].edge, second = seam->b[0].edge;
  if ((second + 1) % n == leg) std::swap(leg, second);
  if (leg >= n || second >= n || (leg + 1) % n != second)
    node.at("dart").fail("seam " + name + " is no edge dart", "only darts that end in the outline can be rotated");
  std::vector<Piece> pieces = pieces_of(panel);
  const Piece one = pieces[static_cast<std::size_t>(leg)], two = pieces[static_cast<std::size_t>(second)];
  const Vec2 tip = end_of(one), a = start_of(one), b = end_of(two);
  if (std::abs((a - tip).norm() - (b - tip).norm()) > 1e-3)
    node.at("dart").fail("the legs of dart " + name + " differ by " + centimetres(std::abs((a - tip).norm() - (b - tip).norm())), "make them equal first");
  const std::size_t wanted = static_cast<std::size_t>(outer_edge(panel, node, "edge"));
  if (static_cast<int>(wanted) == leg || static_cast<int>(wanted) == second) node.at("edge").fail("the dart cannot open in its own leg");
  // The new opening; the legs stay beside each other while it is made.
  const std::size_t opening = corner_at(pieces, wanted, fraction(node, "at"));
  const auto find = [&](int edge) {
    std::size_t k = 0;
    while (pieces[k].origin.edge != edge) ++k;
    return k;
  };
  const std::size_t first = find(leg), last = (first + 1) % pieces.size(), after = (last + 1) % pieces.size();
  if (opening == first || opening == after) node.at("at").fail("the dart opens there already");
  std::vector<Piece> turned = walk(pieces, after, opening), still = walk(pieces, opening, first);
  // The shorter part of the outline between dart and opening turns about the tip until the legs meet.
  const auto total = [](const std::vector<Piece>& list) {
    double sum = 0;
    for (const Piece& piece : list) sum += length(piece.edge.path);
    return sum;
  };
  const double between = std::atan2((a - tip).y(), (a - tip).x()) - std::atan2((b - tip).y(), (b - tip).x());
  const bool all_but = total(still) < total(turned);
  const Eigen::Matrix2d turn = Eigen::Rotation2Dd(all_but ? -between : between).toRotationMatrix();
  for (Piece& piece : all_but ? still : turned)
    for (Segment& s : piece.edge.path)
      for (Vec2& p : s.p) p = snapped(Vec2(tip + turn * (p - tip)));
  if (all_but) still.back().edge.path.back().p[3] = b;
  else turned.front().edge.path.front().p[0] = a;
  Piece new_one = straight(one.edge.name, end_of(turned.back()), tip), new_two = straight(two.edge.name, tip, start_of(still.front()));
  new_one.origin = one.origin, new_two.origin = two.origin;
  std::vector<Piece> outer = still;
  outer.insert(outer.end(), turned.begin(), turned.end());
  outer.push_back(new_one), outer.push_back(new_two);
  replace_panel(pattern, index, {rebuilt(panel, outer, all_holes(panel))}, node);
}

} // namespace sloper::pattern
