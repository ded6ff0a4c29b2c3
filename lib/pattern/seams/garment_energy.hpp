#pragma once
/// How much a whole assembly looks like a garment: the surface that it makes, its corners, rims and
/// symmetry, together with what speaks for each pair of sides. Pairs that look alike by themselves,
/// as the four turns of a skirt on a waist, differ here.
/// Test: tests/pattern/seams/test_garment_energy.cpp
#include <pattern/seams/seam_evidence.hpp>

#include <algorithm>
#include <map>

namespace sloper::pattern {

/// The other side of each side's seam, -1 where it is free.
using Matching = std::vector<int>;

inline SidePair ordered_sides(int i, int j) {
  return {std::min(i, j), std::max(i, j)};
}

/// What is counted of an assembly; each block is a histogram.
struct GarmentClues {
  // Number of classes of each block.
  static constexpr std::size_t ODDS = 12, RATIOS = 9, CLOSED = 4 * 8, OPEN = 4 * 9, SLITS = 2,
                               EVENNESS = 2 * 6, TWINS = 2, MIDDLES = 7, TOPOLOGY = 3, RIMS = 9,
                               RIM_SIZES = 5;
  // Where each begins.
  static constexpr std::size_t AT_ODDS = 0, AT_RATIOS = AT_ODDS + ODDS,
                               AT_CLOSED = AT_RATIOS + RATIOS, AT_OPEN = AT_CLOSED + CLOSED,
                               AT_SLITS = AT_OPEN + OPEN, AT_EVENNESS = AT_SLITS + SLITS,
                               AT_TWINS = AT_EVENNESS + EVENNESS, AT_MIDDLES = AT_TWINS + TWINS,
                               AT_TOPOLOGY = AT_MIDDLES + MIDDLES, AT_RIMS = AT_TOPOLOGY + TOPOLOGY,
                               AT_RIM_SIZES = AT_RIMS + RIMS, COUNT = AT_RIM_SIZES + RIM_SIZES;
};
using GarmentCounts = std::array<double, GarmentClues::COUNT>;

/// Counts the clues of assemblies of one pattern.
class GarmentView {
public:
  /// @param sides  of the pattern; no two of them share an edge
  /// @param base   log-odds of all pairs, n by n
  GarmentView(const Pattern& pattern, const std::vector<SeamSide>& sides,
              const std::vector<double>& base);

  /// @param partner  symmetric. Cost: linear in the number of edges
  GarmentCounts counts(const Matching& partner) const;

  std::size_t size() const { return m_n; }
  int panel_of(int side) const { return m_panel[side]; }
  double base(int i, int j) const {
    return m_base[static_cast<std::size_t>(i) * m_n + static_cast<std::size_t>(j)];
  }

  /// Mirror images of a pair, and whether it is its own.
  struct Images {
    std::vector<SidePair> any;   ///< by all mirror images of both panels
    std::vector<SidePair> first; ///< where panels that are symmetric stay where they are
    bool own_any = false, own_first = false;
  };
  const Images& images(int i, int j) const;

private:
  void count_vertex(const std::vector<int>& corners, bool closed, const Matching& partner,
                    GarmentCounts& out) const;
  void count_closed(const std::vector<int>& corners, const Matching& partner,
                    GarmentCounts& out) const;
  void count_pairs(const Matching& partner, GarmentCounts& out) const;
  bool is_middle(int i, int j) const; ///< of two halves that are mirror images

  std::size_t m_n; ///< of sides; nodes beyond are edges that are no sides
  const std::vector<SeamSide>& m_sides;
  const std::vector<double>& m_base;
  std::vector<std::vector<PanelMirror>> m_mirrors;
  std::vector<int> m_next, m_last; ///< node after and before each, around its outline
  std::vector<int> m_panel;
  std::vector<double> m_length, m_angle; ///< m; rad of cloth where each begins
  std::vector<char> m_axis;              ///< whether it begins on its panel's axis of symmetry
  std::size_t m_panels = 0, m_loops = 0;
  mutable std::map<SidePair, Images> m_images;
};

/// The weighted sum: greater is better. Weights are seam_model.json's "whole", fitted by
/// tests/pattern/fit/fit_garment_model.cpp.
double garment_score(const GarmentCounts& counts, const std::vector<double>& weights);

} // namespace sloper::pattern
