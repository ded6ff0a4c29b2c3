#pragma once
/// Where cloth ends while panels are sewn together side by side: rims of free sides. Panels are
/// seen from outside, so a side is sewn to one that runs against it, and what comes of it is a
/// surface with two faces: parts, each with rims and with handles. Test:
/// tests/pattern/seams/test_whole_garment.cpp
#include <pattern/seams/seam_evidence.hpp>
#include <sloper/geometry/disjoint_sets.hpp>

namespace sloper::pattern {

/// The rims of a pattern, which sewing joins and splits.
class OpenRims {
public:
  /// Nothing is sewn yet: each loop of each panel is a rim, each panel a part.
  /// @param sides  of that pattern; no two of them share an edge
  OpenRims(const Pattern& pattern, const std::vector<SeamSide>& sides);

  bool same_rim(int i, int j) const;
  bool same_part(int i, int j) const { return part(i) == part(j); }
  /// Whether a seam would join two rims of one part, as those of both wrists: a handle, which no
  /// garment has.
  bool makes_handle(int i, int j) const { return same_part(i, j) && !same_rim(i, j); }
  /// Both sides are free before.
  void sew(int i, int j);

  /// The free sides of each rim, in the order of the outlines; edges that are no sides are left
  /// out.
  std::vector<std::vector<int>> rims() const;
  /// A number that all sides of one part share.
  int part(int side) const { return m_parts.find(m_panel[side]); }

private:
  std::size_t m_n;                 ///< of sides; nodes beyond are edges that are no sides
  std::vector<int> m_next, m_last; ///< node after and before each, around its rim
  std::vector<char> m_sewn;
  std::vector<int> m_panel; ///< of each side
  DisjointSets m_parts;
};

} // namespace sloper::pattern
