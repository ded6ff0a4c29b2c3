#pragma once
/// Assemblies near one another: what a whole garment may change at once. Single seams, pairs that
/// exchange partners, a ring of seams that is cut and turned, each together with its mirror image.
/// Test: tests/pattern/seams/test_garment_energy.cpp
#include <pattern/seams/garment_energy.hpp>

namespace sloper::pattern {

/// What is taken out of an assembly, and what is put in.
struct GarmentMove {
  std::vector<SidePair> out, in;
};

class GarmentSearch {
public:
  /// @param fixed  sides whose seams stay
  GarmentSearch(const Pattern& pattern, const std::vector<SeamSide>& sides, const GarmentView& view,
                std::vector<char> fixed);

  /// All moves from an assembly, each once.
  std::vector<GarmentMove> moves(const Matching& partner) const;

  /// Climbs by the best move until none is better by more than `margin`, or by any gain where it
  /// only closes darts of which the garment has two alike.
  Matching climb(Matching partner, const std::vector<double>& weights, double margin) const;

  static void apply(const GarmentMove& move, Matching& partner);

private:
  using Moves = std::vector<GarmentMove>;
  std::vector<SidePair> loose(const Matching& partner) const;
  bool possible(int i, int j) const;
  bool begins_dart(int side) const;
  bool is_one_of_two_darts(const SidePair& pair) const;
  void single_moves(const Matching& partner, Moves& out) const;
  void exchanges(const Matching& partner, Moves& out) const;
  void turns(const Matching& partner, Moves& out) const;
  void joins(const Matching& partner, const std::vector<SidePair>& cut, Moves& out) const;
  std::vector<SidePair> cut_through(const Matching& partner, const SidePair& pair) const;
  bool with_mirror(const Matching& partner, GarmentMove& move) const;

  const Pattern& m_pattern;
  const std::vector<SeamSide>& m_sides;
  const GarmentView& m_view;
  std::vector<char> m_fixed;
};

} // namespace sloper::pattern
