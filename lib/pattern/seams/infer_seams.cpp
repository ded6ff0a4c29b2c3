#include <io/json.hpp>
#include <pattern/seams/infer_seams.hpp>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <set>

namespace sloper::pattern {
namespace {

constexpr double CERTAIN = 0.75, MARGIN = 0.12, PLAUSIBLE = 0.35;
constexpr double SHORTEST = 0.02; // m: shorter edges are ends and chamfers

struct Edge {
  int panel, edge;
  double length;
  std::string name;            ///< of the edge without its side, empty when it is only numbered
  std::vector<double> notches; ///< m from the start, ascending
};

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
        Edge edge{
            static_cast<int>(p), e, length(panel.edge(e).path), base_name(panel.edge(e).name), {}};
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
        if (a.panel == b.panel) guess.seam.kind = "dart";
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
  /// How well two edges go together: 0.5 for length, up to 0.3 for names, 0.2 for notches; sides
  /// that contradict each other forbid.
  double rate(const Edge& a, const Edge& b) const {
    const Panel &pa = m_pattern.panels[static_cast<std::size_t>(a.panel)],
                &pb = m_pattern.panels[static_cast<std::size_t>(b.panel)];
    const double ratio = std::abs(std::log(a.length / b.length));
    if (ratio > 0.15) return 0;
    const int sa = side_of(pa.edge(a.edge).name) ? side_of(pa.edge(a.edge).name) : side_of(pa.name),
              sb = side_of(pb.edge(b.edge).name) ? side_of(pb.edge(b.edge).name) : side_of(pb.name);
    if (sa * sb < 0 && a.name != "crotch" && a.name != "cf" && a.name != "cb" &&
        a.name != "centre" && a.name != "center")
      return 0;
    if (a.panel == b.panel && !adjacent(pa, a.edge, b.edge))
      return 0; // within a panel only darts are guessed
    double names = 0.12;
    if (!a.name.empty() && !b.name.empty()) names = a.name == b.name ? 0.3 : 0.0;
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
    return 0.5 * std::exp(-std::pow(ratio / 0.03, 2)) + names + notches;
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
