#include <pattern/seams/gore_rows.hpp>
#include <pattern/seams/rims.hpp>
#include <pattern/seams/seam_sides.hpp>

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>

namespace sloper::pattern {
namespace {

constexpr double SAME_SIDE = 0.01;  // logarithm
constexpr double SAME_CURVE = 0.01; // of the length
constexpr double TOP_FITS = 0.15;   // logarithm of lengths: gathers of a top are shared evenly
constexpr double SAME_CLOTH = 0.15; // logarithm: ends of a row that is asymmetric differ a little
constexpr double LEAST_CLOTH = 0.3; // of the garment's; sleeves and cuffs have less
constexpr double RATHER_SEWN = 0.5; // probability
constexpr double GORE_SCORE = 0.8;

/// A piece with two upright sides alike; its outline runs up the right one, seen from outside.
struct Gore {
  int panel = 0, right = 0, left = 0;
  double length = 0, bulge = 0, cloth = 0;
  std::vector<int> top; ///< edges from right to left
};

std::optional<Gore> gore_of(const Pattern& pattern, int p) {
  const Panel& panel = pattern.panels[p];
  const int n = static_cast<int>(panel.loops[0].size());
  std::vector<SeamSide> sides;
  for (int e = 0; e < n; ++e)
    sides.push_back(measure_side(pattern, p, e, 1));
  Gore best;
  const auto upright = [&](const SeamSide& s) {
    return std::abs(s.chord.y()) > std::abs(s.chord.x());
  };
  for (int r = 0; r < n; ++r)
    for (int l = 0; l < n; ++l) {
      const SeamSide &a = sides[r], &b = sides[l];
      const bool alike = upright(a) && upright(b) && a.chord.y() > 0 && b.chord.y() < 0 &&
                         a.place.x() > b.place.x() && a.length > best.length &&
                         std::abs(std::log(a.length / b.length)) < SAME_SIDE &&
                         std::abs(a.bulge - b.bulge) < SAME_CURVE;
      if (!alike)
        continue;
      best.length = a.length;
      best.bulge = a.bulge;
      best.right = r;
      best.left = l;
    }
  if (!(best.length > 0))
    return std::nullopt;
  best.panel = p;
  best.cloth = panel.area();
  for (int e = (best.right + 1) % n; e != best.left; e = (e + 1) % n)
    best.top.push_back(e);
  if (best.top.empty()) // a godet ends in a point
    return std::nullopt;
  return best;
}

class GoresInARow {
public:
  GoresInARow(const Pattern& pattern, const std::vector<SeamGuess>& guesses,
              const std::vector<Gore>& gores)
      : m_pattern(pattern), m_guesses(guesses), m_gores(gores) {
    for (std::size_t k = 0; k < gores.size(); ++k)
      m_index[gores[k].panel] = k;
  }

  /// Whether what is guessed of their sides leaves it open which are neighbours.
  bool open() const {
    for (const SeamGuess& g : m_guesses)
      if (takes_side(g.seam) && (g.certain || (g.score > RATHER_SEWN && !within(g.seam))))
        return false;
    if (m_gores.size() > 2)
      return true;
    return std::none_of(m_guesses.begin(), m_guesses.end(),
                        [&](const SeamGuess& g) { return takes_side(g.seam); });
  }
  bool takes_side(const Seam& seam) const {
    for (const auto* runs : {&seam.a, &seam.b})
      for (const Run& run : *runs)
        if (const auto at = m_index.find(run.panel);
            at != m_index.end() &&
            (m_gores[at->second].right == run.edge || m_gores[at->second].left == run.edge))
          return true;
    return false;
  }

  /// The ring's seams, and tops that it puts on the rim; none where the order is not known.
  std::vector<Seam> seams() {
    if (!find_rim())
      return {};
    std::vector<Seam> out;
    std::vector<std::size_t> order;
    std::vector<bool> joined; // to the one before
    if (m_rim.empty()) {
      if (told_apart())
        return {};
      for (std::size_t k = 0; k < m_gores.size(); ++k)
        order.push_back(k);
      joined.assign(order.size(), true);
    } else if (!along_rim(order, joined, out))
      return {};
    for (std::size_t k = 0; k < order.size(); ++k) {
      if (!joined[k])
        continue;
      const Gore &left = m_gores[order[(k + order.size() - 1) % order.size()]],
                 &right = m_gores[order[k]];
      Seam seam;
      seam.name = m_pattern.panels[left.panel].name + "-" + m_pattern.panels[right.panel].name;
      seam.a = {{left.panel, left.right, 0, 1}};
      seam.b = {{right.panel, right.left, 1, 0}};
      out.push_back(std::move(seam));
    }
    return out;
  }

private:
  /// Whether what is likely of their sides sews each of these once: then it is left as it is.
  bool told_apart() const {
    std::set<std::pair<int, int>> taken;
    bool any = false;
    for (const SeamGuess& g : m_guesses) {
      if (!(g.score > RATHER_SEWN) || !takes_side(g.seam))
        continue;
      any = true;
      for (const auto* runs : {&g.seam.a, &g.seam.b})
        for (const Run& run : *runs)
          if (!taken.insert({run.panel, run.edge}).second)
            return false;
    }
    return any;
  }
  bool within(const Seam& seam) const {
    return m_index.count(seam.a[0].panel) && m_index.count(seam.b[0].panel) &&
           seam.a[0].panel != seam.b[0].panel;
  }

