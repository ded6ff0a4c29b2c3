#include <pattern/panel_words.hpp>
#include <pattern/seams/missing_seams.hpp>
#include <sloper/base/units.hpp>
#include <sloper/geometry/disjoint_sets.hpp>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace sloper::pattern {
namespace {

constexpr double SAME_PLACE = 0.003;               // m along an edge
constexpr double ALIKE = 0.003, ALIKE_PART = 0.01; // m and of the length: mirrored edges differ by
                                                   // no more than the greater of them
constexpr double CENTRED = 0.005;                  // m: holes lie as in the other half
constexpr double SHORTEST_GAP = 0.03; // m: what is shorter may be a vent, a buttonhole or a loop
constexpr double CLOSES =
    290 * units::PI /
    180; // of cloth around the end of a hole that comes to a point there; a hem has half a turn
// The same of a hole that an arm passes through: straight armholes leave 44 degrees open, the
// widest fisheye darts 25. Of 60 tank tops with straight armholes, drawn at random, none is called
// a hole.
constexpr double ARM_SIDE = 0.15; // m, of each side
constexpr double CLOSES_AT_ARM = 335 * units::PI / 180;
constexpr double LARGEST_TURN = units::PI / 4; // of a rim that goes straight on
constexpr double SAME_NOTCH = 0.05;            // of an edge

/// A stretch of one edge, with what is around it. Edges are those of the outer loop, by index.
struct EdgeId {
  int panel, edge;
  bool operator==(const EdgeId& other) const { return panel == other.panel && edge == other.edge; }
};

bool alike(double a, double b) {
  return std::abs(a - b) < std::max(ALIKE, ALIKE_PART * std::max(a, b));
}

class Search {
public:
  explicit Search(const Pattern& pattern) : m_pattern(pattern) {
    for (const Panel& panel : pattern.panels) {
      m_first.push_back(std::ssize(m_nodes));
      for (std::size_t e = 0; e < panel.loops[0].size(); ++e)
        m_nodes.add();
      m_sewn.emplace_back(static_cast<std::size_t>(panel.n_edges()), false);
      std::vector<double>& lengths = m_length.emplace_back();
      for (int e = 0; e < panel.n_edges(); ++e)
        lengths.push_back(length(panel.edge(e).path));
    }
    for (const Seam& seam : pattern.seams) {
      for (const auto* side : {&seam.a, &seam.b})
        for (const Run& run : *side)
          m_sewn[run.panel][run.edge] = true;
      if (seam.kind != "pleat")
        weld(seam);
    }
  }

  std::vector<MissingSeam> run() {
    if (m_pattern.seams.empty())
      return {};
    holes();
    find_mirrors();
    for (const Seam& seam : m_pattern.seams)
      if (seam.kind != "pleat")
        other_half(seam);
    return std::move(m_out);
  }

private:
  const Panel& panel(int p) const { return m_pattern.panels[p]; }
  int count(int p) const { return static_cast<int>(panel(p).loops[0].size()); }
  double length_of(const EdgeId& e) const { return m_length[e.panel][e.edge]; }
  bool sewn(const EdgeId& e) const { return m_sewn[e.panel][e.edge]; }
  EdgeId after(const EdgeId& e) const { return {e.panel, (e.edge + 1) % count(e.panel)}; }
  EdgeId before(const EdgeId& e) const {
    return {e.panel, (e.edge + count(e.panel) - 1) % count(e.panel)};
  }

  // Corners, and places on edges that meet a corner, are joined where seams join them. A corner has
  // the number of the edge that begins there.
  int corner(const EdgeId& e, bool end) const {
    return m_first[e.panel] + (end ? after(e) : e).edge;
  }
  int find(int node) const { return m_nodes.find(node); }
  int node_at(const Run& run, double fraction) {
    const EdgeId e{run.panel, run.edge};
    if (run.edge >= count(run.panel))
      return -1; // of a hole
    const double at = fraction * length_of(e);
    if (at < SAME_PLACE)
      return corner(e, false);
    if (at > length_of(e) - SAME_PLACE)
      return corner(e, true);
    for (const auto& [edge, place, node] : m_places)
      if (edge == e && std::abs(place - at) < SAME_PLACE)
        return node;
    m_places.push_back({e, at, m_nodes.add()});
    return m_places.back().node;
  }

