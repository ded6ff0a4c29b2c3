#pragma once
/// Which sides are sewn together, found for all panels at once: several looks at each pair, each
/// with the odds of the one before; then pairs are settled on, the surest first, and every one that
/// is settled changes the odds of the rest; then each is judged among all others, and what does not
/// stand is taken back.
#include <pattern/seams/seam_model.hpp>

#include <map>
#include <set>

namespace sloper::pattern {

/// Pairs with log-odds.
using PairOdds = std::map<SidePair, double>;

/// Settles the seams of one pattern.
class SeamAssembly {
public:
  /// @param prior  log-odds that names add to each pair, n by n, symmetric; SeamWitness::IMPOSSIBLE
  ///               forbids; empty for none
  SeamAssembly(const SeamWitness& witness, std::vector<double> prior);

  struct Pair {
    int i, j;
    Evidence evidence;
  };
  /// Those that could be seams, with what the first look sees.
  const std::vector<Pair>& pairs() const { return m_pairs; }

  /// Log-odds of all pairs by one more look; `before` is null for the first.
  SeamWitness::Odds look(const SeamTrees& trees, const SeamWitness::Odds* before) const;

  struct Settled {
    PairOdds at;              ///< what was settled on, with the odds at that time
    std::vector<double> odds; ///< of all pairs at the end
  };
  /// @param base  odds of the last look
  /// @param keep  pairs to begin with
  /// @param ban   pairs to leave out
  Settled settle(const SeamTrees& trees, const SeamWitness::Odds& base, const PairOdds& keep,
                 const std::set<SidePair>& ban) const;

  /// What speaks for a settled pair, all others being given.
  Evidence judged(const SeamWitness::Odds& base, const Settled& settled,
                  const SidePair& pair) const;

  struct Result {
    PairOdds pairs;           ///< that were settled on, with the judge's log-odds; no side twice
    std::vector<double> base; ///< log-odds of all pairs at the last look, n by n
  };
  /// All together.
  Result run(const SeamModel& model) const;

  /// Sets the odds of a pair that is settled, and of all that it excludes.
  void commit(std::vector<double>& odds, const SidePair& pair) const;

private:
  std::size_t at(int i, int j) const {
    return static_cast<std::size_t>(i) * m_n + static_cast<std::size_t>(j);
  }
  double prior(int i, int j) const { return m_prior.empty() ? 0 : m_prior[at(i, j)]; }

  const SeamWitness& m_witness;
  std::size_t m_n;
  std::vector<double> m_prior;
  std::vector<Pair> m_pairs;
};

} // namespace sloper::pattern
