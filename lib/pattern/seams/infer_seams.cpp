#include <pattern/panel_words.hpp>
#include <pattern/read/choose_pieces.hpp>
#include <pattern/seams/gore_rows.hpp>
#include <pattern/seams/missing_seams.hpp>
#include <pattern/seams/rim_seams.hpp>
#include <pattern/seams/seam_assembly.hpp>
#include <pattern/seams/seam_order.hpp>
#include <pattern/seams/sleeve_halves.hpp>
#include <pattern/seams/whole_garment.hpp>
#include <sloper/base/units.hpp>
#include <sloper/io/json.hpp>
#include <sloper/pattern/seams/infer_seams.hpp>

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>

namespace sloper::pattern {
namespace {

constexpr double SHORTEST = 0.004; // m: shorter edges are chamfers
constexpr double STRAIGHT_ON = 25; // degrees: CAD files cut sides up at corners that turn by less
// Log-odds of the judge. On 65 specifications kept from learning 875 of the 880 pairs above the
// first were right (scripts/seam-inference).
constexpr double CERTAIN = 4.6, WORTH_ASKING = -1, WORTH_A_WORD = -4;
constexpr double LIKELY = 0.5;       // probability: rather sewn than not
constexpr double GATHERED = 0.08;    // logarithm of lengths
constexpr double SAME_LENGTH = 0.03; // logarithm: the two sides of a sleeve's seam
// Log-odds. The model learned from sleeves of two pieces; sleeves of CAD files mostly have one.
constexpr double SLEEVE_CLOSES = 6;
constexpr double LEAST_OVERLAP = 1e-6; // of an edge: stretches that touch do not overlap
constexpr double SPARE_SHARE = 0.1;    // of the cloth: pieces that a garment can do without
constexpr double SAME_NAME = 5, OTHER_NAME = -1.5, UNLIKELY = -4; // log-odds

double probability(double odds) {
  return 1 / (1 + std::exp(-odds));
}

/// What names say about pairs of sides, as log-odds.
class NamesSay {
public:
  NamesSay(const Pattern& pattern, const std::vector<SeamSide>& sides)
      : m_pattern(pattern), m_sides(sides) {
    for (std::size_t p = 0; p < pattern.panels.size(); ++p)
      m_words.push_back(words_of(pattern, p));
  }

