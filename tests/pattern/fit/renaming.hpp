#pragma once
/// Assemblies compared up to panels that are alike: once names are gone, two cuffs of one shape are
/// one another's.
#include <pattern/seams/seam_assembly.hpp>

namespace sloper::pattern::fit {

/// Those of `guess` that are seams of `truth` once panels that are congruent, and the edges of
/// panels that are congruent with themselves, are exchanged as suits the guess best.
std::set<SidePair> right_ones(const Pattern& pattern, const std::vector<SeamSide>& sides,
                              const std::set<SidePair>& guess, const std::set<SidePair>& truth);

} // namespace sloper::pattern::fit
