/// Fits the weights "whole" of seam_model.json to specifications whose seams are known. They are
/// written by themselves; the trees of seam_model.json come first (fit_seam_model.cpp).
///
///   fit_garment_model WEIGHTS.json [-v] [-p] SPECIFICATION...
///
/// The true assembly is to score more than any other that a climb meets: those one move away from
/// it, the one that is guessed pair by pair, and where a climb from that one ends with the weights
/// of the round before. Logistic regression on the differences of their clues. Specifications
/// whose path has "keep" in it are not learned from but reported on. With -p the present weights
/// are what is guessed first, for clues that are new or a few designs more.
#include "renaming.hpp"
#include "specimen.hpp"

#include <pattern/seams/garment_search.hpp>
#include <pattern/seams/seam_model.hpp>
#include <pattern/seams/whole_garment.hpp>
#include <sloper/pattern/read/read_pattern.hpp>

#include <Eigen/Dense>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <iostream>

using namespace sloper;
using namespace sloper::pattern;
using namespace sloper::pattern::fit;

namespace {

constexpr double CERTAIN = 4.6, DOUBTFUL = -1; // log-odds, as of infer_seams()
constexpr std::size_t NEIGHBOURS = 60;         // of the truth, those that score most
constexpr int ROUNDS = 3;
constexpr double MARGIN = 0.5; // of the score, as in as_one_garment()
// Of ridges 30, 100, 300, weights 0.1, 0.02 and margins 0.5, 1.5 these make most of 100 kept
// designs wholly right, 50; the others 42 to 50, and 36 are without a climb.
constexpr double RIDGE = 100, NEIGHBOUR_WEIGHT = 0.1;

using Counts = Eigen::VectorXd;

struct Case {
  std::unique_ptr<Garment> garment;
  std::unique_ptr<std::vector<double>> base; ///< that the view looks at
  std::unique_ptr<GarmentView> view;
  Matching truth, found;
  std::vector<char> fixed, fixed_true; ///< in what is guessed; of these what is right
  /// Counts of the truth less those of others, and the weight of these.
  std::vector<std::pair<Counts, double>> worse;
};

Matching matching_of(std::size_t n, const std::set<SidePair>& pairs) {
  Matching out(n, -1);
  for (const auto& [i, j] : pairs) {
    out[i] = j;
    out[j] = i;
  }
  return out;
}

std::set<SidePair> pairs_of(const Matching& partner) {
  std::set<SidePair> out;
  for (int i = 0; i < std::ssize(partner); ++i)
    if (partner[i] > i)
      out.insert({i, partner[i]});
  return out;
}

std::size_t right(const Case& c, const Matching& partner) {
  return right_ones(c.garment->pattern, c.garment->sides, pairs_of(partner), c.garment->truth)
      .size();
}
bool is_truth(const Case& c, const Matching& partner) {
  const std::size_t n = pairs_of(partner).size();
  return n == c.garment->truth.size() && right(c, partner) == n;
}

Counts vector_of(const GarmentCounts& counts) {
  return Eigen::Map<const Counts>(counts.data(), GarmentClues::COUNT);
}

Case make_case(std::unique_ptr<Garment> garment) {
  Case c;
  c.garment = std::move(garment);
  Garment& g = *c.garment;
  const std::size_t n = g.sides.size();
  SeamAssembly::Result result =
      as_one_garment(g.pattern, g.sides, g.assembly->run(seam_model()), CERTAIN, DOUBTFUL, {});
  c.base = std::make_unique<std::vector<double>>(std::move(result.base));
  c.view = std::make_unique<GarmentView>(g.pattern, g.sides, *c.base);
  c.truth = matching_of(n, g.truth);
  std::set<SidePair> guess;
  c.fixed.assign(n, 0);
  c.fixed_true.assign(n, 0);
  for (const auto& [pair, odds] : result.pairs) {
    guess.insert(pair);
    if (odds >= CERTAIN)
      for (const int side : pair) {
        c.fixed[side] = 1;
        c.fixed_true[side] = g.truth.count(pair) > 0;
      }
  }
  c.found = matching_of(n, guess);
  return c;
}

std::vector<double> first_guess() {
  using G = GarmentClues;
  std::vector<double> w(G::COUNT, 0);
  const double odds[G::ODDS] = {-8, -6, -5, -4, -2.5, -1.5, -0.5, 0.5, 2, 3.5, 5, 8};
  for (std::size_t k = 0; k < G::ODDS; ++k)
    w[G::AT_ODDS + k] = odds[k];
  w[G::AT_TWINS] = w[G::AT_TWINS + 1] = -1;
  w[G::AT_TOPOLOGY] = -6;
  w[G::AT_TOPOLOGY + 1] = w[G::AT_TOPOLOGY + 2] = -4;
  return w;
}

/// What the truth has to be better than, with the weights of the round before.
void find_worse(Case& c, const std::vector<double>& weights) {
  const Counts truth = vector_of(c.view->counts(c.truth));
  const auto differs = [&](const Counts& other) { return (truth - other).norm() > 1e-9; };
  const GarmentSearch near(c.garment->pattern, c.garment->sides, *c.view, c.fixed_true);
  struct Near {
    double score;
    Counts counts;
    Matching partner;
  };
  std::vector<Near> all;
  for (const GarmentMove& move : near.moves(c.truth)) {
    Matching then = c.truth;
    GarmentSearch::apply(move, then);
    const GarmentCounts counts = c.view->counts(then);
    if (differs(vector_of(counts)))
      all.push_back({garment_score(counts, weights), vector_of(counts), std::move(then)});
  }
  std::sort(all.begin(), all.end(), [](const Near& a, const Near& b) { return a.score > b.score; });
  std::size_t taken = 0;
  for (const Near& n : all) {
    if (taken == NEIGHBOURS)
      break;
    if (is_truth(c, n.partner))
      continue;
    c.worse.push_back({truth - n.counts, NEIGHBOUR_WEIGHT});
    ++taken;
  }
  const GarmentSearch search(c.garment->pattern, c.garment->sides, *c.view, c.fixed);
  for (const Matching& end : {c.found, search.climb(c.found, weights, MARGIN)})
    if (!is_truth(c, end) && differs(vector_of(c.view->counts(end))))
      c.worse.push_back({truth - vector_of(c.view->counts(end)), 1}); // it is what is really met
}

/// Newton's method with a ridge about what was guessed first.
std::vector<double> weigh(const std::vector<Case>& cases, const std::vector<double>& prior) {
  constexpr int STEPS = 30;
  const Eigen::Index n = GarmentClues::COUNT;
  Counts w = Eigen::Map<const Counts>(prior.data(), n);
  const Counts w0 = w;
  const auto loss = [&](const Counts& at) {
    double sum = 0.5 * RIDGE * (at - w0).squaredNorm();
    for (const Case& c : cases)
      for (const auto& [x, weight] : c.worse) {
        const double z = at.dot(x);
        sum += weight * (z > 0 ? std::log1p(std::exp(-z)) : -z + std::log1p(std::exp(z)));
      }
    return sum;
  };
  double now = loss(w);
  for (int step = 0; step < STEPS; ++step) {
    Counts gradient = -RIDGE * (w - w0);
    Eigen::MatrixXd hessian = RIDGE * Eigen::MatrixXd::Identity(n, n);
    for (const Case& c : cases)
      for (const auto& [x, weight] : c.worse) {
        const double p = 1 / (1 + std::exp(-w.dot(x)));
        gradient += weight * (1 - p) * x;
        hessian.selfadjointView<Eigen::Lower>().rankUpdate(x, weight * p * (1 - p));
      }
    const Counts direction = hessian.selfadjointView<Eigen::Lower>().ldlt().solve(gradient);
    double share = 1;
    while (share > 1e-3 && loss(w + share * direction) > now)
      share /= 2;
    w += share * direction;
    const double then = loss(w);
    if (now - then < 1e-3)
      break;
    now = then;
  }
  std::vector<double> out;
  for (Eigen::Index k = 0; k < n; ++k)
    out.push_back(std::round(100 * w[k]) / 100);
  return out;
}

/// True seams whose sides are both free in a guess: the log-odds of each, and what the score gains
/// by it.
void print_open(const Case& c, const Matching& end, const std::vector<double>& weights) {
  const double now = garment_score(c.view->counts(end), weights);
  for (const auto& [i, j] : c.garment->truth) {
    if (end[i] >= 0 || end[j] >= 0)
      continue;
    Matching then = end;
    GarmentSearch::apply({{}, {{i, j}}}, then);
    const SeamSide &a = c.garment->sides[i], &b = c.garment->sides[j];
    std::printf("   open %d.%d (%.1f cm), %d.%d (%.1f cm): log-odds %.1f, gain %.1f\n", a.panel,
                a.first, 100 * a.length, b.panel, b.first, 100 * b.length, c.view->base(i, j),
                garment_score(c.view->counts(then), weights) - now);
  }
}

void report(const char* what, const std::vector<Case>& cases, const std::vector<double>& weights,
            bool verbose) {
  std::size_t whole[2] = {0, 0}, hits[2] = {0, 0}, guessed[2] = {0, 0}, sewn = 0;
  for (const Case& c : cases) {
    const GarmentSearch search(c.garment->pattern, c.garment->sides, *c.view, c.fixed);
    const Matching end[2] = {c.found, search.climb(c.found, weights, MARGIN)};
    sewn += c.garment->truth.size();
    std::size_t own[2] = {0, 0}, of[2] = {0, 0};
    for (std::size_t k = 0; k < 2; ++k) {
      own[k] = right(c, end[k]);
      of[k] = pairs_of(end[k]).size();
      hits[k] += own[k];
      guessed[k] += of[k];
      whole[k] += own[k] == of[k] && of[k] == c.garment->truth.size();
    }
    if (verbose && (own[1] != of[1] || own[1] != c.garment->truth.size()))
      std::printf("%s: %zu seams, %zu of %zu, then %zu of %zu; score %.1f, then %.1f, truth %.1f\n",
                  c.garment->path.c_str(), c.garment->truth.size(), own[0], of[0], own[1], of[1],
                  garment_score(c.view->counts(end[0]), weights),
                  garment_score(c.view->counts(end[1]), weights),
                  garment_score(c.view->counts(c.truth), weights));
    if (verbose)
      print_open(c, end[1], weights);
  }
  for (std::size_t k = 0; k < 2; ++k)
    std::printf("%s %s: F1 %.3f, wholly right %zu of %zu\n", what, k ? "then" : "pair by pair",
                2.0 * static_cast<double>(hits[k]) / static_cast<double>(guessed[k] + sewn),
                whole[k], cases.size());
  std::fflush(stdout);
}

} // namespace

