#pragma once
/// Bands of several pieces, sewn end to end to a ring, on a rim of the rest: a collar stand of a
/// middle and two ends, a waistband of front and back.
#include <sloper/pattern/seams/seam_guess.hpp>

namespace sloper::pattern {

/// Adds them to guesses. Pieces are slim. Where a band is found, gathers between long sides of such
/// pieces, which would fold it, are taken out unless they are certain. The longer rim of the ring
/// goes on the only rim of the rest that is about as long, from a place where both are mirror
/// images of themselves: of a neck the middle of the back, which is its shorter part; of the ring
/// the middle of a piece where there is one. The guess is asked.
std::vector<SeamGuess> with_ring_bands(const Pattern& pattern, std::vector<SeamGuess> given);

} // namespace sloper::pattern
