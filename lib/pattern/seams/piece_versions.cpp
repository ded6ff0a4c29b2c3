#include <pattern/panel_words.hpp>
#include <pattern/read/choose_pieces.hpp>
#include <pattern/seams/band_seams.hpp>
#include <sloper/pattern/seams/infer_seams.hpp>
#include <sloper/pattern/seams/piece_versions.hpp>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <set>

namespace sloper::pattern {
namespace {

using Unit = std::vector<int>; ///< panels: a piece, or one with its mirror image

std::vector<Unit> units_of(const Pattern& pattern) {
  std::vector<Unit> units;
  for (int p = 0; p < std::ssize(pattern.panels); ++p) {
    const std::string& name = pattern.panels[p].name;
    const auto original = std::find_if(units.begin(), units.end(), [&](const Unit& unit) {
      return pattern.panels[unit[0]].name + MIRRORED == name;
    });
    if (original != units.end())
      original->push_back(p);
    else
      units.push_back({p});
  }
  return units;
}

Pattern without(const Pattern& pattern, const std::vector<Unit>& units, std::size_t but) {
  Pattern out = pattern;
  std::vector<bool> remove(pattern.panels.size(), false);
  for (std::size_t k = 0; k < units.size(); ++k)
    for (const int p : units[k])
      remove[p] = k != but;
  remove_panels(out, remove);
  return out;
}

/// Takes all but the first out of the pattern.
PieceVersions keep_first(Pattern& pattern, const std::vector<Unit>& units) {
  PieceVersions out;
  for (const Unit& unit : units) {
    std::vector<std::string>& names = out.emplace_back();
    for (const int p : unit) { // the name of a piece means its mirrored copy too
      const std::string& name = pattern.panels[p].name;
      if (std::none_of(names.begin(), names.end(),
                       [&](const std::string& n) { return n + MIRRORED == name; }))
        names.push_back(name);
    }
  }
  pattern = without(pattern, units, 0);
  for (std::size_t k = 1; k < out.size(); ++k)
    pattern.findings.push_back(
        {"dxf.piece-left-out"_id, out[k].front() + " is left out: it is made in place of " +
                                      out.front().front() + "; name it in --pieces to take it"});
  return out;
}

/// Pairs of legs in one piece, each of which is a pair of trousers by itself.
std::vector<Unit> pairs_of_legs(const Pattern& pattern) {
  std::set<std::set<int>> pairs;
  for (const SeamGuess& guess : with_legs(pattern, {}))
    if (std::set<int> pair{guess.seam.a[0].panel, guess.seam.b[0].panel}; pair.size() == 2)
      pairs.insert(std::move(pair));
  std::vector<Unit> units;
  for (const std::set<int>& pair : pairs)
    units.emplace_back(pair.begin(), pair.end());
  return units;
}

/// How surely panels are sewn among themselves.
double sewn_alone(const Pattern& pattern, const Unit& panels) {
  Pattern own = pattern;
  std::vector<bool> remove(pattern.panels.size(), true);
  for (const int p : panels)
    remove[p] = false;
  remove_panels(own, remove);
  return sewn_surely(own, infer_seams(own));
}

/// Whether pairs are sewn to each other, and not only each to itself: the halves of a front and of
/// a back, whose middles and sides look like crotch curves and inseams of trousers.
bool are_one_garment(const Pattern& pattern, const std::vector<Unit>& pairs) {
  constexpr double MORE_CLOTH = 1.1; // of what the pairs sew by themselves
  double apart = 0;
  Unit all;
  for (const Unit& pair : pairs) {
    apart += sewn_alone(pattern, pair);
    all.insert(all.end(), pair.begin(), pair.end());
  }
  return sewn_alone(pattern, all) > MORE_CLOTH * apart;
}

double cloth_of(const Pattern& pattern, const Unit& unit) {
  double sum = 0;
  for (const int p : unit)
    sum += pattern.panels[p].area();
  return sum;
}

/// How surely all are sewn, less what sews two units of one size: a hood fits its other version.
/// @param guesses  of the pattern
double sewn_together(const Pattern& pattern, const std::vector<Unit>& units,
                     std::vector<SeamGuess> guesses) {
  constexpr double SAME_SIZE = 0.15; // logarithm of areas: a collar and its stand differ by more
  const auto unit_of = [&](int p) {
    return std::find_if(units.begin(), units.end(), [&](const Unit& unit) {
      return std::find(unit.begin(), unit.end(), p) != unit.end();
    });
  };
  const auto of_versions = [&](const SeamGuess& g) {
    const auto a = unit_of(g.seam.a[0].panel), b = unit_of(g.seam.b[0].panel);
    return a != b && a != units.end() && b != units.end() && a->size() == b->size() &&
           std::abs(std::log(cloth_of(pattern, *a) / cloth_of(pattern, *b))) < SAME_SIZE;
  };
  guesses.erase(std::remove_if(guesses.begin(), guesses.end(), of_versions), guesses.end());
  return sewn_surely(pattern, guesses);
}

/// Of pieces of one kind, the best alone first, where it is sewn better without the others.
/// @param inferred  seams of the pattern where they are known, then of what is left of it
std::vector<Unit> best_alone(const Pattern& pattern, std::vector<Unit> units,
                             std::optional<std::vector<SeamGuess>>& inferred) {
  constexpr std::size_t MOST_VERSIONS = 8; // versions of one part; more is a library of parts
  constexpr double BETTER = 0.1; // m of seams: less is no difference, and the file's order counts
  if (units.size() < 2 || units.size() > MOST_VERSIONS)
    return {};
  std::vector<double> worth;
  std::vector<std::vector<SeamGuess>> guesses;
  for (std::size_t k = 0; k < units.size(); ++k) {
    const Pattern alone = without(pattern, units, k);
    guesses.push_back(infer_seams(alone));
    worth.push_back(sewn_surely(alone, guesses.back()));
  }
  std::vector<std::size_t> order(units.size());
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return std::lround(worth[a] / BETTER) > std::lround(worth[b] / BETTER);
  });
  if (!inferred)
    inferred = infer_seams(pattern);
  if (worth[order[0]] <= sewn_together(pattern, units, *inferred) + BETTER)
    return {};
  inferred = std::move(guesses[order[0]]);
  std::vector<Unit> out;
  for (const std::size_t k : order)
    out.push_back(units[k]);
  return out;
}

} // namespace

std::vector<PieceVersions> take_versions(Pattern& pattern,
                                         std::optional<std::vector<SeamGuess>>& inferred) {
  std::vector<PieceVersions> out;
  inferred.reset();
  if (const std::vector<Unit> legs = pairs_of_legs(pattern);
      legs.size() > 1 && !are_one_garment(pattern, legs))
    out.push_back(keep_first(pattern, legs));
  const auto is_sleeve = [](const Words& words) {
    return says_sleeve(words) && !says_cuff(words) && !name_suggests_front(words) &&
           !says_back(words);
  };
  for (const bool neck : {true, false}) {
    std::vector<Unit> units;
    for (const Unit& unit : units_of(pattern))
      if (const Words words = words_of(pattern, static_cast<std::size_t>(unit[0]));
          neck ? says_neck(words) : is_sleeve(words))
        units.push_back(unit);
    if (const std::vector<Unit> best = best_alone(pattern, std::move(units), inferred);
        !best.empty())
      out.push_back(keep_first(pattern, best));
  }
  return out;
}

} // namespace sloper::pattern
