#include <io/json.hpp>
#include <pattern/panel_words.hpp>
#include <pattern/seams/infer_seams.hpp>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <set>

namespace sloper::pattern {
namespace {

constexpr double CERTAIN = 0.75, MARGIN = 0.12, PLAUSIBLE = 0.35;
constexpr double SHORTEST = 0.02; // m: shorter edges are ends and chamfers
// Of the shape of two edges. Chosen on 80 random specifications stripped of seams and names; see
// scripts/seam-inference.
constexpr double MOST_UNEVEN_SIDES = 0.5; // logarithm of the ratio of lengths: gathers of 1.65 to 1
constexpr double EASE = 0.05;             // the same, up to which each part counts
constexpr double MOST_TURNED = 0.9; // of the longer one, by which the ways up may differ: one goes
                                    // up where the other goes down
constexpr double LEVEL = 0.1;       // up for each metre along
constexpr double BULGE = 0.08;     // area between edge and chord over length squared: another curve
constexpr double DART_TURN = -2.3; // rad, of the outline at the tip: a dart is a deep reflex corner
constexpr double GATHERED = 0.08;

struct Edge {
  int panel, edge;
  double length;
  std::string name;            ///< of the edge without its side, empty when it is only numbered
  std::vector<double> notches; ///< m from the start, ascending
  Vec2 chord;                  ///< m, across the grain and along it
  double bulge = 0;            ///< signed area between the edge and its chord over length squared
};

/// Across the grain and along it.
Vec2 by_grain(const Vec2& grain, const Vec2& v) {
  return {grain.y() * v.x() - grain.x() * v.y(), v.dot(grain)};
}

double bulge_of(const Path& path) {
  constexpr int STEPS = 24;
  const ArcLength arc(path);
  const Vec2 start = path.front().p[0];
  double area = 0;
  Vec2 last = Vec2::Zero();
  for (int k = 1; k <= STEPS; ++k) {
    const Vec2 next = arc.at(arc.length() * k / STEPS) - start;
    area += 0.5 * (last.x() * next.y() - last.y() * next.x());
    last = next;
  }
  return area / std::max(arc.length() * arc.length(), 1e-12);
}

/// A name without its last word where that says a side ("armhole_l" is "armhole"); empty for
/// "edge12".
std::string base_name(const std::string& name) {
  std::string base = name;
  for (const char* tail : {"_l", "_r", "_f", "_b", "_a", "_left", "_right", "_mirror"}) {
    const std::string t = tail;
    if (base.size() > t.size() && base.compare(base.size() - t.size(), t.size(), t) == 0) {
      base.resize(base.size() - t.size());
      break;
    }
  }
  std::string letters;
  for (char c : base)
    if (std::isalpha(static_cast<unsigned char>(c)))
      letters += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return letters == "edge" || letters.rfind("hole", 0) == 0 ? "" : letters;
}

/// 1 left, -1 right, 0 unknown.
int side_of(const std::string& name) {
  const auto ends = [&](const std::string& t) {
    return name.size() > t.size() && name.compare(name.size() - t.size(), t.size(), t) == 0;
  };
  return ends("_l") || ends("_left") || ends(" L")    ? 1
         : ends("_r") || ends("_right") || ends(" R") ? -1
                                                      : 0;
}

class Inference {
public:
  explicit Inference(const Pattern& pattern) : m_pattern(pattern) {
    for (std::size_t p = 0; p < pattern.panels.size(); ++p) {
      const Panel& panel = pattern.panels[p];
      for (int e = 0; e < panel.n_edges(); ++e) {
        Edge edge{static_cast<int>(p),
                  e,
                  length(panel.edge(e).path),
                  base_name(panel.edge(e).name),
                  {},
                  {},
                  0};
        const Path& path = panel.edge(e).path;
        edge.chord = by_grain(panel.grain, path.back().p[3] - path.front().p[0]),
        edge.bulge = bulge_of(path);
        for (const Notch& n : panel.notches)
          if (n.edge == e) edge.notches.push_back(n.at * edge.length);
        std::sort(edge.notches.begin(), edge.notches.end());
        if (edge.length >= SHORTEST) m_edges.push_back(std::move(edge));
      }
    }
  }

