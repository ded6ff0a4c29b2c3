#include <pattern/seams/garment_search.hpp>
#include <pattern/seams/rims.hpp>
#include <pattern/seams/whole_garment.hpp>

#include <algorithm>
#include <cmath>
#include <optional>

namespace sloper::pattern {
namespace {

// Log-odds, chosen on 80 of the 120 random specifications, which feel them little: 40 to 42 of the
// 80 are wholly right with WORST_EXCHANGE from -7 to -4, DEAREST_EXCHANGE from 1.5 to 5, WORST_JOIN
// from -6.5 to -5, DEAREST_MERGE from 0.7 to 3 and LEAST_SLIT from 0 to 1. Of 120 fresh designs 36
// were wholly right without them and 46 are with them.
constexpr double ASKED = 0.5;           // of pairs that are sewn for the sake of the whole
constexpr double TWINS = 1.2;           // of two that are exchanged between the same two panels
constexpr double WORST_EXCHANGE = -7;   // of both pairs that are exchanged, by themselves
constexpr double DEAREST_EXCHANGE = 3;  // by which two pairs may be worse that leave fewer handles
constexpr double WORST_JOIN = -5.5;     // the mean of the pairs along two rims
constexpr double LOWEST_IN_MEAN = -9;   // what one pair can take from that mean
constexpr double DEAREST_MERGE = 1.5;   // by which two pairs may be worse that leave fewer rims
constexpr double LEAST_SLIT = 0;        // of two sides that follow one another on a rim
constexpr double SLIT_SIDES = 0.01;     // logarithm: the two sides of a slit
constexpr std::size_t FEWEST_RIMS = 2;  // of a garment: it has to be put on
constexpr std::size_t MOST_SIDES = 24;  // of a rim that is tried
constexpr double LEAST_GAIN = 0.5;      // of the score of the whole, by which it is changed
constexpr double SLIVER = 0.015;        // m around
constexpr double SHORTEST_SIDE = 0.004; // m: shorter edges are no sides
constexpr double SLIVER_SCORE = 0.9;

class Whole {
public:
  Whole(const Pattern& pattern, const std::vector<SeamSide>& sides, SeamAssembly::Result found,
        double sure, double doubtful)
      : m_pattern(pattern), m_sides(sides), m_found(std::move(found)), m_sure(sure),
        m_doubtful(doubtful) {
    for (const auto& [pair, odds] : m_found.pairs)
      if (odds >= m_doubtful)
        m_pairs.push_back({pair, odds});
    std::sort(m_pairs.begin(), m_pairs.end(), surer);
  }

  SeamAssembly::Result run(const std::vector<double>& weights) {
    exchange();
    take_handles_back();
    while (merge_rims() || join_parts()) {}
    while (zip()) {}
    if (!weights.empty())
      improve(weights);
    m_found.pairs.clear();
    for (const Sewn& s : m_pairs)
      m_found.pairs[s.pair] = s.odds;
    return std::move(m_found);
  }

private:
  struct Sewn {
    SidePair pair;
    double odds;
  };
  static bool surer(const Sewn& a, const Sewn& b) {
    return a.odds != b.odds ? a.odds > b.odds : a.pair < b.pair;
  }
  double base(int i, int j) const {
    return m_found.base[static_cast<std::size_t>(i) * m_sides.size() + static_cast<std::size_t>(j)];
  }
  static SidePair ordered(int i, int j) { return {std::min(i, j), std::max(i, j)}; }

  OpenRims sewn() const {
    OpenRims rims(m_pattern, m_sides);
    for (const Sewn& s : m_pairs)
      rims.sew(s.pair[0], s.pair[1]);
    return rims;
  }
  /// Sewn one after the other: how many make a handle.
  int handles(const std::vector<Sewn>& pairs) const {
    OpenRims rims(m_pattern, m_sides);
    int count = 0;
    for (const Sewn& s : pairs) {
      count += static_cast<int>(rims.makes_handle(s.pair[0], s.pair[1]));
      rims.sew(s.pair[0], s.pair[1]);
    }
    return count;
  }

