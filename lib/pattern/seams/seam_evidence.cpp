#include <pattern/seams/seam_evidence.hpp>
#include <sloper/base/units.hpp>

#include <algorithm>
#include <cmath>
#include <initializer_list>

namespace sloper::pattern {
namespace {

constexpr double LEAST_ODDS = -3;   // of a pair that may be part of a meeting
constexpr double MOST_UNEVEN = 1.4; // logarithm of lengths: gathers of 4 to 1

/// Where a clue's values are cut into classes. The model (seam_model.json) knows classes, not
/// values: what changes here asks for a new one (scripts/fit-seam-model).
using ClueBounds = std::initializer_list<double>;
// logarithms of the lengths' ratio
constexpr ClueBounds LENGTH_RATIOS = {0.0003, 0.001, 0.003, 0.006, 0.01, 0.02, 0.04,
                                      0.06,   0.08,  0.11,  0.15,  0.2,  0.25, 0.3,
                                      0.37,   0.45,  0.52,  0.6,   0.7,  0.8,  1.1};
// degrees off a straight outline
constexpr ClueBounds CORNER_MISSES = {0.5, 1, 2, 4, 7, 11, 16, 23, 32, 45, 65, 90, 130};
// degrees of cloth around the end of a seam
constexpr ClueBounds CORNER_CLOTH = {80,  110, 130, 145, 158, 168, 174, 178, 182,
                                     186, 192, 202, 215, 230, 250, 275, 300, 320,
                                     335, 345, 352, 358, 362, 375, 400};
// of the longer side
constexpr ClueBounds SIDE_RISES = {0.001, 0.003, 0.01, 0.02, 0.04, 0.06, 0.09, 0.12,
                                   0.18,  0.25,  0.35, 0.5,  0.9,  1.4,  1.8};
// of the longer side
constexpr ClueBounds LEANS = {0.001, 0.003, 0.01, 0.02, 0.06, 0.12, 0.2, 0.3, 0.5, 0.9};
// of the side: curves that differ
constexpr ClueBounds OUTLINE_MISSES = {0.001, 0.003, 0.006, 0.01, 0.015, 0.025,
                                       0.04,  0.06,  0.08,  0.11, 0.15,  0.2};
// of the side: how far it bows outwards
constexpr ClueBounds BULGES = {-0.2,  -0.13, -0.08, -0.05, -0.025, -0.01, -0.003,
                               0.003, 0.01,  0.025, 0.05,  0.08,   0.13,  0.2};
// degrees inside the corner between neighbours
constexpr ClueBounds TIP_ANGLES = {60, 100, 150, 178, 182, 210, 250, 290, 310, 325, 340, 350};
// of the panel
constexpr ClueBounds SIDE_HEIGHTS = {0.003, 0.01, 0.03, 0.06, 0.1, 0.2, 0.3, 0.5, 0.7, 0.9};
// logarithms of the outlines' ratio
constexpr ClueBounds PANEL_RATIOS = {0.003, 0.02, 0.05, 0.1, 0.2, 0.4, 0.7, 1.1};
// m
constexpr ClueBounds SIZES = {0.01, 0.02, 0.03, 0.05, 0.08, 0.12, 0.18, 0.25, 0.35, 0.5, 0.7, 1};
// other sides as long
constexpr ClueBounds SIDE_RIVALS = {0.5, 1.5, 2.5, 3.5, 5.5, 7.5, 11.5};
// logarithms: two seams gathered alike
constexpr ClueBounds GATHERINGS = {0.003, 0.01, 0.03, 0.08, 0.2, 0.5, 2};
// sums of probabilities
constexpr ClueBounds SEWN_CHANCES = {0.05, 0.1, 0.2, 0.35, 0.5, 0.7, 0.9, 1.2};
// odds that a neighbour stays free
constexpr ClueBounds FREE_ODDS = {-5, -3, -1, 0, 1, 2, 3, 5};
// sums of probabilities
constexpr ClueBounds PANEL_CHANCES = {0.05, 0.2, 0.5, 0.9, 1.3, 1.7, 2.5, 3.5};
// of the panel's outline
constexpr ClueBounds PANEL_SHARES = {0.01, 0.03, 0.06, 0.1, 0.15, 0.2, 0.25,
                                     0.3,  0.35, 0.4,  0.5, 0.6,  0.7};
// logarithms of the next sides' ratio
constexpr ClueBounds ONWARD_RATIOS = {0.001, 0.003, 0.01, 0.03, 0.08, 0.15, 0.3, 0.6, 1};
// logarithms of odds
constexpr ClueBounds PAIR_ODDS = {-8, -6, -5, -4, -3, -2, -1, -0.3, 0.3, 1, 2, 3, 4, 5, 6.5, 8};
// by how much a pair is ahead of the next
constexpr ClueBounds LEADS = {-11, -8, -5, -3,  -2, -1, -0.3, -0.01, 0.01,
                              0.3, 1,  2,  3.5, 5,  8,  11,   14};
constexpr double AS_LONG = 0.003;        // logarithm of lengths: a rival
constexpr double LEVEL_LOW = 0.15;       // of the panel's height: a lower edge lies below
constexpr double LEVEL_HIGH = 0.85;      // an upper edge lies above
constexpr double NOTCHES_MEET_M = 0.004; // from notch to notch
constexpr double NOTCHES_NEAR_M = 0.015;
constexpr int NO_NEIGHBOUR = 15;    // the class of sides that are neighbours themselves
constexpr int NO_MEETING = 31;      // the same of odds
constexpr int LEANS_OTHER_WAY = 12; // added to the class
constexpr int SAME_PANEL = 10;      // added to the class
constexpr double NONE_BEYOND = 9.0; // logarithm: nothing follows

int bin(double x, ClueBounds bounds) {
  int k = 0;
  for (double b : bounds)
    k += x > b;
  return k;
}

/// 0 upright, 1 askew, 2 level and walked to the right (a lower edge), 3 to the left.
int slope_of(const SeamSide& s) {
  const double up = std::abs(s.chord.y()), across = std::abs(s.chord.x());
  if (up > 2 * across)
    return 0;
  if (across > 2 * up)
    return s.chord.x() > 0 ? 2 : 3;
  return 1;
}

int unordered(int a, int b) { // a, b < 5
  if (a > b)
    std::swap(a, b);
  return b * (b + 1) / 2 + a;
}

double log_ratio(const SeamSide& a, const SeamSide& b) {
  return std::abs(std::log(a.length / b.length));
}

} // namespace

SeamWitness::SeamWitness(const Pattern& pattern, const std::vector<SeamSide>& sides)
    : m_pattern(pattern), m_sides(sides), m_mirrors(panel_mirrors(pattern)) {
  for (const Panel& panel : pattern.panels)
    m_side_of.emplace_back(static_cast<std::size_t>(panel.n_edges()), -1);
  for (std::size_t k = 0; k < sides.size(); ++k)
    m_side_of[sides[k].panel][sides[k].first] = static_cast<int>(k);
  for (const SeamSide& a : sides)
    m_rivals.push_back(
        static_cast<int>(std::count_if(sides.begin(), sides.end(), [&](const SeamSide& b) {
          return &a != &b && log_ratio(a, b) < AS_LONG;
        })));
}

int SeamWitness::image(std::size_t k, const PanelMirror& mirror) const {
  const SeamSide& s = side(k);
  if (s.loop_begin > 0)
    return -1;
  const std::size_t other = static_cast<std::size_t>(mirror.image(s.last(), s.loop_size));
  const int found = m_side_of[mirror.panel][other];
  return found >= 0 && side(static_cast<std::size_t>(found)).count == s.count ? found : -1;
}

std::vector<std::array<int, 2>> SeamWitness::twins(std::size_t i, std::size_t j) const {
  std::vector<std::array<int, 2>> out;
  const int p = side(i).panel, q = side(j).panel;
  for (const PanelMirror& a : m_mirrors[p])
    for (const PanelMirror& b : m_mirrors[q]) {
      if (p == q && (a.panel != b.panel || a.sum != b.sum))
        continue;
      const int k = image(i, a), l = image(j, b);
      if (k < 0 || l < 0 || k == l)
        continue;
      const std::array<int, 2> pair{std::min(k, l), std::max(k, l)};
      if (pair == std::array<int, 2>{static_cast<int>(std::min(i, j)),
                                     static_cast<int>(std::max(i, j))} ||
          std::find(out.begin(), out.end(), pair) != out.end())
        continue;
      out.push_back(pair);
    }
  return out;
}

bool SeamWitness::look(std::size_t i, std::size_t j, Evidence& evidence) const {
  const SeamSide &a = side(i), &b = side(j);
  const double ratio = log_ratio(a, b);
  if (ratio > MOST_UNEVEN)
    return false;
  const auto set = [&](Clue clue, int value) {
    evidence[static_cast<std::size_t>(clue)] = static_cast<std::uint8_t>(value);
  };
  set(Clue::LENGTHS, bin(ratio, LENGTH_RATIOS));
  // b is walked against its outline: its end lies at the start of a.
  const double cloth[2] = {units::degrees(a.corner_start + b.corner_end),
                           units::degrees(a.corner_end + b.corner_start)};
  const double first = std::abs(cloth[0] - 180), last = std::abs(cloth[1] - 180);
  set(Clue::WORSE_CORNER, bin(std::max(first, last), CORNER_MISSES));
  set(Clue::BETTER_CORNER, bin(std::min(first, last), CORNER_MISSES));
  const auto around = [](double angle) { return bin(angle, CORNER_CLOTH); };
  set(Clue::LESS_CLOTH, around(std::min(cloth[0], cloth[1])));
  set(Clue::MORE_CLOTH, around(std::max(cloth[0], cloth[1])));
  const double longer = std::max(a.length, b.length);
  set(Clue::RISE, bin(std::abs(a.chord.y() + b.chord.y()) / longer, SIDE_RISES));
  set(Clue::LEAN,
      (std::abs(a.chord.x() - b.chord.x()) < std::abs(a.chord.x() + b.chord.x())
           ? 0
           : LEANS_OTHER_WAY) +
          bin(std::min(std::abs(a.chord.x() + b.chord.x()), std::abs(a.chord.x() - b.chord.x())) /
                  longer,
              LEANS));
  double answer = 0, fit = 0;
  for (std::size_t k = 0; k < SeamSide::SAMPLES; ++k) {
    const double other = b.offset[SeamSide::SAMPLES - 1 - k];
    answer = std::max(answer, std::abs(a.offset[k] - other));
    fit = std::max(fit, std::abs(a.offset[k] + other));
  }
  set(Clue::ANSWER, bin(answer, OUTLINE_MISSES));
  set(Clue::FIT, bin(fit, OUTLINE_MISSES));
  const auto bend = [](double bulge) { return bin(bulge, BULGES); };
  set(Clue::BEND_LESS, bend(std::min(a.bulge, b.bulge)));
  set(Clue::BEND_MORE, bend(std::max(a.bulge, b.bulge)));
  const bool adjacent = a.after == static_cast<int>(j) || b.after == static_cast<int>(i);
  const auto symmetric = [&](const SeamSide& s) {
    for (const PanelMirror& m : m_mirrors[s.panel])
      if (m.panel == s.panel)
        return true;
    return false;
  };
  const int symmetry = static_cast<int>(symmetric(a)) + static_cast<int>(symmetric(b));
  set(Clue::SYMMETRY, symmetry);
  int kinship = 0;
  if (adjacent)
    kinship = 1;
  else if (a.panel == b.panel) {
    kinship = 2;
    for (const PanelMirror& m : m_mirrors[a.panel])
      if (m.panel == b.panel && image(i, m) == static_cast<int>(j))
        kinship = 3;
  } else
    for (const PanelMirror& m : m_mirrors[a.panel]) {
      if (m.panel != b.panel)
        continue;
      if (image(i, m) == static_cast<int>(j))
        kinship = 5;
      else if (kinship == 0)
        kinship = 4;
    }
  set(Clue::KINSHIP, kinship);
  const double inside =
      units::degrees(a.after == static_cast<int>(j) ? a.corner_end : a.corner_start);
  set(Clue::TIP, adjacent ? 1 + bin(inside, TIP_ANGLES) : 0);
  set(Clue::SLOPE, unordered(slope_of(a), slope_of(b)));
  const auto place = [&](const SeamSide& s) {
    if (slope_of(s) < 2)
      return 0;
    if (s.place.y() < LEVEL_LOW)
      return 1;
    return s.place.y() < LEVEL_HIGH ? 2 : 3;
  };
  set(Clue::PLACES, unordered(place(a), place(b)));
  set(Clue::HEIGHTS, bin(std::abs(a.place.y() - b.place.y()), SIDE_HEIGHTS));
  set(Clue::SHARE, bin(std::min(a.share, b.share), PANEL_SHARES));
  set(Clue::SHARE_LARGE, bin(std::max(a.share, b.share), PANEL_SHARES));
  set(Clue::PANEL_SIZES,
      bin(std::abs(std::log(a.length / a.share * b.share / b.length)), PANEL_RATIOS));
  set(Clue::SIZE, bin(std::sqrt(a.length * b.length), SIZES));
  set(Clue::RIVALS, bin(std::max(m_rivals[i], m_rivals[j]), SIDE_RIVALS));
  const auto beyond = [&](int k, int l) {
    if (k < 0 || l < 0)
      return NONE_BEYOND;
    return log_ratio(side(static_cast<std::size_t>(k)), side(static_cast<std::size_t>(l)));
  };
  const double before = beyond(a.before, b.after), after = beyond(a.after, b.before);
  set(Clue::BEFORE, adjacent ? NO_NEIGHBOUR : bin(std::min(before, after), ONWARD_RATIOS));
  set(Clue::AFTER, adjacent ? NO_NEIGHBOUR : bin(std::max(before, after), ONWARD_RATIOS));
  int notches = 0;
  if (!a.notches.empty() || !b.notches.empty()) {
    notches = 1;
    if (a.notches.size() == b.notches.size()) {
      double worst = 0;
      for (std::size_t k = 0; k < a.notches.size(); ++k)
        worst = std::max(worst,
                         std::abs(a.notches[k] - (b.length - b.notches[b.notches.size() - 1 - k])));
      if (worst < NOTCHES_MEET_M)
        notches = 3;
      else if (worst < NOTCHES_NEAR_M)
        notches = 2;
    }
  }
  set(Clue::NOTCHES, notches);
  return true;
}

SeamWitness::Odds SeamWitness::sum_up(std::vector<double> of_pair) const {
  Odds odds;
  odds.of_pair = std::move(of_pair);
  const std::size_t n = m_sides.size(), panels = m_side_of.size();
  odds.to_panel.assign(n * panels, 0);
  odds.between_panels.assign(panels * panels, 0);
  odds.best.assign(n, {IMPOSSIBLE, IMPOSSIBLE, IMPOSSIBLE});
  odds.mass.assign(n, 0);
  odds.partners.resize(n);
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t j = 0; j < n; ++j) {
      const double own = odds.of_pair[i * n + j];
      if (own <= IMPOSSIBLE)
        continue;
      const double p = 1 / (1 + std::exp(-own));
      const std::size_t from = static_cast<std::size_t>(side(i).panel),
                        to = static_cast<std::size_t>(side(j).panel);
      odds.to_panel[i * panels + to] += p;
      odds.between_panels[from * panels + to] += p;
      odds.mass[i] += p;
      if (own > LEAST_ODDS)
        odds.partners[i].push_back(static_cast<int>(j));
      auto& best = odds.best[i];
      if (own > best[2])
        best[2] = own;
      std::sort(best.rbegin(), best.rend());
    }
  return odds;
}

