#include <pattern/seams/rims.hpp>
#include <pattern/seams/ring_bands.hpp>
#include <sloper/geometry/disjoint_sets.hpp>

#include <algorithm>
#include <cmath>
#include <optional>

namespace sloper::pattern {
namespace {

constexpr double SLIM_PIECE = 3; // length over width of a piece of a band
constexpr double SHORTEST_RING = 0.75, LONGEST_RING = 1.15; // of the rim's length: no rib
constexpr double MIRRORED = 0.03;                           // logarithm of lengths
constexpr double RING_SCORE = 0.8;

bool is_slim(const Panel& panel) {
  double around = 0;
  for (const PanelEdge& edge : panel.loops[0])
    around += length(edge.path);
  // Of a rectangle whose sides are as SLIM_PIECE to 1.
  constexpr double MOST_AREA = SLIM_PIECE / (4 * (SLIM_PIECE + 1) * (SLIM_PIECE + 1));
  return panel.area() < MOST_AREA * around * around;
}

/// Whether a rim is its own mirror image about the start of an edge.
bool is_middle(const Edges& rim, std::size_t first) {
  const std::size_t n = rim.size();
  for (std::size_t k = 0; k < n; ++k)
    if (std::abs(std::log(rim[(first + k) % n].length / rim[(first + n - 1 - k) % n].length)) >
        MIRRORED)
      return false;
  return true;
}

/// From the start of an edge on to the next seam, m.
double to_next_seam(const Edges& rim, std::size_t first) {
  double sum = 0;
  for (std::size_t k = 0; k < rim.size(); ++k) {
    const RimEdge& edge = rim[(first + k) % rim.size()];
    sum += edge.length;
    if (edge.seam_after >= 0)
      break;
  }
  return sum;
}

/// A rim from its middle at the back on.
/// @param within  the middle of a piece is preferred to that of a seam, else the shorter part
std::optional<Edges> from_back(const Edges& rim, bool within) {
  std::optional<std::size_t> best;
  const auto rank = [&](std::size_t k) {
    const bool seam = rim[(k + rim.size() - 1) % rim.size()].seam_after >= 0;
    return std::pair(within && seam, to_next_seam(rim, k));
  };
  for (std::size_t k = 0; k < rim.size(); ++k)
    if (is_middle(rim, k) && (!best || rank(k) < rank(*best)))
      best = k;
  if (!best)
    return std::nullopt;
  Edges out(rim.begin() + static_cast<long>(*best), rim.end());
  out.insert(out.end(), rim.begin(), rim.begin() + static_cast<long>(*best));
  return out;
}

} // namespace

std::vector<SeamGuess> with_ring_bands(const Pattern& pattern, std::vector<SeamGuess> given) {
  std::vector<SeamGuess> guesses = given;
  std::vector<char> slim;
  for (const Panel& panel : pattern.panels)
    slim.push_back(is_slim(panel));
  DisjointSets chains(pattern.panels.size());
  for (const SeamGuess& g : guesses)
    if (const int a = g.seam.a[0].panel, b = g.seam.b[0].panel; g.certain && slim[a] && slim[b])
      chains.unite(a, b);
  drop_unsure(guesses, [&](const Seam& seam) {
    const int a = seam.a[0].panel, b = seam.b[0].panel;
    return a != b && seam.kind == "gather" && slim[a] && slim[b] &&
           chains.find(a) == chains.find(b);
  });
  const std::vector<Seam> seams = likely_seams(guesses, {});
  std::vector<Rim> rings, others;
  for (Rim& rim : rims_of(pattern, seams)) {
    std::set<int> panels;
    for (const RimEdge& e : rim.edges)
      panels.insert(e.panel);
    const bool all = std::all_of(panels.begin(), panels.end(), [&](int p) { return slim[p]; });
    if (panels.size() > 1)
      (all ? rings : others).push_back(std::move(rim));
  }
  if (rings.size() != 2) // both rims of one ring
    return given;
  const Rim& ring = rings[0].length > rings[1].length ? rings[0] : rings[1];
  const Rim* fits = nullptr;
  for (const Rim& rim : others) {
    const double share = ring.length / rim.length;
    if (share < SHORTEST_RING || share > LONGEST_RING)
      continue;
    if (fits)
      return given; // several fit: none is chosen
    fits = &rim;
  }
  if (!fits)
    return given;
  const auto band = from_back(ring.edges, true), around = from_back(fits->edges, false);
  if (!band || !around)
    return given;
  Seam seam;
  seam.name = pattern.panels[band->front().panel].name + " band-" +
              pattern.panels[around->front().panel].name;
  seam.kind = "gather";
  seam.a = whole(*band, true);
  seam.b = turned(stretch(*around, 0, length_of(*around)));
  // What closes the ring and what sets it on are one answer.
  const int last = std::ssize(guesses);
  guesses.push_back(rim_guess(std::move(seam), false, RING_SCORE));
  int first = -1;
  for (int k = 0; k < last; ++k) {
    SeamGuess& g = guesses[k];
    if (g.certain || !g.with.empty() || g.twin >= 0 || !slim[g.seam.a[0].panel] ||
        !slim[g.seam.b[0].panel])
      continue;
    if (first < 0)
      first = k;
    else
      guesses[first].with.push_back(k);
  }
  if (first >= 0)
    guesses[first].with.push_back(last);
  return guesses;
}

} // namespace sloper::pattern
