#pragma once
/// The seams between the front and the back piece of a sleeve.
/// Test: tests/pattern/seams/test_infer.cpp
#include <sloper/pattern/seams/seam_guess.hpp>

#include <vector>

namespace sloper::pattern {

/// The two seams between a piece that is called the front of a sleeve and one called its back.
struct SleeveHalves {
  Seam over, under; ///< the arm: the longer one and the other
  Run hem;          ///< an edge between them
};

/// Of each pair of such pieces. They have a hem each, and the sides beyond it are as long in both
/// pieces, in reverse order in the piece of the other arm. A back that reaches over the shoulder
/// goes straight on beyond the front, so a side of it is no side of the seam.
std::vector<SleeveHalves> sleeve_halves(const Pattern& pattern);

/// Offers these seams as the second answer wherever something else is guessed for one of their
/// edges and is not certain.
void offer_sleeve_halves(const Pattern& pattern, std::vector<SeamGuess>& guesses);

} // namespace sloper::pattern