double SeamWitness::odds_of_neighbours(const Odds& odds, int i, int j) const {
  if (i < 0 || j < 0 || i == j)
    return IMPOSSIBLE;
  return odds.of_pair[static_cast<std::size_t>(i) * m_sides.size() + static_cast<std::size_t>(j)];
}

double SeamWitness::signed_ratio(int i, int j) const {
  return std::log(side(static_cast<std::size_t>(i)).length /
                  side(static_cast<std::size_t>(j)).length);
}

/// Around the end of a seam: `onward` begins there on the one panel, `back` ends there on the
/// other. Between them lie one more panel or two.
SeamWitness::Meeting SeamWitness::meeting(const Odds& odds, int onward, int back) const {
  Meeting best;
  if (onward < 0 || back < 0)
    return best;
  for (int c : odds.partners[onward]) {
    const double first = odds_of_neighbours(odds, onward, c);
    const int d = side(static_cast<std::size_t>(c)).after;
    if (d < 0 || d == onward || c == back)
      continue;
    if (const double all = std::min(first, odds_of_neighbours(odds, d, back)); all > best.odds)
      best = {all, signed_ratio(d, back)};
    if (first <= best.odds)
      continue;
    for (int e : odds.partners[d]) {
      const int f = side(static_cast<std::size_t>(e)).after;
      if (f < 0 || e == onward || f == onward || e == back)
        continue;
      if (const double all =
              std::min({first, odds_of_neighbours(odds, d, e), odds_of_neighbours(odds, f, back)});
          all > best.odds)
        best = {all, signed_ratio(d, e)};
    }
  }
  return best;
}