  std::vector<SeamGuess> run() {
    const std::size_t n = m_edges.size();
    std::vector<std::vector<double>> score(n, std::vector<double>(n, 0));
    for (std::size_t i = 0; i < n; ++i)
      for (std::size_t j = 0; j < n; ++j)
        if (i != j) score[i][j] = i < j ? rate(m_edges[i], m_edges[j]) : score[j][i];
    std::vector<std::size_t> best(n, n);
    std::vector<double> next(n, 0);
    for (std::size_t i = 0; i < n; ++i)
      for (std::size_t j = 0; j < n; ++j) {
        if (i == j) continue;
        if (best[i] == n || score[i][j] > score[i][best[i]])
          next[i] = best[i] == n ? 0 : score[i][best[i]], best[i] = j;
        else next[i] = std::max(next[i], score[i][j]);
      }
    std::vector<SeamGuess> out;
    for (std::size_t i = 0; i < n; ++i)
      for (std::size_t j = i + 1; j < n; ++j) {
        if (score[i][j] < PLAUSIBLE) continue;
        SeamGuess guess;
        const Edge &a = m_edges[i], &b = m_edges[j];
        guess.seam.name = m_pattern.panels[static_cast<std::size_t>(a.panel)].name + "." +
                          m_pattern.panels[static_cast<std::size_t>(a.panel)].edge(a.edge).name +
                          "-" + m_pattern.panels[static_cast<std::size_t>(b.panel)].name + "." +
                          m_pattern.panels[static_cast<std::size_t>(b.panel)].edge(b.edge).name;
        guess.seam.a = {{a.panel, a.edge, 0, 1}}, guess.seam.b = {{b.panel, b.edge, 1, 0}};
        if (a.panel == b.panel &&
            adjacent(m_pattern.panels[static_cast<std::size_t>(a.panel)], a.edge, b.edge))
          guess.seam.kind = "dart";
        else if (std::abs(std::log(a.length / b.length)) > GATHERED) guess.seam.kind = "gather";
        guess.score = score[i][j];
        guess.certain = best[i] == j && best[j] == i && score[i][j] >= CERTAIN &&
                        score[i][j] - std::max(next[i], next[j]) >= MARGIN;
        out.push_back(std::move(guess));
      }
    std::stable_sort(out.begin(), out.end(),
                     [](const SeamGuess& a, const SeamGuess& b) { return a.score > b.score; });
    return out;
  }

private:
  /// How well two edges go together: 0.5 for length, up to 0.3 for names, 0.2 for notches, times
  /// what their shapes say; sides that contradict each other forbid.
  double rate(const Edge& a, const Edge& b) const {
    const Panel &pa = m_pattern.panels[static_cast<std::size_t>(a.panel)],
                &pb = m_pattern.panels[static_cast<std::size_t>(b.panel)];
    const double ratio = std::abs(std::log(a.length / b.length));
    if (ratio > MOST_UNEVEN_SIDES) return 0;
    const int sa = side_of(pa.edge(a.edge).name) ? side_of(pa.edge(a.edge).name) : side_of(pa.name),
              sb = side_of(pb.edge(b.edge).name) ? side_of(pb.edge(b.edge).name) : side_of(pb.name);
    if (sa * sb < 0 && a.name != "crotch" && a.name != "cf" && a.name != "cb" &&
        a.name != "centre" && a.name != "center")
      return 0;
    const bool dart = a.panel == b.panel && adjacent(pa, a.edge, b.edge);
    if (dart && !(turn_between(pa, a.edge, b.edge) < DART_TURN)) return 0;
    if (a.panel == b.panel && !dart && !is_limb(a.panel))
      return 0; // within a panel only darts, and what closes around a limb
    double names = 0.12;
    if (!a.name.empty() && !b.name.empty()) names = a.name == b.name ? 0.3 : 0.0;
    if (a.panel == b.panel && names > 0)
      names = 0.12; // an edge and its image in the other half of a piece cut on the fold
    if (a.name == "hem" || b.name == "hem") return 0;
    double notches = 0.1;
    if (!a.notches.empty() || !b.notches.empty()) {
      notches = 0;
      if (a.notches.size() == b.notches.size()) {
        double worst = 0; // b is walked against its outline
        for (std::size_t k = 0; k < a.notches.size(); ++k)
          worst = std::max(
              worst, std::abs(a.notches[k] - (b.length - b.notches[b.notches.size() - 1 - k])));
        notches = 0.2 * std::exp(-worst / 0.01);
      }
    }
    const double lengths = 1 - 0.5 * ratio / MOST_UNEVEN_SIDES - 0.3 * std::min(1.0, ratio / EASE);
    double shape = dart ? 1 : go_together(a, b);
    if (names == 0.3) shape = std::max(shape, 0.8); // names tell more
    return (0.5 * lengths + names + notches) * shape;
  }

  /// Sewn edges run against each other: where one goes up the other goes down, and of two level
  /// ones one is at the top and one at the bottom. Their curves answer each other, and an edge and
  /// its own mirror image in the other half are sewn less often than their looks say.
  double go_together(const Edge& a, const Edge& b) const {
    const double longer = std::max(a.length, b.length),
                 turned = std::abs(a.chord.y() + b.chord.y()) / longer;
    if (turned > MOST_TURNED) return 0;
    double shape = 1 - 0.5 * turned;
    const bool level =
        std::abs(a.chord.y()) < LEVEL * a.length && std::abs(b.chord.y()) < LEVEL * b.length;
    if (level && a.chord.x() * b.chord.x() > 0) shape *= 0.3;
    double off = std::abs(a.bulge + b.bulge);
    if (std::abs(a.chord.y()) > 0.3 * a.length) off = std::min(off, std::abs(a.bulge - b.bulge));
    shape *= 1 - 0.3 * std::min(1.0, off / BULGE);
    if (a.panel != b.panel && mirrors(a, b))
      shape *=
          is_limb(a.panel) && !says_legs(words_of(m_pattern, static_cast<std::size_t>(a.panel)))
              ? 0
              : 0.6;
    return shape;
  }

