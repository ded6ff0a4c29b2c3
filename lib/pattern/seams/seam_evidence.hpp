#pragma once
/// What speaks for and against two sides being sewn together, as the classes of a scorecard.
#include <pattern/seams/seam_sides.hpp>

#include <array>
#include <cstdint>
#include <vector>

namespace sloper::pattern {

/// What is looked at. Of two sides, the order does not matter.
enum class Clue : std::uint8_t {
  LENGTHS,      ///< logarithm of their ratio
  WORSE_CORNER, ///< angles of cloth that meet at an end, against half a turn: the worse end
  BETTER_CORNER,
  LESS_CLOTH, ///< around an end: the one with less
  MORE_CLOTH,
  RISE,        ///< one goes up where the other goes down
  LEAN,        ///< and as far across
  ANSWER,      ///< curves that mirror each other
  FIT,         ///< curves that would lie flat beside each other
  BEND_LESS,   ///< hollow to round, of the one that is hollower
  BEND_MORE,   ///< and of the other
  KINSHIP,     ///< one panel, mirrored panels, others
  TIP,         ///< of neighbours: the corner between them
  SLOPE,       ///< upright, level, askew
  PLACES,      ///< top, middle, bottom of their panels, of level ones
  HEIGHTS,     ///< how far their places in their panels' heights differ
  SHARE,       ///< of their panels' outlines: the smaller
  SHARE_LARGE, ///< the larger
  PANEL_SIZES, ///< logarithm of the ratio of their panels' outlines
  SIZE,        ///< m
  RIVALS,      ///< other sides of that very length
  BEFORE,      ///< how alike the sides beyond one end are
  AFTER,       ///< and beyond the other
  SYMMETRY,    ///< how many of their panels are symmetric
  NOTCHES,
  // Of the second look, with the first one's odds.
  FIRST,     ///< log-odds of the first look
  RUNNER,    ///< how far ahead of the next best of the side with the better one
  SECOND,    ///< and of the other side
  TWIN,      ///< odds of the mirrored pair
  ONWARD,    ///< odds that the sides beyond an end are sewn
  ONWARD2,   ///< and beyond the other
  PANELS,    ///< how much else speaks for these panels being neighbours
  FREE,      ///< how surely the sides next to them are sewn at all
  MEETING,   ///< odds that three or four panels meet at an end, as seams that cross do
  MEETING2,  ///< and at the other end
  GATHERING, ///< how alike the seam and the one that goes on beyond such an end are gathered
  SEWN,      ///< expected number of seams of the side that has fewer
  SETTLED,   ///< log-odds with which the pair was settled on; only for the last judgement
  COUNT
};
inline constexpr std::size_t CLUES = static_cast<std::size_t>(Clue::COUNT),
                             FIRST_LOOK = static_cast<std::size_t>(Clue::FIRST), CLASSES = 32;

/// Class of each clue.
using Evidence = std::array<std::uint8_t, CLUES>;

using SidePair = std::array<int, 2>; ///< indices of two sides, ascending

/// The evidence on every pair of sides of one pattern.
class SeamWitness {
public:
  static constexpr double IMPOSSIBLE = -30; ///< log-odds

  SeamWitness(const Pattern& pattern, const std::vector<SeamSide>& sides);

  /// The first look: everything but what needs the other pairs. False where nothing could make them
  /// a seam.
  bool look(std::size_t i, std::size_t j, Evidence& evidence) const;

  /// Log-odds of all pairs, symmetric, n by n and very low where impossible, with sums over them.
  struct Odds {
    std::vector<double> of_pair;
    std::vector<double> to_panel, between_panels; ///< expected numbers of seams: n by panels,
                                                  ///< panels by panels
    std::vector<std::array<double, 3>> best;      ///< of each side, descending
    std::vector<double> mass;                     ///< expected number of seams of each side
    std::vector<std::vector<int>> partners;       ///< those that are worth a look
  };
  Odds sum_up(std::vector<double> of_pair) const;

  /// The second look.
  void second_look(std::size_t i, std::size_t j, const Odds& odds, Evidence& evidence) const;

  /// The pairs that are mirror images of a pair, each once and without itself.
  std::vector<std::array<int, 2>> twins(std::size_t i, std::size_t j) const;

  const std::vector<SeamSide>& sides() const { return m_sides; }

private:
  const SeamSide& side(std::size_t k) const { return m_sides[k]; }
  int image(std::size_t k, const PanelMirror& mirror) const;
  struct Meeting {
    double odds = IMPOSSIBLE, ratio = 0; ///< of the seam that goes on: logarithm of its lengths
  };
  Meeting meeting(const Odds& odds, int onward, int back) const;
  double signed_ratio(int i, int j) const;
  double odds_of_neighbours(const Odds& odds, int i, int j) const;

  const Pattern& m_pattern;
  const std::vector<SeamSide>& m_sides;
  std::vector<std::vector<PanelMirror>> m_mirrors;
  std::vector<std::vector<int>> m_side_of; ///< by panel and edge, -1 where too short
  std::vector<int> m_rivals;
};

} // namespace sloper::pattern
