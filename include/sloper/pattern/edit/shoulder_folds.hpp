#pragma once
/// Front and back in one piece, folded over the shoulders: a poncho, a tunic, a kimono, a vest
/// without shoulder seams. Around a body the two halves are placed as a front and a back are, and
/// joined along the fold as along a seam, which leaves cloth as it was.
/// Test: tests/pattern/edit/test_shoulder_folds.cpp
#include <sloper/pattern/pattern.hpp>

namespace sloper::pattern {

/// Cuts each panel that is folded over the shoulders along its fold, and sews the halves together
/// there. They are named front_NAME and back_NAME, stand upright, and have hints for the trunk; the
/// one with the deeper neck is the front, or the one drawn below. Holes and seams that the fold
/// crosses are cut with them. A fold is known by
/// - an inner line of kind "fold" whose name begins with "shoulder", straight through the panel, or
/// - two seams, at both ends of the fold, that each sew a side of the panel to its mirror image
///   beyond the fold, or one and a second panel that is sewn to it on both sides of the fold.
/// Each cut is reported in Pattern::findings. Cost: seams times their samples.
/// @return how many panels were cut
int cut_shoulder_folds(Pattern& pattern);

} // namespace sloper::pattern