  bool is_limb(int panel) const {
    const Words words = words_of(m_pattern, static_cast<std::size_t>(panel));
    return says_sleeve(words) || says_cuff(words) || says_legs(words);
  }

  /// Of the outline, from the edge that comes first to the next, rad; negative at a reflex corner.
  static double turn_between(const Panel& panel, int a, int b) {
    const int n = static_cast<int>(panel.loops[0].size());
    const int first = (a + 1) % n == b ? a : b;
    const Path &in = panel.edge(first).path, &out = panel.edge((first + 1) % n).path;
    const ArcLength arrives(in), leaves(out);
    const Vec2 u = arrives.tangent(arrives.length()), v = leaves.tangent(0);
    return std::atan2(u.x() * v.y() - u.y() * v.x(), u.dot(v));
  }

  /// Whether the edges are each other's mirror image in panels that are.
  bool mirrors(const Edge& a, const Edge& b) const {
    const int n = count_of(a.panel);
    if (a.edge >= n || b.edge >= n || count_of(b.panel) != n) return false;
    for (int k = 0; k < n; ++k) {
      const Panel &p = m_pattern.panels[static_cast<std::size_t>(a.panel)],
                  &q = m_pattern.panels[static_cast<std::size_t>(b.panel)];
      const Path &own = p.edge((a.edge + k) % n).path, &other = q.edge((b.edge + n - k) % n).path;
      const Vec2 u = by_grain(p.grain, own.back().p[3] - own.front().p[0]),
                 v = by_grain(q.grain, other.back().p[3] - other.front().p[0]);
      if ((v - Vec2(u.x(), -u.y())).norm() > 0.001 + 0.02 * u.norm()) return false;
    }
    return true;
  }
  int count_of(int panel) const {
    return static_cast<int>(m_pattern.panels[static_cast<std::size_t>(panel)].loops[0].size());
  }

  static bool adjacent(const Panel& panel, int a, int b) {
    const int n = static_cast<int>(panel.loops[0].size());
    return a < n && b < n && ((a + 1) % n == b || (b + 1) % n == a);
  }

  const Pattern& m_pattern;
  std::vector<Edge> m_edges;
};

io::Json run_json(const Pattern& pattern, const Run& run) {
  const Panel& panel = pattern.panels[static_cast<std::size_t>(run.panel)];
  return {{"panel", panel.name},
          {"run", panel.edge(run.edge).name},
          {"dir", run.from < run.to ? "+" : "-"}};
}

io::Json seam_json(const Pattern& pattern, const SeamGuess& guess) {
  return {{"name", guess.seam.name},
          {"kind", guess.seam.kind},
          {"a", io::Json::array({run_json(pattern, guess.seam.a[0])})},
          {"b", io::Json::array({run_json(pattern, guess.seam.b[0])})},
          {"score", guess.score}};
}

} // namespace

std::vector<SeamGuess> infer_seams(const Pattern& pattern) { return Inference(pattern).run(); }

io::Json sewing_questions(const Pattern& pattern, const std::vector<SeamGuess>& guesses,
                          const std::string& tool) {
  io::Json doc = io::new_document("sewing-seams", 1, tool);
  doc["seams"] = io::Json::array(), doc["questions"] = io::Json::array();
  std::set<std::pair<int, int>> used;
  for (const SeamGuess& g : guesses)
    if (g.certain) {
      doc["seams"].push_back(seam_json(pattern, g));
      used.insert({g.seam.a[0].panel, g.seam.a[0].edge}),
          used.insert({g.seam.b[0].panel, g.seam.b[0].edge});
    }
  for (std::size_t p = 0; p < pattern.panels.size(); ++p)
    for (int e = 0; e < pattern.panels[p].n_edges(); ++e) {
      const std::pair<int, int> edge{static_cast<int>(p), e};
      if (used.count(edge)) continue;
      io::Json candidates = io::Json::array();
      for (const SeamGuess& g : guesses) {
        const std::pair<int, int> a{g.seam.a[0].panel, g.seam.a[0].edge},
            b{g.seam.b[0].panel, g.seam.b[0].edge};
        if ((a == edge && !used.count(b)) || (b == edge && !used.count(a)))
          if (candidates.size() < 5) candidates.push_back(seam_json(pattern, g));
      }
      if (!candidates.empty())
        doc["questions"].push_back({{"panel", pattern.panels[p].name},
                                    {"run", pattern.panels[p].edge(e).name},
                                    {"length", length(pattern.panels[p].edge(e).path)},
                                    {"candidates", candidates}});
    }
  return doc;
}

} // namespace sloper::pattern
