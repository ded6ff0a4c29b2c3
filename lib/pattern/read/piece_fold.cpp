#include <pattern/read/piece_fold.hpp>
#include <sloper/pattern/mesh/folds.hpp>

#include <algorithm>

namespace sloper::pattern {

namespace {

constexpr double ON_THE_LINE = 1e-3; // m between an edge and the middle of its mirror line

Message not_straight(const Panel& panel) {
  return {"dxf.mirror-line"_id,
          panel.name + ": its mirror line is not on a straight edge; the piece is taken as whole"};
}

} // namespace

double distance_to_path(const Path& path, const Vec2& p) {
  double best = 1e300;
  for (const Segment& s : path) {
    const Vec2 along = s.p[3] - s.p[0];
    const double t = along.squaredNorm() > 0
                         ? std::clamp((p - s.p[0]).dot(along) / along.squaredNorm(), 0.0, 1.0)
                         : 0.0;
    best = std::min(best, (p - s.p[0] - t * along).norm());
  }
  return best;
}

int edge_near(const Panel& panel, const Vec2& p) {
  int best = -1;
  double least = 1e300;
  for (int k = 0; k < panel.n_edges(); ++k) {
    const double to_curve = distance_to_path(panel.edge(k).path, p);
    const ArcLength arc(panel.edge(k).path);
    const double score = to_curve + 1e-3 * (arc.at(0.5 * arc.length()) - p).norm();
    if (score < least) {
      least = score;
      best = k;
    }
  }
  return best;
}

int fold_edge(const Panel& panel, const std::vector<Vec2>& line, double unit,
              std::vector<Message>& findings) {
  const Vec2 middle = 0.5 * (line.front() + line.back()) * unit;
  const int e = edge_near(panel, middle);
  const bool on_outline = e < std::ssize(panel.loops[0]);
  if (on_outline && distance_to_path(panel.edge(e).path, middle) < ON_THE_LINE)
    return e;
  findings.push_back(not_straight(panel));
  return -1;
}

void open_fold(Panel& panel, int fold, const std::vector<DxfSewing::Text*>& sewn,
               std::vector<Message>& findings) {
  std::vector<std::pair<std::string, Notch>> notches;
  for (const Notch& n : panel.notches)
    notches.push_back({panel.edge(n.edge).name, n});
  std::vector<std::string> sewn_edges;
  for (const DxfSewing::Text* text : sewn)
    sewn_edges.push_back(panel.edge(text->edge).name);
  if (!unfold(panel, fold, "", "_mirror")) {
    findings.push_back(not_straight(panel));
    return;
  }
  for (std::size_t k = 0; k < sewn.size(); ++k)
    sewn[k]->edge = panel.find_edge(sewn_edges[k]);
  panel.notches.clear();
  for (const auto& [name, notch] : notches)
    for (const bool mirror : {false, true}) {
      const int edge = panel.find_edge(mirror ? name + "_mirror" : name);
      if (edge >= 0)
        panel.notches.push_back({edge, mirror ? 1 - notch.at : notch.at, notch.kind});
    }
  findings.push_back(
      {"dxf.unfolded"_id, panel.name + ": a half piece, unfolded about its mirror line"});
}

} // namespace sloper::pattern
