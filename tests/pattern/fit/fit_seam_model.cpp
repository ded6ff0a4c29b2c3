/// Fits seam_model.json to specifications whose seams are known.
///
///   fit_seam_model MODEL.json [-v] SPECIFICATION...
///
/// Names, placement and seams are taken away. Every specification whose path has "keep" in it is
/// not learned from but reported on; of the others there is a second version with halves of panels
/// joined to one piece, as CAD files have them. Each look learns from odds that the look before
/// gave to garments that it had not seen (three folds), the settling from states in which part of
/// the true seams are settled, the judge from assemblies of garments that were not seen.
#include "boosting.hpp"
#include "join_panels.hpp"
#include "renaming.hpp"
#include "specimen.hpp"

#include <sloper/pattern/read/read_pattern.hpp>

#include <cmath>
#include <cstdio>
#include <fstream>
#include <iostream>
#include <memory>
#include <random>

using namespace sloper;
using namespace sloper::pattern;
using namespace sloper::pattern::fit;

namespace {

constexpr std::size_t FOLDS = 3;

std::vector<const Sample*> gather(const std::vector<Garment*>& garments, std::size_t but) {
  std::vector<const Sample*> out;
  for (std::size_t k = 0; k < garments.size(); ++k)
    if (k % FOLDS != but)
      for (const Sample& s : garments[k]->samples)
        out.push_back(&s);
  return out;
}

/// One set of trees for each fold, learned from the others; the last from all.
std::vector<SeamTrees> folds(const std::vector<Garment*>& train, std::size_t clues,
                             const Boosting& how) {
  std::vector<SeamTrees> out;
  for (std::size_t f = 0; f <= FOLDS; ++f)
    out.push_back(boost(gather(train, f), clues, how));
  return out;
}

class Fit {
public:
  explicit Fit(std::vector<std::unique_ptr<Garment>>& all) {
    for (auto& g : all)
      (g->kept ? m_kept : m_train).push_back(g.get());
  }

  SeamModel run(bool verbose) {
    SeamModel model;
    const std::size_t plain = static_cast<std::size_t>(Clue::SETTLED);
    for (int look = 0; look < 3; ++look) {
      for (Garment* g : m_train)
        sample_look(*g, look > 0);
      const auto trees = folds(m_train, look ? plain : FIRST_LOOK, m_how);
      each([&](Garment& g, std::size_t fold) {
        g.odds = g.assembly->look(trees[fold], look ? &g.odds : nullptr);
      });
      model.looks.push_back(trees.back());
      std::printf("look %d\n", look);
      std::fflush(stdout);
    }
    for (Garment* g : m_train)
      sample_states(*g);
    const auto settle = folds(m_train, plain, m_how);
    model.settle = settle.back();
    std::map<Garment*, SeamAssembly::Settled> settled;
    each([&](Garment& g, std::size_t fold) {
      settled[&g] = g.assembly->settle(settle[fold], g.odds, {}, {});
      std::set<SidePair> guess;
      for (const auto& [pair, odds] : settled[&g].at)
        guess.insert(pair);
      const std::set<SidePair> right = right_ones(g.pattern, g.sides, guess, g.truth);
      g.samples.clear();
      for (const SidePair& pair : guess)
        g.samples.push_back(
            {pair, g.assembly->judged(g.odds, settled[&g], pair), right.count(pair) > 0, 1});
    });
    model.judge = boost(gather(m_train, FOLDS), CLUES, m_how);
    report(model, verbose);
    return model;
  }

private:
  template<class F> void each(F f) {
    for (std::size_t k = 0; k < m_train.size(); ++k)
      f(*m_train[k], k % FOLDS);
    for (Garment* g : m_kept)
      f(*g, FOLDS);
  }
  double share() { return static_cast<double>(m_random() >> 11) / 9007199254740992.0; }

  void sample_look(Garment& g, bool again) {
    g.samples.clear();
    const std::size_t n = g.sides.size();
    for (const auto& pair : g.assembly->pairs()) {
      Sample s{{pair.i, pair.j}, pair.evidence, g.truth.count({pair.i, pair.j}) > 0, 1};
      const std::size_t i = static_cast<std::size_t>(pair.i), j = static_cast<std::size_t>(pair.j);
      const double part_again = g.odds.of_pair[i * n + j] < -5 ? 0.025 : 0.4;
      const double part = again ? part_again : 0.08;
      if (!s.sewn && share() > part)
        continue;
      if (!s.sewn)
        s.weight = static_cast<float>(1 / part);
      if (again)
        g.witness->second_look(i, j, g.odds, s.evidence);
      g.samples.push_back(s);
    }
  }