void SeamWitness::second_look(std::size_t i, std::size_t j, const Odds& odds,
                              Evidence& evidence) const {
  const std::size_t n = m_sides.size(), panels = m_side_of.size();
  const auto set = [&](Clue clue, int value) {
    evidence[static_cast<std::size_t>(clue)] = static_cast<std::uint8_t>(value);
  };
  const double own = odds.of_pair[i * n + j];
  set(Clue::FIRST, bin(own, PAIR_ODDS));
  const auto other_best = [&](std::size_t k) {
    return std::max(odds.best[k][0] == own ? odds.best[k][1] : odds.best[k][0], -8.0);
  };
  const double next[2] = {own - other_best(i), own - other_best(j)};
  set(Clue::RUNNER, bin(std::min(next[0], next[1]), LEADS));
  set(Clue::SECOND, bin(std::max(next[0], next[1]), LEADS));
  const auto pairs = twins(i, j);
  double twin = IMPOSSIBLE;
  for (const auto& [k, l] : pairs)
    twin = std::max(twin, odds_of_neighbours(odds, k, l));
  set(Clue::TWIN, pairs.empty() ? 0 : 1 + bin(twin, PAIR_ODDS));
  const SeamSide &a = side(i), &b = side(j);
  const bool adjacent = a.after == static_cast<int>(j) || b.after == static_cast<int>(i);
  const double before = odds_of_neighbours(odds, a.before, b.after),
               after = odds_of_neighbours(odds, a.after, b.before);
  set(Clue::ONWARD, adjacent ? NO_MEETING : bin(std::max(before, after), PAIR_ODDS));
  set(Clue::ONWARD2, adjacent ? NO_MEETING : bin(std::min(before, after), PAIR_ODDS));
  // Beyond the end of a, cloth goes on from a to b; beyond its start from b to a.
  const Meeting meets[2] = {meeting(odds, a.after, b.before), meeting(odds, b.after, a.before)};
  set(Clue::MEETING, bin(std::max(meets[0].odds, meets[1].odds), PAIR_ODDS));
  set(Clue::MEETING2, bin(std::min(meets[0].odds, meets[1].odds), PAIR_ODDS));
  // The seam that goes on has the panel on a's side first at the one end and second at the other.
  const double ratio = signed_ratio(static_cast<int>(i), static_cast<int>(j));
  double alike = NONE_BEYOND;
  if (meets[0].odds > LEAST_ODDS)
    alike = std::min(alike, std::abs(ratio - meets[0].ratio));
  if (meets[1].odds > LEAST_ODDS)
    alike = std::min(alike, std::abs(ratio + meets[1].ratio));
  set(Clue::GATHERING, bin(alike, GATHERINGS));
  set(Clue::SEWN, bin(std::min(odds.mass[i], odds.mass[j]), SEWN_CHANCES));
  double free = -NONE_BEYOND;
  for (int k : {a.before, a.after, b.before, b.after})
    if (k >= 0)
      free = std::max(free, -odds.best[k][0]);
  set(Clue::FREE, bin(free, FREE_ODDS));
  const std::size_t p = static_cast<std::size_t>(a.panel), q = static_cast<std::size_t>(b.panel);
  const double more = odds.between_panels[p * panels + q] - odds.to_panel[i * panels + q] -
                      odds.to_panel[j * panels + p] + 1 / (1 + std::exp(-own));
  set(Clue::PANELS, (p == q ? SAME_PANEL : 0) + bin(more, PANEL_CHANCES));
}

} // namespace sloper::pattern
