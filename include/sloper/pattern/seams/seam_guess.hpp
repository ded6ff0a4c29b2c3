#pragma once
/// A guessed seam, with its probability and its rivals.
/// Test: tests/pattern/seams/test_infer.cpp
#include <sloper/pattern/pattern.hpp>

#include <string>
#include <vector>

namespace sloper::pattern {

/// A seam that was guessed.
struct SeamGuess {
  Seam seam;        ///< in the pattern's indices
  double score = 0; ///< probability, 0..1
  /// Of the seams called certain 99 % are right.
  bool certain = false;
  /// For an uncertain seam: the next best seam of either side, if it is plausible.
  std::vector<SeamGuess> instead;
  int twin = -1; ///< index of its mirror image among the guesses; one answer decides both
  /// Indices of other guesses that the same answer decides: with a sleeve's seam its cap.
  std::vector<int> with;
};

/// Versions of one part of the garment, each the names of its pieces; the first is proposed.
using PieceVersions = std::vector<std::vector<std::string>>;

} // namespace sloper::pattern