int main(int argc, char** argv) {
  if (argc < 3) {
    std::cerr << "usage: fit_garment_model WEIGHTS.json [-v] SPECIFICATION...\n";
    return 2;
  }
  std::vector<Case> train, kept;
  bool verbose = false;
  std::vector<double> first = first_guess();
  for (int k = 2; k < argc; ++k) {
    if (std::string(argv[k]) == "-v") {
      verbose = true;
      continue;
    }
    if (std::string(argv[k]) == "-p") {
      first = seam_model().whole;
      first.resize(GarmentClues::COUNT, 0);
      continue;
    }
    Pattern pattern = read_pattern(argv[k], PatternChoice{});
    if (pattern.seams.empty())
      continue;
    Case c = make_case(prepare(argv[k], std::move(pattern)));
    (c.garment->kept ? kept : train).push_back(std::move(c));
  }
  std::printf("%zu to learn from, %zu kept\n", train.size(), kept.size());
  std::fflush(stdout);
  std::vector<double> weights = first;
  report("kept, as guessed first", kept, weights, verbose && train.empty());
  if (train.empty())
    return 0;
  for (int round = 0; round < ROUNDS; ++round) {
    std::size_t examples = 0;
    for (Case& c : train) {
      find_worse(c, weights);
      examples += c.worse.size();
    }
    weights = weigh(train, first);
    std::printf("round %d: %zu examples\n", round, examples);
    report("kept", kept, weights, verbose && round + 1 == ROUNDS);
  }
  std::ofstream out(argv[1]);
  out << "[";
  for (std::size_t k = 0; k < weights.size(); ++k)
    out << (k ? ", " : "") << weights[k];
  out << "]\n";
  return out ? 0 : 5;
}