  std::vector<double> all() const {
    const std::size_t n = m_sides.size();
    std::vector<double> out(n * n, 0);
    for (std::size_t i = 0; i < n; ++i)
      for (std::size_t j = i + 1; j < n; ++j)
        out[i * n + j] = out[j * n + i] = of(m_sides[i], m_sides[j]);
    return out;
  }

private:
  double of(const SeamSide& a, const SeamSide& b) const {
    if (a.name == "hem" || b.name == "hem")
      return SeamWitness::IMPOSSIBLE;
    const bool middle = a.name == "crotch" || a.name == "cf" || a.name == "cb" ||
                        a.name == "centre" || a.name == "center";
    if (a.hand * b.hand < 0 && !middle)
      return SeamWitness::IMPOSSIBLE;
    if (says_sleeve(words(a)) && says_sleeve(words(b)) && cut_as_pair(a.panel, b.panel))
      return SeamWitness::IMPOSSIBLE; // of the other arm
    double odds = 0;
    if (!a.name.empty() && !b.name.empty()) {
      if (a.name != b.name)
        odds += OTHER_NAME;
      else if (!rim(a.name))
        odds += SAME_NAME;
    }
    const Words &own = words(a), &other = words(b);
    const bool adjacent =
        a.loop_begin == b.loop_begin && (a.last() == before(b) || b.last() == before(a));
    if (a.panel == b.panel && !adjacent && says_anything(own) && !around(own))
      odds += UNLIKELY;
    const bool is_half = name_suggests_front(own) || says_back(own);
    if (is_tube(a, b) && says_sleeve(own) && !says_cuff(own) && !is_half)
      odds += SLEEVE_CLOSES;
    if (a.panel != b.panel && says_sleeve(own) && says_sleeve(other) &&
        says_left(own) != says_left(other))
      odds += UNLIKELY;
    return odds;
  }
  /// Whether one is the mirror image of the other that a piece cut twice got on reading.
  bool cut_as_pair(int p, int q) const {
    const std::string &own = m_pattern.panels[p].name, &other = m_pattern.panels[q].name;
    return own + "_mirror" == other || other + "_mirror" == own;
  }
  /// Two sides of one panel, equally long, on either side of a third: the panel may be a tube.
  bool is_tube(const SeamSide& a, const SeamSide& b) const {
    constexpr double LEAST_HEM = 0.3; // of a side: the third is no notch between halves of a hem
    if (a.panel != b.panel || std::abs(std::log(a.length / b.length)) >= SAME_LENGTH)
      return false;
    for (const auto& [third, last] : {std::pair{a.after, b.before}, std::pair{b.after, a.before}})
      if (third >= 0 && third == last && m_sides[third].length > LEAST_HEM * a.length)
        return third == a.after ? at_hem(a.corner_end, b.corner_start)
                                : at_hem(b.corner_end, a.corner_start);
    return false;
  }
  /// Whether the cloth at both ends of the third side is square enough for a hem: a cap that is cut
  /// up into several edges has flat corners.
  static bool at_hem(double first, double second) {
    constexpr double FLATTEST_CORNER = 130; // degrees
    return std::max(first, second) < units::radians(FLATTEST_CORNER);
  }
  const Words& words(const SeamSide& side) const { return m_words[side.panel]; }
  static int before(const SeamSide& s) {
    return s.loop_begin + (s.first - s.loop_begin + s.loop_size - 1) % s.loop_size;
  }
  /// What both halves of a garment have and sew to others, or leave free, but not to each other.
  static bool rim(const std::string& name) {
    for (const char* word : {"waist", "neck", "neckline", "wrist", "top", "bottom", "opening"})
      if (name == word)
        return true;
    return false;
  }
  /// Whether a piece goes around something and may close on itself.
  static bool around(const Words& words) {
    return says_sleeve(words) || says_cuff(words) || says_legs(words) || says_skirt(words) ||
           says_neck(words);
  }

  const Pattern& m_pattern;
  const std::vector<SeamSide>& m_sides;
  std::vector<Words> m_words;
};

class Inference {
public:
  Inference(const Pattern& pattern, const SideCorners& corners)
      : m_pattern(pattern), m_sides(seam_sides(pattern, corners, SHORTEST)),
        m_witness(pattern, m_sides), m_assembly(m_witness, NamesSay(pattern, m_sides).all()) {
    m_result =
        as_one_garment(pattern, m_sides, m_assembly.run(seam_model()), CERTAIN, WORTH_ASKING, {});
  }

  /// Changes what is not sure to what looks most like a garment as a whole.
  void climb() {
    m_result = as_one_garment(m_pattern, m_sides, std::move(m_result), CERTAIN, WORTH_ASKING,
                              seam_model().whole);
  }

  std::vector<SeamGuess> guesses() const {
    std::vector<std::pair<double, SidePair>> found;
    for (const auto& [pair, odds] : m_result.pairs)
      found.push_back({-odds, pair});
    std::sort(found.begin(), found.end());
    std::vector<char> used(m_sides.size(), 0);
    std::vector<SidePair> taken;
    std::vector<SeamGuess> out;
    for (const auto& [cost, pair] : found) {
      if (-cost < WORTH_ASKING)
        break;
      SeamGuess guess = guess_of(pair, -cost);
      guess.certain = -cost >= CERTAIN;
      if (guess.certain)
        used[index(pair[0])] = used[index(pair[1])] = 1;
      out.push_back(std::move(guess));
      taken.push_back(pair);
    }
    add_missing_twins(out, taken);
    for (std::size_t k = 0; k < out.size(); ++k) {
      if (out[k].certain)
        continue;
      if (const auto other = next_best(taken[k], used))
        out[k].instead.push_back(*other);
      for (const SidePair& twin : m_witness.twins(index(taken[k][0]), index(taken[k][1])))
        for (std::size_t q = 0; q < out.size(); ++q)
          if (taken[q] == twin && !out[q].certain && out[k].twin < 0)
            out[k].twin = static_cast<int>(q);
    }
    return out;
  }

private:
  static std::size_t index(int k) { return static_cast<std::size_t>(k); }
  const SeamSide& side(int k) const { return m_sides[index(k)]; }

