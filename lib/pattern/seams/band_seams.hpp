#pragma once
/// Seams of strips and of legs in one piece: ribs, collars, waistbands, cuffs on the rims of what
/// is sewn, and the two halves of leggings.
#include <sloper/pattern/seams/seam_guess.hpp>

namespace sloper::pattern {

/// Adds them to guesses, and takes out those that contradict it and are not certain.
///
/// Two pieces that are called legs, or nothing, and are mirror images, each with two equally long
/// sides around a hem, close on themselves and are joined at both crotch curves. One strip that is
/// called collar, neck or rib goes on the shortest rim around the neck, from the middle of the
/// back; it may be shorter, as ribs are. One that is called a waistband goes on the longest rim
/// that is as long.
std::vector<SeamGuess> with_bands(const Pattern& pattern, std::vector<SeamGuess> guesses);
/// The first part of it, before sleeves.
std::vector<SeamGuess> with_legs(const Pattern& pattern, std::vector<SeamGuess> guesses);

} // namespace sloper::pattern
