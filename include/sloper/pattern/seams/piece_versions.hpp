#pragma once
/// Pieces of a style file that are made in place of each other: legs of two lengths, a ribbed
/// collar or one of shell fabric.
/// Test: tests/pattern/seams/test_infer.cpp
#include <sloper/pattern/seams/seam_guess.hpp>

#include <optional>

namespace sloper::pattern {

/// Finds versions in a pattern without seams, takes all but the first of each part out of it, and
/// returns them.
///
/// Legs: two pairs or more that each close on themselves and at both crotch curves, and that hardly
/// sew more cloth together than each by itself. Pieces that are
/// called collars, or sleeves: where more cloth is sewn more surely (infer_seams()) with one of
/// them alone than with all; that one is proposed which is sewn best. Costs an inference for each
/// version and one for all together.
/// @param inferred  what infer_seams() gives for the pattern that is left, where it was inferred on
///                  the way; none where there was no choice
std::vector<PieceVersions> take_versions(Pattern& pattern,
                                         std::optional<std::vector<SeamGuess>>& inferred);

} // namespace sloper::pattern
