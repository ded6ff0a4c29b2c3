#pragma once
/// Gores: pieces of a skirt that are alike and are sewn side by side around the body.
#include <sloper/pattern/seams/seam_guess.hpp>

namespace sloper::pattern {

/// Sews pieces whose two upright sides are all alike into a ring, in place of guesses between such
/// sides that are not certain: no pair says which two of ten gores are neighbours. They stand
/// in the order in which their tops were guessed to the rim above; where one is not guessed, a gore
/// that is left and fits goes there; without a rim above, in the order of the file. Nothing is done
/// where a certain seam, or a likely one to another piece, takes such a side, and where the pieces
/// are little of the garment, as cuffs are. The ring is asked as one question.
std::vector<SeamGuess> with_gore_rows(const Pattern& pattern, std::vector<SeamGuess> given);

} // namespace sloper::pattern
