#pragma once
/// The seams between the front and the back piece of a sleeve.
/// Test: tests/pattern/seams/test_infer.cpp
#include <sloper/pattern/seams/seam_guess.hpp>

#include <vector>

namespace sloper::pattern {

/// Offers the seam over or under the arm as the second answer wherever something else is guessed
/// for one of its edges and is not certain. Pieces that are called front and back of a sleeve have
/// a hem each, and the sides beyond it are as long in both pieces, in reverse order in the piece of
/// the other arm. A back that reaches over the shoulder goes straight on beyond the
/// front, so a side of it is no side of the seam. First answers stay as they are: with these seams
/// taken beforehand the rest of the one real sleeve of two pieces that was looked at came out
/// worse.
void offer_sleeve_halves(const Pattern& pattern, std::vector<SeamGuess>& guesses);

} // namespace sloper::pattern