  std::vector<Run> runs(const SeamSide& s, bool with_outline) const {
    std::vector<Run> out;
    for (int k = 0; k < s.count; ++k) {
      const int at = with_outline ? k : s.count - 1 - k;
      const int edge = s.loop_begin + (s.first - s.loop_begin + at) % s.loop_size;
      out.push_back({s.panel, edge, with_outline ? 0.0 : 1.0, with_outline ? 1.0 : 0.0});
    }
    return out;
  }
  std::string name(const SeamSide& s) const {
    const Panel& panel = m_pattern.panels[index(s.panel)];
    std::string out = panel.name + "." + panel.edge(s.first).name;
    return s.count > 1 ? out + ".." + panel.edge(s.last()).name : out;
  }
  SeamGuess guess_of(const SidePair& pair, double odds) const {
    const SeamSide &a = side(pair[0]), &b = side(pair[1]);
    SeamGuess guess;
    guess.seam.name = name(a) + "-" + name(b);
    guess.seam.a = runs(a, true);
    guess.seam.b = runs(b, false);
    if (a.panel == b.panel && (a.after == pair[1] || b.after == pair[0]))
      guess.seam.kind = "dart";
    else if (std::abs(std::log(a.length / b.length)) > GATHERED)
      guess.seam.kind = "gather";
    guess.score = probability(odds);
    return guess;
  }
  /// People are symmetric: where what is asked has a mirror image whose sides nothing else takes,
  /// that is asked along with it, whether the assembly came upon it or not.
  void add_missing_twins(std::vector<SeamGuess>& out, std::vector<SidePair>& taken) const {
    std::vector<char> in_use(m_sides.size(), 0);
    OpenRims rims(m_pattern, m_sides);
    for (const SidePair& pair : taken) {
      in_use[index(pair[0])] = in_use[index(pair[1])] = 1;
      rims.sew(pair[0], pair[1]);
    }
    const std::size_t found = taken.size();
    for (std::size_t k = 0; k < found; ++k) {
      const auto twins = m_witness.twins(index(taken[k][0]), index(taken[k][1]));
      const bool has_one = std::any_of(twins.begin(), twins.end(), [&](const SidePair& twin) {
        return std::find(taken.begin(), taken.end(), twin) != taken.end();
      });
      if (out[k].certain || has_one || out[k].score < LIKELY)
        continue;
      for (const SidePair& twin : twins) {
        const double odds = m_result.base[index(twin[0]) * m_sides.size() + index(twin[1])];
        if (in_use[index(twin[0])] || in_use[index(twin[1])] || odds < WORTH_A_WORD ||
            rims.makes_handle(twin[0], twin[1]))
          continue;
        in_use[index(twin[0])] = in_use[index(twin[1])] = 1;
        rims.sew(twin[0], twin[1]);
        out.push_back(guess_of(twin, odds));
        out.back().score = out[k].score;
        taken.push_back(twin);
        break;
      }
    }
  }
  std::optional<SeamGuess> next_best(const SidePair& pair, const std::vector<char>& used) const {
    SidePair best{-1, -1};
    double most = WORTH_A_WORD;
    for (int own : pair)
      for (int k = 0; k < std::ssize(m_sides); ++k) {
        if (k == pair[0] || k == pair[1] || used[index(k)])
          continue;
        const double odds = m_result.base[index(own) * m_sides.size() + index(k)];
        if (odds > most) {
          most = odds;
          best = {std::min(own, k), std::max(own, k)};
        }
      }
    if (best[0] < 0)
      return std::nullopt;
    return guess_of(best, most);
  }