  void sample_states(Garment& g) {
    constexpr int STATES = 3;
    g.samples.clear();
    const std::size_t n = g.sides.size();
    for (int state = 0; state < STATES; ++state) {
      std::vector<double> odds = g.odds.of_pair;
      const double part = (state + share()) / STATES;
      std::set<SidePair> done;
      for (const SidePair& t : g.truth) {
        const double own =
            odds[static_cast<std::size_t>(t[0]) * n + static_cast<std::size_t>(t[1])];
        if (share() < part * (0.3 + 1.4 / (1 + std::exp(-own)))) {
          g.assembly->commit(odds, t);
          done.insert(t);
        }
      }
      const SeamWitness::Odds sums = g.witness->sum_up(odds);
      for (const auto& pair : g.assembly->pairs()) {
        const std::size_t i = static_cast<std::size_t>(pair.i),
                          j = static_cast<std::size_t>(pair.j);
        if (odds[i * n + j] <= SeamWitness::IMPOSSIBLE || done.count({pair.i, pair.j}))
          continue;
        Sample s{{pair.i, pair.j}, pair.evidence, g.truth.count({pair.i, pair.j}) > 0, 1};
        const double part_kept = odds[i * n + j] < -5 ? 0.02 : 0.35;
        if (!s.sewn && share() > part_kept)
          continue;
        if (!s.sewn)
          s.weight = static_cast<float>(1 / part_kept);
        g.witness->second_look(i, j, sums, s.evidence);
        g.samples.push_back(s);
      }
    }
  }

  void report(const SeamModel& model, bool verbose) {
    std::size_t hits = 0, guessed = 0, sewn = 0, whole = 0;
    std::map<int, std::array<int, 2>> grades;
    for (Garment* g : m_kept) {
      PairOdds found = g->assembly->run(model).pairs;
      std::erase_if(found, [](const auto& item) { return item.second < 0; });
      std::set<SidePair> guess;
      for (const auto& [pair, odds] : found)
        guess.insert(pair);
      const std::set<SidePair> right = right_ones(g->pattern, g->sides, guess, g->truth);
      hits += right.size();
      guessed += guess.size();
      sewn += g->truth.size();
      whole += right.size() == guess.size() && guess.size() == g->truth.size();
      for (const auto& [pair, odds] : found) {
        auto& grade = grades[static_cast<int>(std::floor(std::min(odds, 8.0) * 2))];
        ++grade[0];
        grade[1] += static_cast<int>(right.count(pair));
      }
      if (!verbose)
        continue;
      std::printf("%s: %zu seams, %zu guessed, %zu right\n", g->path.c_str(), g->truth.size(),
                  guess.size(), right.size());
      for (const auto& [pair, odds] : found)
        if (!right.count(pair))
          print("wrong", *g, pair, odds);
      if (right.size() == guess.size())
        for (const SidePair& pair : g->truth)
          if (!guess.count(pair))
            print("missed", *g, pair, 0);
    }
    const double p = static_cast<double>(hits) / static_cast<double>(guessed),
                 r = static_cast<double>(hits) / static_cast<double>(sewn);
    std::printf("%zu kept: precision %.3f, recall %.3f, F1 %.3f, wholly right %zu\n", m_kept.size(),
                p, r, 2 * p * r / (p + r), whole);
    for (const auto& [k, grade] : grades)
      std::printf("  log-odds from %.1f: %d of %d\n", 0.5 * k, grade[1], grade[0]);
  }
  static void print(const char* what, const Garment& g, const SidePair& pair, double odds) {
    std::printf("   %s", what);
    for (int k : pair) {
      const SeamSide& s = g.sides[k];
      std::printf(" %s.%d (%.1f cm)", g.pattern.panels[s.panel].name.c_str(), s.first,
                  100 * s.length);
    }
    std::printf(" %.1f\n", odds);
  }

  std::vector<Garment*> m_train, m_kept;
  Boosting m_how;
  std::mt19937_64 m_random{99};
};

} // namespace

int main(int argc, char** argv) {
  if (argc < 3) {
    std::cerr << "usage: fit_seam_model MODEL.json [-v] SPECIFICATION...\n";
    return 2;
  }
  std::vector<std::unique_ptr<Garment>> all;
  bool verbose = false;
  std::mt19937_64 random(7);
  for (int k = 2; k < argc; ++k) {
    if (std::string(argv[k]) == "-v") {
      verbose = true;
      continue;
    }
    const Pattern pattern = read_pattern(argv[k], PatternChoice{});
    if (pattern.seams.empty())
      continue;
    all.push_back(prepare(argv[k], pattern));
    if (all.back()->kept)
      continue;
    const bool none = random() % 4 == 0; // joined all through, or here and there
    Pattern other = joined(pattern, [&] { return none && random() % 2 == 0; });
    if (other.panels.size() < pattern.panels.size() && !other.seams.empty())
      all.push_back(prepare(argv[k], std::move(other)));
  }
  const SeamModel model = Fit(all).run(verbose);
  std::ofstream out(argv[1]);
  out << "{\"looks\": [\n";
  for (std::size_t k = 0; k < model.looks.size(); ++k)
    out << trees_text(model.looks[k]) << (k + 1 < model.looks.size() ? ",\n" : "],\n");
  out << "\"settle\": " << trees_text(model.settle) << ",\n\"judge\": " << trees_text(model.judge)
      << "}\n";
  return out ? 0 : 5;
}