  /// Two pairs that exchange their partners, where that leaves fewer handles: a
  /// cuff that was twisted.
  void exchange() {
    int left = handles(m_pairs);
    while (left > 0) {
      std::vector<Sewn> best;
      double best_cost = 1e300;
      int fewest = left;
      for (std::size_t x = 0; x < m_pairs.size(); ++x)
        for (std::size_t y = x + 1; y < m_pairs.size(); ++y) {
          if (m_pairs[x].odds >= m_sure || m_pairs[y].odds >= m_sure)
            continue;
          for (const bool crossed : {false, true})
            if (const auto other = exchanged(x, y, crossed)) {
              const double cost = loss(*other, x, y);
              if (cost > DEAREST_EXCHANGE)
                continue;
              const int now = handles(*other);
              if (now < fewest || (now == fewest && now < left && cost < best_cost)) {
                fewest = now;
                best_cost = cost;
                best = *other;
              }
            }
        }
      if (best.empty())
        return;
      m_pairs = std::move(best);
      std::sort(m_pairs.begin(), m_pairs.end(), surer);
      left = fewest;
    }
  }
  std::optional<std::vector<Sewn>> exchanged(std::size_t x, std::size_t y, bool crossed) const {
    const auto [i, j] = m_pairs[x].pair;
    const auto [k, l] = m_pairs[y].pair;
    const SidePair first = ordered(i, crossed ? l : k), second = ordered(j, crossed ? k : l);
    if (base(first[0], first[1]) < WORST_EXCHANGE || base(second[0], second[1]) < WORST_EXCHANGE)
      return std::nullopt;
    std::vector<Sewn> out = m_pairs;
    out[x] = {first, std::min(ASKED, m_pairs[x].odds)};
    out[y] = {second, std::min(ASKED, m_pairs[y].odds)};
    if (same_panels(x, y)) // their order along the outlines decides (settle_by_order())
      out[x].odds = out[y].odds = TWINS;
    return out;
  }

  bool same_panels(std::size_t x, std::size_t y) const {
    const auto panels = [&](const Sewn& s) {
      return ordered(m_sides[s.pair[0]].panel, m_sides[s.pair[1]].panel);
    };
    return panels(m_pairs[x]) == panels(m_pairs[y]);
  }

  static int count_rims(const OpenRims& rims) {
    const auto all = rims.rims();
    return static_cast<int>(
        std::count_if(all.begin(), all.end(), [](const auto& rim) { return !rim.empty(); }));
  }
  /// Two pairs that leave one rim instead of two once they exchange partners: a collar that
  /// was made a tube in front and another one behind.
  bool merge_rims() {
    const OpenRims now = sewn();
    const int rims = count_rims(now);
    std::vector<Sewn> best;
    double least = DEAREST_MERGE;
    for (std::size_t x = 0; x < m_pairs.size(); ++x)
      for (std::size_t y = x + 1; y < m_pairs.size(); ++y) {
        if (m_pairs[x].odds >= m_sure || m_pairs[y].odds >= m_sure ||
            !now.same_part(m_pairs[x].pair[0], m_pairs[y].pair[0]))
          continue;
        for (const bool crossed : {false, true})
          if (const auto other = exchanged(x, y, crossed)) {
            const double cost = loss(*other, x, y);
            if (cost >= least || handles(*other) > 0)
              continue;
            OpenRims then(m_pattern, m_sides);
            for (const Sewn& s : *other)
              then.sew(s.pair[0], s.pair[1]);
            if (count_rims(then) >= rims || !then.same_part(m_pairs[x].pair[0], m_pairs[y].pair[0]))
              continue;
            least = cost;
            best = *other;
          }
      }
    if (best.empty())
      return false;
    m_pairs = std::move(best);
    std::sort(m_pairs.begin(), m_pairs.end(), surer);
    return true;
  }
  double loss(const std::vector<Sewn>& other, std::size_t x, std::size_t y) const {
    double sum = 0;
    for (const std::size_t k : {x, y})
      sum +=
          base(m_pairs[k].pair[0], m_pairs[k].pair[1]) - base(other[k].pair[0], other[k].pair[1]);
    return sum;
  }

  void take_handles_back() {
    OpenRims rims(m_pattern, m_sides);
    std::vector<Sewn> kept;
    for (const Sewn& s : m_pairs) {
      if (s.odds < m_sure && rims.makes_handle(s.pair[0], s.pair[1]))
        continue;
      rims.sew(s.pair[0], s.pair[1]);
      kept.push_back(s);
    }
    m_pairs = std::move(kept);
  }

  /// Rims of two parts that have as many sides, one along the other: a waistband, a cuff, a skirt
  /// on a bodice. The pairs that speak for it most.
  bool join_parts() {
    const OpenRims rims = sewn();
    std::vector<std::vector<int>> open;
    for (auto& rim : rims.rims())
      if (!rim.empty() && rim.size() <= MOST_SIDES)
        open.push_back(std::move(rim));
    if (open.size() < FEWEST_RIMS + 2)
      return false;
    std::vector<SidePair> best;
    double most = WORST_JOIN;
    for (std::size_t a = 0; a < open.size(); ++a)
      for (std::size_t b = a + 1; b < open.size(); ++b) {
        const std::size_t n = open[a].size();
        if (open[b].size() != n || rims.same_part(open[a][0], open[b][0]) ||
            !is_tube(rims, open, a) || !is_tube(rims, open, b))
          continue;
        for (std::size_t turn = 0; turn < n; ++turn) {
          double sum = 0;
          bool possible = true;
          std::vector<SidePair> pairs;
          for (std::size_t k = 0; k < n; ++k) {
            const int i = open[a][k], j = open[b][(turn + n - k) % n];
            possible = possible && base(i, j) > SeamWitness::IMPOSSIBLE;
            sum += std::max(base(i, j), LOWEST_IN_MEAN);
            pairs.push_back(ordered(i, j));
          }
          if (!possible)
            continue;
          const double mean = sum / static_cast<double>(n);
          if (mean > most) {
            most = mean;
            best = std::move(pairs);
          }
        }
      }
    for (const SidePair& pair : best)
      m_pairs.push_back({pair, ASKED});
    return !best.empty();
  }
  /// Whether the part of a rim has another one: a flat piece would close what it is sewn on.
  static bool is_tube(const OpenRims& rims, const std::vector<std::vector<int>>& open,
                      std::size_t own) {
    for (std::size_t k = 0; k < open.size(); ++k)
      if (k != own && rims.same_part(open[k][0], open[own][0]))
        return true;
    return false;
  }

