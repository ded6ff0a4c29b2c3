#pragma once
/// Seams between pieces that are finished before they are joined: sleeves in one piece set into
/// armholes, ribs and collars on necks. Edge by edge they are not to be found, since an armhole is
/// one edge of the front and one of the back or more, and a cap one edge.
#include <sloper/pattern/seams/seam_guess.hpp>

namespace sloper::pattern {

/// Adds what rims say to the guesses of infer_seams(), and takes out those that contradict it and
/// are not certain.
///
/// A sleeve is a piece that closes on itself, or could (two equally long sides on both sides of a
/// third) and has a mirror image; it goes into two rims of the rest that are mirror images of each
/// other, where its cap is as long as these or has some ease. The longer half of the cap goes with
/// the longer of front and back; where they are alike, the flatter with the back. A strip that is
/// called a collar, or a rib, goes on the shortest rim around the neck, from the middle of the
/// back; it may be shorter, as ribs are.
std::vector<SeamGuess> with_rim_seams(const Pattern& pattern, std::vector<SeamGuess> guesses);

} // namespace sloper::pattern
