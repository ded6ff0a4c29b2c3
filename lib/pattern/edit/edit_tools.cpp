#include <pattern/edit/edit_tools.hpp>
#include <pattern/read/outline_json.hpp>
#include <sloper/base/text.hpp>
#include <sloper/io/json.hpp>

#include <algorithm>
#include <cmath>

namespace sloper::pattern {

std::vector<Piece> pieces_of(const Panel& panel) {
  std::vector<Piece> out;
  for (std::size_t k = 0; k < panel.loops[0].size(); ++k)
    out.push_back({panel.loops[0][k], {static_cast<int>(k), 0, 1}});
  return out;
}

const Vec2& start_of(const Piece& piece) {
  return piece.edge.path.front().p[0];
}
const Vec2& end_of(const Piece& piece) {
  return piece.edge.path.back().p[3];
}

std::pair<Piece, Piece> cut_piece(const Piece& piece, double at) {
  const ArcLength arc(piece.edge.path);
  const double s = at * arc.length(),
               middle = piece.origin.from + at * (piece.origin.to - piece.origin.from);
  Piece one{{piece.edge.name + "_1", arc.between(0, s)},
            {piece.origin.edge, piece.origin.from, middle}};
  Piece two{{piece.edge.name + "_2", arc.between(s, arc.length())},
            {piece.origin.edge, middle, piece.origin.to}};
  const Vec2 corner = snapped(end_of(one));
  one.edge.path.back().p[3] = two.edge.path.front().p[0] = corner;
  for (auto* p : {&one.edge.path.back(), &two.edge.path.front()})
    if (p->line)
      *p = Segment::straight(p->p[0], p->p[3]);
  return {one, two};
}

Piece straight(const std::string& name, const Vec2& a, const Vec2& b) {
  return {{name, {Segment::straight(a, b)}}, {}};
}

std::size_t corner_at(std::vector<Piece>& pieces, std::size_t k, double at) {
  const double length = pattern::length(pieces[k].edge.path);
  if (at * length < AT_CORNER)
    return k;
  if ((1 - at) * length < AT_CORNER)
    return (k + 1) % pieces.size();
  auto [one, two] = cut_piece(pieces[k], at);
  pieces[k] = one;
  pieces.insert(pieces.begin() + static_cast<long>(k) + 1, two);
  return k + 1;
}

Rebuilt rebuilt(const Panel& like, const std::vector<Piece>& outer,
                const std::vector<std::size_t>& holes) {
  Rebuilt out;
  out.panel = like;
  out.panel.loops.clear();
  out.panel.notches.clear();
  out.panel.loops.push_back({});
  for (const Piece& piece : outer) {
    PanelEdge edge = piece.edge;
    if (out.panel.find_edge(edge.name) >= 0)
      edge.name = free_edge_name(out.panel, edge.name + "_");
    out.panel.loops[0].push_back(std::move(edge));
    out.origin.push_back(piece.origin);
  }
  for (std::size_t h : holes) {
    int edge = 0;
    for (std::size_t l = 0; l < h; ++l)
      edge += static_cast<int>(like.loops[l].size());
    for (std::size_t k = 0; k < like.loops[h].size(); ++k)
      out.origin.push_back({edge + static_cast<int>(k), 0, 1});
    out.panel.loops.push_back(like.loops[h]);
  }
  return out;
}

std::vector<std::size_t> all_holes(const Panel& panel) {
  std::vector<std::size_t> out;
  for (std::size_t h = 1; h < panel.loops.size(); ++h)
    out.push_back(h);
  return out;
}

std::vector<Piece> walk(const std::vector<Piece>& pieces, std::size_t from, std::size_t to) {
  std::vector<Piece> out;
  for (std::size_t k = from; k != to; k = (k + 1) % pieces.size())
    out.push_back(pieces[k]);
  return out;
}

int outer_edge(const Panel& panel, const io::Node& node, const char* key) {
  const int edge = edge_named(panel, node.at(key));
  if (edge >= std::ssize(panel.loops[0]))
    node.at(key).fail("edit.edge-on-hole"_id, "edge '" + panel.edge(edge).name + "' is on a hole",
                      "name an edge of the outline");
  return edge;
}

double fraction(const io::Node& node, const char* key) {
  const double at = node.at(key).number();
  if (!(at >= 0 && at <= 1))
    node.at(key).fail("json.out-of-range"_id, decimals(at, 3) + " is not a place on an edge",
                      "give a fraction from 0 to 1");
  return at;
}

std::vector<Origin> cut_edges(Pattern& pattern, int p,
                              const std::vector<std::pair<int, double>>& places) {
  const Panel panel = pattern.panels[p];
  std::vector<std::pair<int, double>> order =
      places; // the last first, so that what comes before keeps its number
  std::sort(order.begin(), order.end(), [](const auto& a, const auto& b) { return a > b; });
  std::vector<Piece> pieces = pieces_of(panel);
  std::vector<double> left(pieces.size(),
                           1); // fraction of each edge that its first piece still has
  for (const auto& [edge, at] : order) {
    double& whole = left[edge];
    const std::size_t before = pieces.size();
    if (at < whole)
      corner_at(pieces, static_cast<std::size_t>(edge), at / whole);
    if (pieces.size() > before)
      whole = at;
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
    if (number.back() >= 0)
      kept.push_back(line);
  }
  std::vector<Pleat> pleats;
  for (Pleat pleat : panel.pleats) {
    pleat.fold = number[pleat.fold];
    pleat.target = number[pleat.target];
    if (pleat.fold >= 0 && pleat.target >= 0 && !pleat.edges.empty())
      pleats.push_back(pleat);
  }
  panel.lines = std::move(kept);
  panel.pleats = std::move(pleats);
}

std::string free_edge_name(const Panel& panel, const std::string& wanted) {
  std::string name = wanted;
  for (int k = 2; panel.find_edge(name) >= 0; ++k)
    name = wanted + std::to_string(k);
  return name;
}

void replace_panel(Pattern& pattern, int p, std::vector<Rebuilt> panels, const io::Node& node) {
  const Panel old = pattern.panels[p];
  std::vector<int> index;
  for (std::size_t k = 0; k < panels.size(); ++k)
    index.push_back(k == 0 ? p : static_cast<int>(pattern.panels.size() + k - 1));
  struct Stretch {
    double from, to;
    int panel, edge;
  };
  std::vector<std::vector<Stretch>> stretches(static_cast<std::size_t>(old.n_edges()));
  for (std::size_t k = 0; k < panels.size(); ++k)
    for (std::size_t e = 0; e < panels[k].origin.size(); ++e)
      if (const Origin& o = panels[k].origin[e]; o.edge >= 0)
        stretches[o.edge].push_back({o.from, o.to, index[k], static_cast<int>(e)});
  for (auto& list : stretches)
    std::sort(list.begin(), list.end(),
              [](const Stretch& a, const Stretch& b) { return a.from < b.from; });
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
        for (const Stretch& s : stretches[run.edge]) {
          const double from = std::max(low, s.from), to = std::min(high, s.to),
                       span = s.to - s.from;
          if (to - from < 1e-9)
            continue;
          const auto local = [&](double f) {
            if (f - s.from < 1e-9)
              return 0.0;
            return s.to - f < 1e-9 ? 1.0 : (f - s.from) / span;
          };
          parts.push_back({s.panel, s.edge, local(from), local(to)});
        }
        if (run.from > run.to) {
          std::reverse(parts.begin(), parts.end());
          for (Run& part : parts)
            std::swap(part.from, part.to);
        }
        runs.insert(runs.end(), parts.begin(), parts.end());
      }
      if (runs.empty())
        node.fail("pattern.seam-side-empty"_id,
                  "one side of seam " + seam.name + " would become empty",
                  "take out the seam first, or cut elsewhere");
      *side = std::move(runs);
    }
  for (const Notch& notch : old.notches)
    for (const Stretch& s : stretches[notch.edge])
      if (notch.at >= s.from && notch.at <= s.to && s.to > s.from) {
        Panel& panel = panels[std::find(index.begin(), index.end(), s.panel) - index.begin()].panel;
        panel.notches.push_back({s.edge, (notch.at - s.from) / (s.to - s.from), notch.kind});
        break;
      }
  for (std::size_t k = 0; k < panels.size(); ++k)
    for (Pleat& pleat : panels[k].panel.pleats) {
      std::vector<int> edges;
      for (int e : pleat.edges)
        for (const Stretch& s : stretches[e])
          if (s.panel == index[k])
            edges.push_back(s.edge);
      pleat.edges = std::move(edges);
    }
  for (std::size_t k = 0; k < panels.size(); ++k) {
    if (k == 0)
      pattern.panels[p] = std::move(panels[k].panel);
    else
      pattern.panels.push_back(std::move(panels[k].panel));
  }
}

