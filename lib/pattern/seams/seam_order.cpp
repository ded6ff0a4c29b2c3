#include <pattern/seams/rims.hpp>
#include <pattern/seams/seam_order.hpp>
#include <pattern/seams/seam_sides.hpp>
#include <sloper/base/units.hpp>

#include <algorithm>
#include <cmath>
#include <optional>

namespace sloper::pattern {
namespace {

constexpr double LIKELY_TWINS = 0.75;  // probability of a guess, and of its mirror image
constexpr double UNLIKELY_RIVAL = 0.1; // of what else could be meant

bool one_panel(const std::vector<Run>& side) {
  return !side.empty() && std::all_of(side.begin(), side.end(),
                                      [&](const Run& r) { return r.panel == side.front().panel; });
}

/// The panels of a seam between two, the lower number first.
std::array<int, 2> panels_of(const Seam& seam) {
  if (!one_panel(seam.a) || !one_panel(seam.b))
    return {-1, -1};
  return {std::min(seam.a[0].panel, seam.b[0].panel), std::max(seam.a[0].panel, seam.b[0].panel)};
}

int edge_on(const Seam& seam, int panel) {
  return (seam.a[0].panel == panel ? seam.a : seam.b)[0].edge;
}

/// 1 where x, y, z come in that order around, -1 where they come in the opposite order.
int sense(int x, int y, int z) {
  return (x < y) + (y < z) + (z < x) == 2 ? 1 : -1;
}

} // namespace

bool in_order(const Pattern& pattern, const Seam& a, const Seam& b, const Seam& c) {
  const auto [p, q] = panels_of(a);
  if (p < 0 || p == q || panels_of(b) != panels_of(a) || panels_of(c) != panels_of(a))
    return true;
  for (const int panel : {p, q}) // of one loop
    if (const int n = static_cast<int>(pattern.panels[panel].loops[0].size());
        std::max({edge_on(a, panel), edge_on(b, panel), edge_on(c, panel)}) >= n)
      return true;
  return sense(edge_on(a, p), edge_on(b, p), edge_on(c, p)) !=
         sense(edge_on(a, q), edge_on(b, q), edge_on(c, q));
}

namespace {

constexpr double EXCHANGEABLE = 0.08; // logarithm of the lengths of sides that change places

/// Whether an edge next to a side of `seam` is in one of the seams that are known: with it, a
/// corner would be sewn shut, as of a hem.
bool closes_corner(const Pattern& pattern, const Seam& seam,
                   const std::vector<const Seam*>& known) {
  const auto takes = [&](int panel, int edge) {
    return std::any_of(known.begin(), known.end(), [&](const Seam* s) {
      for (const auto* side : {&s->a, &s->b})
        for (const Run& r : *side)
          if (r.panel == panel && r.edge == edge)
            return true;
      return false;
    });
  };
  for (const auto* side : {&seam.a, &seam.b})
    for (const Run& r : *side) {
      const Panel& panel = pattern.panels[r.panel];
      for (int e = 0; e < panel.n_edges(); ++e)
        if ((next_edge(panel, e) == r.edge && takes(r.panel, e)) ||
            (e == next_edge(panel, r.edge) && takes(r.panel, e)))
          return true;
    }
  return false;
}

/// The sides of two seams between the same panels, sewn the other way about; nothing where they are
/// not as long.
std::optional<std::array<Seam, 2>> exchanged(const Pattern& pattern, const Seam& one,
                                             const Seam& other) {
  Seam first = one, second = other;
  if (one.a[0].panel == other.a[0].panel)
    std::swap(first.b, second.b);
  else
    std::swap(first.b, second.a);
  for (const Seam* s : {&first, &second})
    if (std::abs(std::log(side_length(pattern, s->a) / side_length(pattern, s->b))) > EXCHANGEABLE)
      return std::nullopt;
  std::swap(first.name, second.name);
  return std::array<Seam, 2>{first, second};
}

bool same_sides(const Seam& x, const Seam& y) {
  const auto has = [](const Seam& s, const Run& r) {
    return (s.a[0].panel == r.panel && s.a[0].edge == r.edge) ||
           (s.b[0].panel == r.panel && s.b[0].edge == r.edge) ||
           (s.a.back().panel == r.panel && s.a.back().edge == r.edge) ||
           (s.b.back().panel == r.panel && s.b.back().edge == r.edge);
  };
  return has(x, y.a[0]) && has(x, y.b[0]);
}

} // namespace

namespace {

constexpr double BAG = 90; // degrees that both outlines together turn by where a bag has its corner

/// Degrees by which the outline turns to the left between two edges of a panel.
double turn_between(const Panel& panel, int edge, int next) {
  const ArcLength in(panel.edge(edge).path), out(panel.edge(next).path);
  const Vec2 u = in.tangent(in.length()), v = out.tangent(0);
  return units::degrees(std::atan2(u.x() * v.y() - u.y() * v.x(), u.dot(v)));
}

/// The turn of a panel's outline between an edge of one seam and an edge of another; nothing where
/// they are not next to each other.
std::optional<double> turn_between(const Pattern& pattern, int p, const Seam& one,
                                   const Seam& other) {
  const Panel& panel = pattern.panels[p];
  for (const Run& a : one.a[0].panel == p ? one.a : one.b)
    for (const Run& b : other.a[0].panel == p ? other.a : other.b) {
      if (next_edge(panel, a.edge) == b.edge)
        return turn_between(panel, a.edge, b.edge);
      if (next_edge(panel, b.edge) == a.edge)
        return turn_between(panel, b.edge, a.edge);
    }
  return std::nullopt;
}

} // namespace

namespace {

/// Whether two seams of the same two panels are next to each other around a corner of both.
bool make_bag(const Pattern& pattern, const Seam& one, const Seam& other) {
  const auto [p, q] = panels_of(one);
  if (p < 0 || p == q || panels_of(other) != panels_of(one))
    return false;
  const auto a = turn_between(pattern, p, one, other), b = turn_between(pattern, q, one, other);
  return a && b && *a + *b > BAG;
}

/// The edges that follow both sides of a seam at one end, where both outlines go straight on.
std::optional<std::array<Run, 2>> onward(const Pattern& pattern, const Seam& seam, bool at_end) {
  constexpr double STRAIGHT = 25; // degrees: CAD files cut sides up at corners that turn by less
  std::array<Run, 2> out;
  for (std::size_t k = 0; k < 2; ++k) {
    const std::vector<Run>& side = k == 0 ? seam.a : seam.b;
    const Run& run = at_end ? side.back() : side.front();
    const Panel& panel = pattern.panels[run.panel];
    if (std::abs(run.to - run.from) < 1)
      return std::nullopt;
    int edge = run.edge;
    if ((run.from < run.to) == at_end)
      edge = next_edge(panel, run.edge);
    else
      while (next_edge(panel, edge) != run.edge)
        edge = next_edge(panel, edge);
    const bool ahead = (run.from < run.to) == at_end;
    const double turn =
        ahead ? turn_between(panel, run.edge, edge) : turn_between(panel, edge, run.edge);
    if (edge == run.edge || std::abs(turn) > STRAIGHT)
      return std::nullopt;
    out[k] = {run.panel, edge, run.from, run.to};
  }
  return out;
}

bool takes(const Seam& seam, const Run& run) {
  for (const auto* side : {&seam.a, &seam.b})
    for (const Run& r : *side)
      if (r.panel == run.panel && r.edge == run.edge)
        return true;
  return false;
}

} // namespace

std::vector<Seam> continue_seams(const Pattern& pattern, std::vector<SeamGuess>& guesses) {
  constexpr double SCORE = 0.9;       // it may be a slit
  constexpr double AS_LONG = 0.02;    // logarithm of lengths
  constexpr double SHORTEST_M = 0.03; // what is shorter is the turn of a hem
  const std::size_t known = guesses.size();
  std::vector<Seam> out;
  for (std::size_t k = 0; k < known; ++k) {
    if (!guesses[k].certain || panels_of(guesses[k].seam)[0] == panels_of(guesses[k].seam)[1])
      continue;
    for (const bool at_end : {false, true}) {
      const auto next = onward(pattern, guesses[k].seam, at_end);
      if (!next || std::any_of(guesses.begin(), guesses.end(), [&](const SeamGuess& g) {
            return takes(g.seam, (*next)[0]) || takes(g.seam, (*next)[1]);
          }))
        continue;
      const double a = run_length(pattern, (*next)[0]), b = run_length(pattern, (*next)[1]);
      if (std::min(a, b) < SHORTEST_M || std::abs(std::log(a / b)) > AS_LONG)
        continue;
      Seam seam;
      seam.name = guesses[k].seam.name + " onward";
      seam.a = {(*next)[0]};
      seam.b = {(*next)[1]};
      if (std::none_of(guesses.begin(), guesses.end(), [&](const SeamGuess& g) {
            return !g.certain && make_bag(pattern, g.seam, seam);
          }))
        continue;
      guesses.push_back(rim_guess(seam, false, SCORE));
      out.push_back(std::move(seam));
    }
  }
  const auto mirrors = panel_mirrors(pattern);
  const auto mirrored = [&](int p, int q) {
    return std::any_of(mirrors[p].begin(), mirrors[p].end(),
                       [&](const PanelMirror& m) { return m.panel == q && p != q; });
  };
  for (std::size_t i = known; i < guesses.size(); ++i)
    for (std::size_t k = i + 1; k < guesses.size(); ++k) {
      const auto [a, b] = panels_of(guesses[i].seam);
      const auto [c, d] = panels_of(guesses[k].seam);
      if (guesses[i].twin < 0 && guesses[k].twin < 0 &&
          ((mirrored(a, c) && mirrored(b, d)) || (mirrored(a, d) && mirrored(b, c)))) {
        guesses[i].twin = static_cast<int>(k);
        guesses[k].twin = static_cast<int>(i);
      }
    }
  return out;
}

void drop_bags(const Pattern& pattern, std::vector<SeamGuess>& guesses,
               const std::vector<Seam>& continued) {
  const auto mirrors = panel_mirrors(pattern);
  const auto mirrored = [&](int p, int q) {
    const auto& own = mirrors[p];
    return std::any_of(own.begin(), own.end(), [&](const PanelMirror& m) { return m.panel == q; });
  };
  std::vector<Seam> known = continued;
  for (const SeamGuess& g : guesses)
    if (g.certain)
      known.push_back(g.seam);
  drop_unsure(guesses, [&](const Seam& seam) {
    const auto ends = panels_of(seam);
    const int p = ends[0];
    const int q = ends[1];
    if (p < 0 || p == q || mirrored(p, q))
      return false;
    return std::any_of(known.begin(), known.end(),
                       [&](const Seam& other) { return make_bag(pattern, seam, other); });
  });
}

void settle_by_order(const Pattern& pattern, std::vector<SeamGuess>& guesses) {
  for (std::size_t k = 0; k < guesses.size(); ++k) {
    SeamGuess& guess = guesses[k];
    const auto panels = panels_of(guess.seam);
    if (guess.certain || guess.twin < 0 || panels[0] < 0 || panels[0] == panels[1])
      continue;
    SeamGuess& twin = guesses[guess.twin];
    if (twin.certain || panels_of(twin.seam) != panels)
      continue;
    std::vector<const Seam*> known;
    for (const SeamGuess& g : guesses)
      if (g.certain && panels_of(g.seam) == panels)
        known.push_back(&g.seam);
    if (known.size() < 2 || closes_corner(pattern, guess.seam, known))
      continue;
    const auto fits = [&](const Seam& one, const Seam& other) {
      return in_order(pattern, *known[0], one, other) && in_order(pattern, *known[1], one, other);
    };
    double score = std::min(guess.score, twin.score);
    const auto swapped = exchanged(pattern, guess.seam, twin.seam);
    const bool twisted = !fits(guess.seam, twin.seam);
    if (twisted && (!swapped || !fits((*swapped)[0], (*swapped)[1])))
      continue;
    bool rival = false;
    for (const SeamGuess* g : {&guess, &twin})
      for (const SeamGuess& other : g->instead) {
        const bool exchange = swapped && (same_sides((*swapped)[0], other.seam) ||
                                          same_sides((*swapped)[1], other.seam));
        if (exchange)
          score = std::max(score, other.score);
        rival = rival || (!exchange && other.score >= UNLIKELY_RIVAL);
      }
    if (twisted) {
      guess.seam = (*swapped)[0];
      twin.seam = (*swapped)[1];
    }
    if (twisted) {
      guess.instead.clear();
      twin.instead.clear();
    }
    if (score >= LIKELY_TWINS && !rival)
      guess.certain = twin.certain = true;
  }
}

} // namespace sloper::pattern