  void weld(const Seam& seam) {
    const double total[2] = {side_length(m_pattern, seam.a), side_length(m_pattern, seam.b)};
    std::vector<double> ends = {0, 1}; // of runs, in the order of the seam
    for (const auto* side : {&seam.a, &seam.b}) {
      double sum = 0;
      for (const Run& run : *side) {
        sum += run_length(m_pattern, run);
        ends.push_back(std::min(1.0, sum / std::max(total[side == &seam.b], 1e-9)));
      }
    }
    for (double end : ends) {
      int first = -1;
      for (const auto* side : {&seam.a, &seam.b}) {
        const double all = total[side == &seam.b];
        double at = 0;
        for (const Run& run : *side) { // both runs that meet there
          const double own = run_length(m_pattern, run), along = end * all - at;
          at += own;
          if (along < -SAME_PLACE || along > own + SAME_PLACE)
            continue;
          const int node =
              node_at(run, run.from + (run.to - run.from) *
                                          std::clamp(along / std::max(own, 1e-9), 0.0, 1.0));
          if (node < 0)
            continue;
          if (first < 0)
            first = node;
          m_nodes.unite_into(node, first);
        }
      }
    }
  }

  /// Of the cloth, at the corner of an outline where an edge begins.
  double angle_before(int p, int loop_first, int n, int k) const {
    const Path &in = panel(p).edge(loop_first + (k + n - 1) % n).path,
               &out = panel(p).edge(loop_first + k).path;
    const ArcLength arrives(in), leaves(out);
    const Vec2 a = -arrives.tangent(arrives.length()), b = leaves.tangent(0);
    const double angle = std::atan2(b.x() * a.y() - b.y() * a.x(), b.dot(a));
    return angle < 0 ? angle + 2 * units::PI : angle;
  }
  double cloth_around(int node) const {
    const int joined = find(node);
    double sum = 0;
    for (int p = 0; p < std::ssize(m_pattern.panels); ++p)
      for (int k = 0; k < count(p); ++k)
        if (find(m_first[p] + k) == joined)
          sum += angle_before(p, 0, count(p), k);
    for (const auto& place : m_places)
      if (find(place.node) == joined)
        sum += units::PI;
    return sum;
  }

  /// Free edges one after the other, between two that are sewn.
  std::vector<std::vector<EdgeId>> gaps() const {
    std::vector<std::vector<EdgeId>> out;
    for (int p = 0; p < std::ssize(m_pattern.panels); ++p)
      for (int k = 0; k < count(p); ++k) {
        EdgeId e{p, k};
        if (sewn(e) || !sewn(before(e)))
          continue;
        std::vector<EdgeId>& gap = out.emplace_back();
        for (; !sewn(e); e = after(e))
          gap.push_back(e);
      }
    return out;
  }
  double gap_length(const std::vector<EdgeId>& gap) const {
    return std::accumulate(gap.begin(), gap.end(), 0.0,
                           [&](double sum, const EdgeId& e) { return sum + length_of(e); });
  }

  void tell(const EdgeId& a, const EdgeId& b, const std::string& why) {
    const auto met = [&](const Run& run, const EdgeId& e) {
      return run.panel == e.panel && run.edge == e.edge;
    };
    for (const MissingSeam& s : m_out)
      if ((met(s.a, a) && met(s.b, b)) || (met(s.a, b) && met(s.b, a)))
        return;
    m_out.push_back({{a.panel, a.edge, 0, 1}, {b.panel, b.edge, 1, 0}, why});
  }

  void holes() {
    const std::string point = "a hole that comes to a point at both ends";
    const auto pointed = [&](int node) { return cloth_around(node) > CLOSES; };
    const auto as_a_seam = [&](int node, double length) {
      return cloth_around(node) > (length < ARM_SIDE ? CLOSES : CLOSES_AT_ARM);
    };
    const std::vector<std::vector<EdgeId>> all = gaps();
    for (std::size_t i = 0; i < all.size(); ++i) {
      const int start = corner(all[i].front(), false), end = corner(all[i].back(), true);
      if (all[i].size() == 2 && find(start) == find(end)) { // a dart
        const EdgeId &a = all[i][0], &b = all[i][1];
        if (length_of(a) > SHORTEST_GAP && alike(length_of(a), length_of(b)) && pointed(start) &&
            angle_before(b.panel, 0, count(b.panel), b.edge) > CLOSES)
          tell(a, b, point);
      }
      for (std::size_t j = i + 1; j < all.size(); ++j) {
        const int from = corner(all[j].front(), false), to = corner(all[j].back(), true);
        if (find(start) != find(to) || find(end) != find(from) || find(start) == find(end))
          continue;
        const double own = gap_length(all[i]);
        if (own > SHORTEST_GAP && alike(own, gap_length(all[j])) && as_a_seam(start, own) &&
            as_a_seam(end, own))
          tell(all[i].front(), all[j].back(), point);
      }
    }
    for (int p = 0; p < std::ssize(m_pattern.panels); ++p) { // a dart within a panel
      int first = count(p);
      for (std::size_t h = 1; h < panel(p).loops.size();
           first += static_cast<int>(panel(p).loops[h++].size())) {
        const EdgeId a{p, first}, b{p, first + 1};
        if (panel(p).loops[h].size() == 2 && !sewn(a) && !sewn(b) && length_of(a) > SHORTEST_GAP &&
            alike(length_of(a), length_of(b)) && angle_before(p, first, 2, 0) > CLOSES &&
            angle_before(p, first, 2, 1) > CLOSES)
          tell(a, b, point);
      }
    }
  }

