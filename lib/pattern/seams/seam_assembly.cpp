#include <pattern/seams/seam_assembly.hpp>
#include <sloper/base/parallel.hpp>

#include <algorithm>
#include <cmath>

namespace sloper::pattern {
namespace {

constexpr double NEVER = SeamWitness::IMPOSSIBLE;
constexpr double SETTLED = 12;      // log-odds of what is settled
constexpr double WORTH_A_LOOK = -2; // log-odds below which no pair is settled
constexpr double BAND = 2;          // of log-odds: pairs that are settled in one go
constexpr double CLEAR = 1;         // ahead of the next best of either side
constexpr double SEWN_AT_ALL = 0.5; // expected seams of a side whose partners are alike
// Of the judge's log-odds: below the first a pair is taken back, above the second it stays while
// the others are settled again.
constexpr double REFUSED = -0.5, KEPT = 1;
constexpr int ROUNDS = 3;
constexpr std::size_t PAIRS_AT_A_TIME = 256; // of one thread

} // namespace

SeamAssembly::SeamAssembly(const SeamWitness& witness, std::vector<double> prior)
    : m_witness(witness), m_n(witness.sides().size()), m_prior(std::move(prior)) {
  for (int i = 0; i < static_cast<int>(m_n); ++i)
    for (int j = i + 1; j < static_cast<int>(m_n); ++j) {
      Pair pair{i, j, {}};
      if (this->prior(i, j) > NEVER &&
          witness.look(static_cast<std::size_t>(i), static_cast<std::size_t>(j), pair.evidence))
        m_pairs.push_back(pair);
    }
}

SeamWitness::Odds SeamAssembly::look(const SeamTrees& trees,
                                     const SeamWitness::Odds* before) const {
  std::vector<double> odds(m_n * m_n, NEVER);
  for (const Pair& pair : m_pairs) {
    Evidence evidence = pair.evidence;
    if (before)
      m_witness.second_look(static_cast<std::size_t>(pair.i), static_cast<std::size_t>(pair.j),
                            *before, evidence);
    odds[at(pair.i, pair.j)] = odds[at(pair.j, pair.i)] = trees(evidence) + prior(pair.i, pair.j);
  }
  return m_witness.sum_up(std::move(odds));
}

void SeamAssembly::commit(std::vector<double>& odds, const SidePair& pair) const {
  for (int k = 0; k < static_cast<int>(m_n); ++k)
    for (int side : pair)
      odds[at(side, k)] = odds[at(k, side)] = NEVER;
  odds[at(pair[0], pair[1])] = odds[at(pair[1], pair[0])] = SETTLED;
}

SeamAssembly::Settled SeamAssembly::settle(const SeamTrees& trees, const SeamWitness::Odds& base,
                                           const PairOdds& keep,
                                           const std::set<SidePair>& ban) const {
  Settled out{keep, base.of_pair};
  for (const SidePair& pair : ban)
    out.odds[at(pair[0], pair[1])] = out.odds[at(pair[1], pair[0])] = NEVER;
  for (const auto& [pair, odds] : keep)
    commit(out.odds, pair);
  SeamWitness::Odds odds = m_witness.sum_up(out.odds);
  for (std::size_t pass = 0; pass < m_n; ++pass) {
    std::vector<double> now = out.odds;
    std::vector<std::pair<double, SidePair>> open;
    std::vector<double> looked(m_pairs.size(), NEVER);
    const auto is_open = [&](const Pair& pair) {
      return out.odds[at(pair.i, pair.j)] > NEVER && !out.at.count({pair.i, pair.j});
    };
    parallel_for(m_pairs.size(), PAIRS_AT_A_TIME, [&](std::size_t begin, std::size_t end) {
      for (std::size_t p = begin; p < end; ++p) {
        const Pair& pair = m_pairs[p];
        if (!is_open(pair))
          continue;
        Evidence evidence = pair.evidence;
        m_witness.second_look(static_cast<std::size_t>(pair.i), static_cast<std::size_t>(pair.j),
                              odds, evidence);
        looked[p] = trees(evidence) + prior(pair.i, pair.j);
      }
    });
    for (std::size_t p = 0; p < m_pairs.size(); ++p) {
      const Pair& pair = m_pairs[p];
      const double own = looked[p];
      if (!is_open(pair))
        continue;
      now[at(pair.i, pair.j)] = now[at(pair.j, pair.i)] = own;
      if (own > WORTH_A_LOOK)
        open.push_back({-own, {pair.i, pair.j}});
    }
    if (open.empty())
      break;
    std::sort(open.begin(), open.end());
    odds = m_witness.sum_up(now);
    bool any = false;
    const auto best = [&](int k) -> const std::array<double, 3>& { return odds.best[k]; };
    for (const auto& [cost, pair] : open) {
      if (cost > open[0].first + BAND || cost > 0)
        break;
      if (best(pair[0])[0] != -cost || best(pair[1])[0] != -cost ||
          !(-cost - std::max(best(pair[0])[1], best(pair[1])[1]) > CLEAR))
        continue;
      commit(now, pair);
      out.at[pair] = -cost;
      any = true;
    }
    if (!any) { // partners that are alike: one of them has to be the first
      const auto tie = std::find_if(open.begin(), open.end(), [&](const auto& item) {
        return std::min(odds.mass[item.second[0]], odds.mass[item.second[1]]) > SEWN_AT_ALL;
      });
      if (tie == open.end()) {
        out.odds = std::move(now);
        break;
      }
      commit(now, tie->second);
      out.at[tie->second] = -tie->first;
    }
    out.odds = std::move(now);
    odds = m_witness.sum_up(out.odds);
  }
  return out;
}

Evidence SeamAssembly::judged(const SeamWitness::Odds& base, const Settled& settled,
                              const SidePair& pair) const {
  std::vector<char> taken(m_n, 0);
  for (const auto& [other, odds] : settled.at)
    if (other != pair)
      taken[other[0]] = taken[other[1]] = 1;
  std::vector<double> odds = settled.odds;
  for (int k = 0; k < static_cast<int>(m_n); ++k)
    for (int side : pair)
      odds[at(side, k)] = odds[at(k, side)] = taken[k] ? NEVER : base.of_pair[at(side, k)];
  Evidence evidence{};
  const std::size_t i = static_cast<std::size_t>(pair[0]), j = static_cast<std::size_t>(pair[1]);
  m_witness.look(i, j, evidence);
  m_witness.second_look(i, j, m_witness.sum_up(std::move(odds)), evidence);
  int grade = 0;
  for (double bound : {-2.0, -1.0, -0.5, 0.0, 0.5, 1.0, 1.5, 2.0, 2.5, 3.0, 3.5, 4.0, 4.5, 5.0, 5.5,
                       6.0, 7.0, 8.0})
    grade += settled.at.at(pair) > bound;
  evidence[static_cast<std::size_t>(Clue::SETTLED)] = static_cast<std::uint8_t>(grade);
  return evidence;
}

SeamAssembly::Result SeamAssembly::run(const SeamModel& model) const {
  SeamWitness::Odds base = look(model.looks[0], nullptr);
  for (std::size_t k = 1; k < model.looks.size(); ++k)
    base = look(model.looks[k], &base);
  PairOdds keep, verdicts;
  std::set<SidePair> ban;
  for (int round = 0;; ++round) {
    const Settled settled = settle(model.settle, base, keep, ban);
    keep.clear();
    verdicts.clear();
    const std::size_t banned = ban.size();
    for (const auto& [pair, odds] : settled.at) {
      const double verdict = model.judge(judged(base, settled, pair)) + prior(pair[0], pair[1]);
      verdicts[pair] = verdict;
      if (verdict < REFUSED)
        ban.insert(pair);
      else if (verdict > KEPT)
        keep[pair] = odds;
    }
    if (ban.size() == banned || round == ROUNDS)
      break;
  }
  return {std::move(verdicts), std::move(base.of_pair)};
}

} // namespace sloper::pattern
