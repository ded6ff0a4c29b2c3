#include <pattern/seams/sleeve_halves.hpp>

#include <pattern/panel_words.hpp>
#include <pattern/seams/seam_sides.hpp>
#include <sloper/base/units.hpp>

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

namespace sloper::pattern {
namespace {

constexpr double SHARP_CORNER = 25;        // degrees by which an outline turns at the end of a side
constexpr double SQUARE_HEM = 130;         // degrees, of the cloth at both ends of a hem at most
constexpr double ACROSS_GRAIN = 2;         // of its chord over that along it: caps slant
constexpr double AS_LONG = 0.03;           // logarithm of lengths
constexpr double SHORTEST_UNDERARM = 0.04; // m
constexpr double OFFERED = 0.3;            // probability: less likely than what is guessed

/// How far two sides go along each other from a hem, in edges of each: the farthest place at which
/// both have a corner. Zeros where there is none.
struct SidesMet {
  int own = 0, other = 0;
  double length = 0; ///< m
};

SidesMet meet(const Pattern& pattern, const SeamSide& from_hem, const SeamSide& to_hem) {
  SidesMet met;
  for (int i = 1; i <= from_hem.count; ++i) {
    const double own = measure_side(pattern, from_hem.panel, from_hem.first, i).length;
    for (int j = 1; j <= to_hem.count; ++j) {
      const int first = to_hem.loop_begin +
                        (to_hem.first - to_hem.loop_begin + to_hem.count - j) % to_hem.loop_size;
      const double other = measure_side(pattern, to_hem.panel, first, j).length;
      if (own > std::max(met.length, SHORTEST_UNDERARM) &&
          std::abs(std::log(own / other)) < AS_LONG)
        met = {i, j, own};
    }
  }
  return met;
}

/// A hem of each piece, and the seams from there on.
struct HalvesMet {
  const SeamSide *hem = nullptr, *other = nullptr;
  SidesMet after, before; ///< the hem
  double length() const { return after.length + before.length; }
};

bool is_square_hem(const SeamSide& s) {
  return s.before >= 0 && s.after >= 0 && s.before != s.after &&
         std::abs(s.chord.x()) > ACROSS_GRAIN * std::abs(s.chord.y()) &&
         std::max(s.corner_start, s.corner_end) < units::radians(SQUARE_HEM);
}

/// Edges from the end of one side's run along its outline, and the other's against it.
Seam seam_from_hem(const Pattern& pattern, const SeamSide& after, const SeamSide& before,
                   const SidesMet& met) {
  Seam seam;
  for (int k = 0; k < met.own; ++k)
    seam.a.push_back({after.panel,
                      after.loop_begin + (after.first - after.loop_begin + k) % after.loop_size, 0,
                      1});
  for (int k = 0; k < met.other; ++k)
    seam.b.push_back(
        {before.panel,
         before.loop_begin +
             (before.last() - before.loop_begin + before.loop_size - k) % before.loop_size,
         1, 0});
  const auto name = [&](const std::vector<Run>& side) {
    const Panel& panel = pattern.panels[side.front().panel];
    const std::string first = panel.name + "." + panel.edge(side.front().edge).name;
    return side.size() > 1 ? first + ".." + panel.edge(side.back().edge).name : first;
  };
  seam.name = name(seam.a) + "-" + name(seam.b);
  return seam;
}

bool has_run(const Seam& seam, const Run& run) {
  const auto is_it = [&](const Run& r) { return r.panel == run.panel && r.edge == run.edge; };
  return std::any_of(seam.a.begin(), seam.a.end(), is_it) ||
         std::any_of(seam.b.begin(), seam.b.end(), is_it);
}

bool has_all(const Seam& seam, const std::vector<Run>& side) {
  return std::all_of(side.begin(), side.end(), [&](const Run& r) { return has_run(seam, r); });
}

bool has_any(const Seam& seam, const Seam& other) {
  const auto meets = [&](const Run& r) { return has_run(seam, r); };
  return std::any_of(other.a.begin(), other.a.end(), meets) ||
         std::any_of(other.b.begin(), other.b.end(), meets);
}

} // namespace

std::vector<SleeveHalves> sleeve_halves(const Pattern& pattern) {
  std::vector<Words> words;
  for (std::size_t p = 0; p < pattern.panels.size(); ++p)
    words.push_back(words_of(pattern, p));
  const std::vector<SeamSide> sides =
      seam_sides(pattern, sharp_corners(pattern, units::radians(SHARP_CORNER)), 0);
  std::map<std::pair<int, int>, HalvesMet> longest; // by panels
  for (const SeamSide& hem : sides)
    for (const SeamSide& other : sides) {
      if (hem.panel >= other.panel || !say_sleeve_halves(words[hem.panel], words[other.panel]) ||
          !is_square_hem(hem) || !is_square_hem(other))
        continue;
      const HalvesMet found{&hem, &other, meet(pattern, sides[hem.after], sides[other.before]),
                            meet(pattern, sides[other.after], sides[hem.before])};
      HalvesMet& best = longest[{hem.panel, other.panel}];
      if (found.after.own > 0 && found.before.own > 0 && found.length() > best.length())
        best = found;
    }
  std::vector<SleeveHalves> out;
  for (const auto& [panels, found] : longest) {
    if (!found.hem)
      continue;
    const SeamSide &hem = *found.hem, &other = *found.other;
    const Seam after = seam_from_hem(pattern, sides[hem.after], sides[other.before], found.after),
               before = seam_from_hem(pattern, sides[other.after], sides[hem.before], found.before);
    const bool is_over = found.after.length > found.before.length;
    out.push_back({is_over ? after : before, is_over ? before : after, {hem.panel, hem.first}});
  }
  return out;
}

void offer_sleeve_halves(const Pattern& pattern, std::vector<SeamGuess>& guesses) {
  std::vector<Seam> seams;
  for (const SleeveHalves& halves : sleeve_halves(pattern)) {
    seams.push_back(halves.over);
    seams.push_back(halves.under);
  }
  for (const Seam& seam : seams) {
    const bool is_taken = std::any_of(guesses.begin(), guesses.end(), [&](const SeamGuess& g) {
      const bool is_it = has_all(g.seam, seam.a) && has_all(g.seam, seam.b);
      return is_it || (g.certain && has_any(g.seam, seam));
    });
    if (is_taken)
      continue;
    for (SeamGuess& guess : guesses) {
      if (!has_any(guess.seam, seam))
        continue;
      SeamGuess other;
      other.seam = seam;
      other.score = std::min(OFFERED, guess.score);
      guess.instead = {std::move(other)};
    }
  }
}

} // namespace sloper::pattern