  // From here on: what one half has and the other has not.

  struct Mirror {
    int panel = -1, sum = 0; ///< edge e of the one is edge (sum - e) of the other
  };

  /// Along the grain and across it.
  Vec2 by_grain(int p, const Vec2& v) const {
    const Vec2& g = panel(p).grain;
    return {v.dot(g), g.x() * v.y() - g.y() * v.x()};
  }
  Vec2 chord(int p, int e) const {
    return by_grain(p, panel(p).edge(e).path.back().p[3] - panel(p).edge(e).path.front().p[0]);
  }
  std::vector<double> notches_of(int p, int e, bool turned) const {
    std::vector<double> out;
    for (const Notch& n : panel(p).notches)
      if (n.edge == e)
        out.push_back(turned ? 1 - n.at : n.at);
    std::sort(out.begin(), out.end());
    return out;
  }
  /// From the middle of a panel's corners to that of its holes' corners.
  Vec2 holes_at(int p) const {
    Vec2 middle[2] = {Vec2::Zero(), Vec2::Zero()};
    double n[2] = {0, 0};
    for (std::size_t l = 0; l < panel(p).loops.size(); ++l)
      for (const PanelEdge& e : panel(p).loops[l]) {
        middle[l > 0] += e.path.front().p[0];
        ++n[l > 0];
      }
    return n[1] > 0 ? by_grain(p, middle[1] / n[1] - middle[0] / n[0]) : Vec2::Zero();
  }

  bool mirrors(int p, int q, int sum) const {
    const int n = count(p);
    for (int e = 0; e < n; ++e) {
      const int f = (sum - e + n) % n;
      const double own = length_of({p, e}), other = length_of({q, f}),
                   off = std::max(ALIKE, ALIKE_PART * own);
      const Vec2 a = chord(p, e), b = chord(q, f);
      if (!alike(own, other) || (b - Vec2(-a.x(), a.y())).norm() > 2 * off)
        return false;
      const std::vector<double> at = notches_of(p, e, true), there = notches_of(q, f, false);
      if (!std::equal(at.begin(), at.end(), there.begin(), there.end(),
                      [](double x, double y) { return std::abs(x - y) < SAME_NOTCH; }))
        return false;
    }
    const Vec2 a = holes_at(p), b = holes_at(q);
    return panel(p).loops.size() == panel(q).loops.size() &&
           (b - Vec2(a.x(), -a.y())).norm() < CENTRED;
  }
  Mirror mirror(int p, int q) const {
    if (count(p) == count(q))
      for (int sum = 0; sum < count(p); ++sum)
        if (mirrors(p, q, sum))
          return {q, sum};
    return {};
  }

  /// The other half of each panel: the one with its name, else itself, else the only one that
  /// it can be.
  void find_mirrors() {
    const int n = std::ssize(m_pattern.panels);
    std::vector<Words> words;
    std::vector<int> side; // 1 left, -1 right
    for (const Panel& p : m_pattern.panels) {
      Words own = words_of(p.name), bare;
      side.push_back((says_left(own) ? 1 : 0) - (says_right(own) ? 1 : 0));
      for (const std::string& word : own)
        if (!says_left({word}) && !says_right({word}))
          bare.insert(word);
      words.push_back(std::move(bare));
    }
    m_mirror.assign(static_cast<std::size_t>(n), {});
    const auto at = [](auto& list, int k) -> auto& {
      return list[k];
    };
    for (int p = 0; p < n; ++p)
      for (int q = 0; q < n && at(m_mirror, p).panel < 0; ++q)
        if (at(side, p) * at(side, q) < 0 && at(words, p) == at(words, q))
          at(m_mirror, p) = mirror(p, q);
    for (int p = 0; p < n; ++p)
      if (at(m_mirror, p).panel < 0)
        at(m_mirror, p) = mirror(p, p);
    for (int p = 0; p < n; ++p) {
      if (at(m_mirror, p).panel >= 0)
        continue;
      std::vector<Mirror> others;
      for (int q = 0; q < n; ++q)
        if (const Mirror m = q == p || at(m_mirror, q).panel == q ? Mirror{} : mirror(p, q);
            m.panel >= 0)
          others.push_back(m);
      if (others.size() == 1)
        at(m_mirror, p) = others[0];
    }
  }

  EdgeId image(const EdgeId& e) const {
    const Mirror& m = m_mirror[e.panel];
    if (m.panel < 0 || e.edge >= count(e.panel))
      return {-1, -1};
    return {m.panel, (m.sum - e.edge + count(e.panel)) % count(e.panel)};
  }