void map_panel(Panel& panel, const std::function<Vec2(const Vec2&)>& map) {
  for (auto& loop : panel.loops)
    for (PanelEdge& e : loop)
      for (Segment& s : e.path)
        for (Vec2& p : s.p)
          p = snapped(map(p));
  for (InnerLine& line : panel.lines)
    for (Segment& s : line.path)
      for (Vec2& p : s.p)
        p = snapped(map(p));
}

std::array<Vec2, 2> extent(const Panel& panel) {
  Vec2 low = Vec2::Constant(1e300), high = Vec2::Constant(-1e300);
  for (const PanelEdge& e : panel.loops[0])
    for (const Segment& s : e.path) {
      low = low.cwiseMin(s.p[0]);
      high = high.cwiseMax(s.p[0]);
    }
  return {low, high};
}

Vec2 middle(const Panel& panel) {
  const auto [low, high] = extent(panel);
  return 0.5 * (low + high);
}

double factor(const io::Node& node, const char* key) {
  const double f = node.number(key, 1);
  if (!(f > 0.05 && f < 20))
    node.at(key).fail("json.out-of-range"_id, "factor " + decimals(f, 3) + " is out of range",
                      "give 0.05 to 20");
  return f;
}

Panel& edited_panel(Pattern& pattern, const io::Node& node) {
  return pattern.panels[panel_named(pattern, node.at("panel"))];
}

int edited_edge(const Panel& panel, const io::Node& node) {
  return edge_named(panel, node.at("edge"));
}

} // namespace sloper::pattern