  /// Finds the rim above that tops were guessed to; false where they were guessed to several.
  bool find_rim() {
    std::set<int> own;
    for (const Gore& gore : m_gores)
      own.insert(gore.panel);
    for (const SeamGuess& g : m_guesses)
      for (const auto& [runs, others] :
           {std::pair{&g.seam.a, &g.seam.b}, std::pair{&g.seam.b, &g.seam.a}}) {
        const auto at = m_index.find(runs->front().panel);
        if (at == m_index.end() || own.count(others->front().panel))
          continue;
        const std::vector<int>& top = m_gores[at->second].top;
        if (std::find(top.begin(), top.end(), runs->front().edge) == top.end())
          continue;
        for (const Run& run : *others) {
          const auto [place, first] =
              m_above.insert({{run.panel, run.edge}, {at->second, g.score}});
          if (!first && g.score > place->second.second)
            place->second = {at->second, g.score};
        }
      }
    if (m_above.empty())
      return true;
    std::size_t most = 0;
    for (const Rim& rim : rims_of(m_pattern, likely_seams(m_guesses, own))) {
      const std::size_t found = static_cast<std::size_t>(
          std::count_if(rim.edges.begin(), rim.edges.end(), [&](const RimEdge& e) {
            return m_above.count({e.panel, e.edge});
          }));
      if (found > most) {
        most = found;
        m_rim = rim.edges;
      }
    }
    return most == m_above.size();
  }

  /// The gores in the order in which they hang on the rim.
  bool along_rim(std::vector<std::size_t>& order, std::vector<bool>& joined,
                 std::vector<Seam>& tops) {
    std::vector<char> hangs(m_gores.size(), 0);
    for (const auto& [edge, gore] : m_above)
      hangs[gore.first] = 1;
    bool gap = false;
    std::vector<std::size_t> row;
    std::vector<bool> next;
    for (const RimEdge& e : m_rim) {
      auto at = m_above.find({e.panel, e.edge});
      if (at == m_above.end()) {
        const auto free = std::find_if(m_gores.begin(), m_gores.end(), [&](const Gore& gore) {
          const std::size_t k = static_cast<std::size_t>(&gore - m_gores.data());
          return !hangs[k] && gore.top.size() == 1 && fits(gore, e);
        });
        if (free == m_gores.end()) {
          gap = true;
          continue;
        }
        const std::size_t k = static_cast<std::size_t>(free - m_gores.begin());
        hangs[k] = 1;
        at = m_above.insert({{e.panel, e.edge}, {k, GORE_SCORE}}).first;
        Seam seam;
        seam.name = m_pattern.panels[free->panel].name + " top";
        seam.a = {{free->panel, free->top[0], 0, 1}};
        seam.b = {{e.panel, e.edge, 1, 0}};
        tops.push_back(std::move(seam));
      }
      if (row.empty() || row.back() != at->second.first || gap) {
        row.push_back(at->second.first);
        next.push_back(!gap);
      }
      gap = false;
    }
    if (row.size() > 1 && row.front() == row.back() && !gap) {
      row.pop_back();
      next.pop_back();
    } else if (!next.empty())
      next.front() = next.front() && !gap;
    if (row.size() != m_gores.size() ||
        std::set<std::size_t>(row.begin(), row.end()).size() != row.size())
      return false;
    order = std::move(row);
    joined = std::move(next);
    return true;
  }
  bool fits(const Gore& gore, const RimEdge& e) const {
    const double own = length(m_pattern.panels[gore.panel].edge(gore.top[0]).path);
    return std::abs(std::log(own / e.length)) < TOP_FITS;
  }

  const Pattern& m_pattern;
  const std::vector<SeamGuess>& m_guesses;
  const std::vector<Gore>& m_gores;
  std::map<int, std::size_t> m_index;                                    ///< by panel
  std::map<std::pair<int, int>, std::pair<std::size_t, double>> m_above; ///< gore by edge above
  Edges m_rim;
};

} // namespace

std::vector<SeamGuess> with_gore_rows(const Pattern& pattern, std::vector<SeamGuess> given) {
  std::vector<Gore> all;
  double cloth = 0;
  for (int p = 0; p < std::ssize(pattern.panels); ++p) {
    cloth += pattern.panels[p].area();
    if (const std::optional<Gore> gore = gore_of(pattern, p))
      all.push_back(*gore);
  }
  std::vector<char> used(all.size(), 0);
  for (std::size_t k = 0; k < all.size(); ++k) {
    std::vector<Gore> group;
    double own = 0;
    for (std::size_t q = k; q < all.size(); ++q)
      if (!used[q] && std::abs(std::log(all[q].length / all[k].length)) < SAME_SIDE &&
          std::abs(all[q].bulge - all[k].bulge) < SAME_CURVE &&
          std::abs(std::log(all[q].cloth / all[k].cloth)) < SAME_CLOTH) {
        group.push_back(all[q]);
        own += all[q].cloth;
        used[q] = 1;
      }
    if (group.size() < 2 || own < LEAST_CLOTH * cloth)
      continue;
    GoresInARow ring(pattern, given, group);
    if (!ring.open())
      continue;
    const std::vector<Seam> seams = ring.seams();
    if (seams.empty())
      continue;
    drop_unsure(given, [&](const Seam& seam) { return ring.takes_side(seam); });
    const int first = static_cast<int>(given.size());
    for (const Seam& seam : seams)
      given.push_back(rim_guess(seam, false, GORE_SCORE));
    for (int q = first + 1; q < std::ssize(given); ++q)
      given[first].with.push_back(q);
  }
  return given;
}

} // namespace sloper::pattern