  bool sewn_together(const EdgeId& a, const EdgeId& b) const {
    const auto has = [](const std::vector<Run>& side, const EdgeId& e) {
      return std::any_of(side.begin(), side.end(), [&](const Run& run) {
        return run.panel == e.panel && run.edge == e.edge;
      });
    };
    return std::any_of(m_pattern.seams.begin(), m_pattern.seams.end(), [&](const Seam& s) {
      return (has(s.a, a) && has(s.b, b)) || (has(s.a, b) && has(s.b, a));
    });
  }

  struct EdgeEnd {
    EdgeId edge{-1, -1};
    bool end = false;
  };
  EdgeId beyond(const EdgeEnd& e) const { return e.end ? after(e.edge) : before(e.edge); }
  int node_of(const EdgeEnd& e) const { return find(corner(e.edge, e.end)); }

  /// The free edge that the rim goes on with, straight on; no edge where it turns a corner.
  EdgeEnd straight_on(const EdgeEnd& from) const {
    if (std::abs(cloth_around(node_of(from)) - units::PI) > LARGEST_TURN)
      return {};
    std::vector<EdgeEnd> found;
    for (int p = 0; p < std::ssize(m_pattern.panels); ++p)
      for (int k = 0; k < count(p); ++k)
        for (const bool end : {false, true}) {
          const EdgeEnd e{{p, k}, end};
          if (!sewn(e.edge) && node_of(e) == node_of(from) &&
              !(e.edge == from.edge && e.end == from.end))
            found.push_back({e.edge, !end});
        }
    return found.size() == 1 ? found[0] : EdgeEnd{};
  }

  /// Whether both sides of an opening lead, by way of others such as the ends of a waistband, to
  /// where the same panels are sewn together: it is a slit or a placket.
  bool goes_on_sewn(std::array<EdgeEnd, 2> ends) const {
    for (std::size_t step = 0; step < m_first.size(); ++step) {
      if (sewn_together(beyond(ends[0]), beyond(ends[1])))
        return true;
      if (node_of(ends[0]) == node_of(ends[1]))
        return false;
      ends = {straight_on(ends[0]), straight_on(ends[1])};
      if (ends[0].edge.panel < 0 || ends[1].edge.panel < 0 ||
          !alike(length_of(ends[0].edge), length_of(ends[1].edge)))
        return false;
    }
    return false;
  }

  void other_half(const Seam& seam) {
    std::vector<EdgeId> side[2];
    for (const auto* runs : {&seam.a, &seam.b})
      for (const Run& run : *runs) {
        const EdgeId e = image({run.panel, run.edge});
        if (e.panel < 0 || sewn(e) || std::abs(run.from - run.to) < 1 - 1e-6)
          return;
        side[runs == &seam.b].push_back(e);
      }
    for (const bool end : {false, true}) {
      std::array<EdgeEnd, 2> ends;
      for (std::size_t s : {0, 1}) {
        const std::vector<Run>& runs = s ? seam.b : seam.a;
        const Run& run = end ? runs.back() : runs.front();
        ends[s] = {end ? side[s].back() : side[s].front(),
                   (run.from < run.to) != end}; // an image runs in the opposite direction
      }
      if (goes_on_sewn(ends))
        return;
    }
    tell(side[0].front(), side[1].front(),
         "their like in the other half are sewn together (" + seam.name + ")");
  }

  struct Place {
    EdgeId edge;
    double at;
    int node;
  };
  const Pattern& m_pattern;
  std::vector<int> m_first;
  DisjointSets m_nodes;
  std::vector<Place> m_places; ///< on edges, away from their ends
  std::vector<std::vector<bool>> m_sewn;
  std::vector<std::vector<double>> m_length;
  std::vector<Mirror> m_mirror;
  std::vector<MissingSeam> m_out;
};

} // namespace

std::vector<MissingSeam> missing_seams(const Pattern& pattern) {
  return Search(pattern).run();
}

std::vector<std::vector<int>> sewn_parts(const Pattern& pattern) {
  DisjointSets joined(pattern.panels.size());
  for (const Seam& seam : pattern.seams)
    for (const auto* side : {&seam.a, &seam.b})
      for (const Run& run : *side)
        joined.unite(seam.a[0].panel, run.panel);
  std::map<int, std::vector<int>> groups;
  for (int p = 0; p < std::ssize(pattern.panels); ++p)
    groups[joined.find(p)].push_back(p);
  std::vector<std::vector<int>> out;
  for (auto& [root, panels] : groups)
    out.push_back(std::move(panels));
  std::stable_sort(out.begin(), out.end(),
                   [](const auto& a, const auto& b) { return a.size() > b.size(); });
  return out;
}

} // namespace sloper::pattern