  /// Two sides as long that follow one another on a rim: what they leave between them is a slit.
  bool zip() {
    std::optional<SidePair> best;
    double most = LEAST_SLIT;
    for (const std::vector<int>& rim : sewn().rims())
      for (std::size_t k = 0; k < rim.size() && rim.size() > 1; ++k) {
        const int i = rim[k], j = rim[(k + 1) % rim.size()];
        if (std::abs(std::log(m_sides[i].length / m_sides[j].length)) > SLIT_SIDES)
          continue;
        const double odds = base(std::min(i, j), std::max(i, j));
        if (odds > most) {
          most = odds;
          best = ordered(i, j);
        }
      }
    if (best)
      m_pairs.push_back({*best, ASKED});
    return best.has_value();
  }

  /// Climbs to what looks most like a garment; what is sure stays.
  void improve(const std::vector<double>& weights) {
    Matching partner(m_sides.size(), -1);
    std::vector<char> fixed(m_sides.size(), 0);
    PairOdds known;
    for (const Sewn& s : m_pairs) {
      known[s.pair] = s.odds;
      partner[s.pair[0]] = s.pair[1];
      partner[s.pair[1]] = s.pair[0];
      fixed[s.pair[0]] = fixed[s.pair[1]] = s.odds >= m_sure;
    }
    const GarmentView view(m_pattern, m_sides, m_found.base);
    const GarmentSearch search(m_pattern, m_sides, view, std::move(fixed));
    partner = search.climb(std::move(partner), weights, LEAST_GAIN);
    m_pairs.clear();
    for (int i = 0; i < std::ssize(partner); ++i)
      if (partner[i] > i) {
        const auto at = known.find({i, partner[i]});
        m_pairs.push_back({{i, partner[i]}, at == known.end() ? ASKED : at->second});
      }
    std::sort(m_pairs.begin(), m_pairs.end(), surer);
  }

  const Pattern& m_pattern;
  const std::vector<SeamSide>& m_sides;
  SeamAssembly::Result m_found;
  double m_sure, m_doubtful;
  std::vector<Sewn> m_pairs; ///< surest first
};

} // namespace

SeamAssembly::Result as_one_garment(const Pattern& pattern, const std::vector<SeamSide>& sides,
                                    SeamAssembly::Result found, double sure, double doubtful,
                                    const std::vector<double>& weights) {
  return Whole(pattern, sides, std::move(found), sure, doubtful).run(weights);
}

void close_slivers(const Pattern& pattern, std::vector<SeamGuess>& guesses) {
  const std::vector<Seam> seams = likely_seams(guesses, {});
  for (const Rim& rim : rims_of(pattern, seams)) {
    if (rim.edges.size() != 2 || rim.length > SLIVER)
      continue;
    const Edges first{rim.edges[0]}, second{rim.edges[1]};
    Seam seam;
    seam.name = pattern.panels[first[0].panel].name + " chamfer";
    seam.a = whole(first, true);
    seam.b = whole(second, false);
    guesses.push_back(
        rim_guess(std::move(seam), is_certain(guesses, seams, rim.edges), SLIVER_SCORE));
  }
  // Two that follow each other across the end of a seam: the seam covers them too.
  for (const Rim& rim : rims_of(pattern, seams))
    for (std::size_t k = 0; k < rim.edges.size() && rim.edges.size() > 2; ++k) {
      const RimEdge &own = rim.edges[k], &next = rim.edges[(k + 1) % rim.edges.size()];
      if (own.seam_after < 0 || own.length >= SHORTEST_SIDE || next.length >= SHORTEST_SIDE)
        continue;
      const Edges first{own}, second{next};
      Seam seam;
      const Panel& panel = pattern.panels[own.panel];
      seam.name = panel.name + "." + panel.edge(own.edge).name + " end";
      seam.a = whole(first, true);
      seam.b = whole(second, false);
      guesses.push_back(
          rim_guess(std::move(seam), is_certain(guesses, seams, first), SLIVER_SCORE));
      ++k; // no edge twice
    }
}

} // namespace sloper::pattern