  const Pattern& m_pattern;
  std::vector<SeamSide> m_sides;
  SeamWitness m_witness;
  SeamAssembly m_assembly;
  SeamAssembly::Result m_result;
};

io::Json run_json(const Pattern& pattern, const Run& run) {
  const Panel& panel = pattern.panels[run.panel];
  io::Json out = {{"panel", panel.name},
                  {"run", panel.edge(run.edge).name},
                  {"dir", run.from < run.to ? "+" : "-"}};
  const double low = std::min(run.from, run.to), high = std::max(run.from, run.to);
  if (low > 0 || high < 1)
    out["range"] = {low, high};
  return out;
}

io::Json seam_json(const Pattern& pattern, const SeamGuess& guess) {
  io::Json out = {{"name", guess.seam.name},
                  {"kind", guess.seam.kind},
                  {"a", io::Json::array()},
                  {"b", io::Json::array()},
                  {"score", guess.score}};
  for (const Run& run : guess.seam.a)
    out["a"].push_back(run_json(pattern, run));
  for (const Run& run : guess.seam.b)
    out["b"].push_back(run_json(pattern, run));
  return out;
}

} // namespace

double sewn_surely(const Pattern& pattern, const std::vector<SeamGuess>& guesses) {
  double sum = 0;
  for (const SeamGuess& g : guesses)
    sum += std::max(2 * g.score - 1, 0.0) *
           (side_length(pattern, g.seam.a) + side_length(pattern, g.seam.b));
  return sum;
}

std::vector<SeamGuess> infer_seams(const Pattern& pattern) {
  const SideCorners all = all_corners(pattern),
                    sharp = sharp_corners(pattern, units::radians(STRAIGHT_ON));
  const auto completed = [&](std::vector<SeamGuess> guesses) {
    settle_by_order(pattern, guesses);
    const std::vector<Seam> continued = continue_seams(pattern, guesses);
    drop_bags(pattern, guesses, continued);
    guesses = with_rim_seams(pattern, std::move(guesses));
    close_slivers(pattern, guesses);
    offer_sleeve_halves(pattern, guesses);
    return guesses;
  };
  auto best = std::make_unique<Inference>(pattern, all);
  std::vector<SeamGuess> guesses = completed(best->guesses());
  if (sharp != all) {
    // Judged with their sleeves, collars and bands: a cap is found where sides are whole.
    auto by_sides = std::make_unique<Inference>(pattern, sharp);
    std::vector<SeamGuess> whole = completed(by_sides->guesses());
    if (sewn_surely(pattern, whole) > sewn_surely(pattern, guesses)) {
      guesses = std::move(whole);
      best = std::move(by_sides);
    }
  }
  std::vector<SeamGuess> rows = with_gore_rows(pattern, guesses);
  const auto same = [](const SeamGuess& a, const SeamGuess& b) {
    return a.seam.name == b.seam.name;
  };
  if (!std::equal(rows.begin(), rows.end(), guesses.begin(), guesses.end(), same))
    return rows; // gores that nothing tells apart but their order
  // What looks more like a garment is taken where sleeves and bands then are as sure as before.
  best->climb();
  std::vector<SeamGuess> climbed = completed(best->guesses());
  const auto certain = [](const std::vector<SeamGuess>& found) {
    return std::count_if(found.begin(), found.end(), [](const SeamGuess& g) { return g.certain; });
  };
  if (certain(climbed) < certain(guesses))
    return rows;
  return with_gore_rows(pattern, std::move(climbed));
}

std::vector<SeamGuess> first_answers(const std::vector<SeamGuess>& guesses) {
  std::vector<const SeamGuess*> order;
  for (const SeamGuess& g : guesses)
    order.push_back(&g);
  std::stable_sort(order.begin(), order.end(), [](const SeamGuess* a, const SeamGuess* b) {
    return a->certain != b->certain ? a->certain : a->score > b->score;
  });
  std::vector<Run> sewn;
  const auto is_sewn = [&](const Run& run) {
    return std::any_of(sewn.begin(), sewn.end(), [&](const Run& other) {
      return run.panel == other.panel && run.edge == other.edge &&
             std::min(run.from, run.to) < std::max(other.from, other.to) - LEAST_OVERLAP &&
             std::min(other.from, other.to) < std::max(run.from, run.to) - LEAST_OVERLAP;
    });
  };
  std::vector<SeamGuess> out;
  for (const SeamGuess* g : order) {
    std::vector<Run> runs = g->seam.a;
    runs.insert(runs.end(), g->seam.b.begin(), g->seam.b.end());
    const std::size_t before = sewn.size();
    for (const Run& run : runs) {
      if (is_sewn(run))
        break;
      sewn.push_back(run); // no seam sews a stretch to itself either
    }
    if (sewn.size() < before + runs.size()) {
      sewn.resize(before);
      continue;
    }
    out.push_back(*g);
    out.back().twin = -1; // indices of another list
    out.back().with.clear();
  }
  return out;
}

std::vector<std::string> panels_apart(const Pattern& pattern) {
  const std::vector<std::vector<int>> parts = sewn_parts(pattern);
  std::vector<char> apart(pattern.panels.size(), 0);
  for (std::size_t k = 1; k < parts.size(); ++k)
    for (const int p : parts[k])
      apart[p] = 1;
  std::vector<std::string> out;
  for (std::size_t p = 0; p < pattern.panels.size(); ++p)
    if (apart[p])
      out.push_back(pattern.panels[p].name);
  return out;
}

std::vector<std::string> leave_out_unsewn(Pattern& pattern) {
  const std::vector<std::vector<int>> parts = sewn_parts(pattern);
  std::vector<bool> remove(pattern.panels.size(), false);
  std::vector<std::string> names;
  double all = 0, spare = 0;
  for (std::size_t k = 0; k < parts.size(); ++k) {
    if (k > 0 && parts[k].size() > 1)
      return {};
    for (const int p : parts[k]) {
      const double area = pattern.panels[p].area();
      all += area;
      if (k == 0)
        continue;
      spare += area;
      remove[p] = true;
      names.push_back(pattern.panels[p].name);
    }
  }
  if (names.empty() || spare > SPARE_SHARE * all)
    return {};
  remove_panels(pattern, remove);
  return names;
}

io::Json sewing_questions(const Pattern& pattern, const std::vector<SeamGuess>& guesses,
                          const std::string& tool, const std::vector<PieceVersions>& versions) {
  io::Json doc = io::new_document("sewing-seams", 1, tool);
  doc["seams"] = io::Json::array();
  doc["questions"] = io::Json::array();
  const auto others = [](const PieceVersions& all, std::size_t but) {
    std::vector<std::string> names;
    for (std::size_t k = 0; k < all.size(); ++k)
      if (k != but)
        names.insert(names.end(), all[k].begin(), all[k].end());
    return names;
  };
  for (const PieceVersions& all : versions) {
    for (const std::string& name : others(all, 0))
      doc["without"].push_back(name);
    io::Json candidates = io::Json::array();
    for (std::size_t k = 0; k < std::min<std::size_t>(all.size(), 2); ++k)
      candidates.push_back({{"pieces", all[k]}, {"without", others(all, k)}});
    doc["questions"].push_back({{"versions", all}, {"candidates", candidates}});
  }
  std::vector<char> asked(guesses.size(), 0);
  for (std::size_t k = 0; k < guesses.size(); ++k) {
    const SeamGuess& guess = guesses[k];
    if (guess.certain) {
      doc["seams"].push_back(seam_json(pattern, guess));
      continue;
    }
    if (asked[k])
      continue;
    io::Json candidates = io::Json::array({seam_json(pattern, guess)});
    if (!guess.instead.empty())
      candidates.push_back(seam_json(pattern, guess.instead[0]));
    if (guess.twin >= 0) {
      const SeamGuess& twin = guesses[guess.twin];
      asked[guess.twin] = 1;
      candidates[0]["and"] = io::Json::array({seam_json(pattern, twin)});
      if (candidates.size() > 1 && !twin.instead.empty())
        candidates[1]["and"] = io::Json::array({seam_json(pattern, twin.instead[0])});
    }
    for (const int other : guess.with) {
      asked[other] = 1;
      candidates[0]["and"].push_back(seam_json(pattern, guesses[other]));
    }
    const Run& run = guess.seam.a[0];
    const Panel& panel = pattern.panels[run.panel];
    doc["questions"].push_back({{"panel", panel.name},
                                {"run", panel.edge(run.edge).name},
                                {"length", side_length(pattern, guess.seam.a)},
                                {"candidates", candidates}});
  }
  return doc;
}

} // namespace sloper::pattern
