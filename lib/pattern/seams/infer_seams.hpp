#pragma once
/// Seams guessed for a pattern that states none (plain AAMA / ASTM files do not): from edge names,
/// lengths, notches and piece names.
#include <io/json_fwd.hpp>
#include <pattern/pattern.hpp>

namespace sloper::pattern {

struct SeamGuess {
  Seam seam;
  double score = 0;     ///< 0..1
  bool certain = false; ///< good, mutual, and clear of the next best by a margin
};

/// One guess per edge that has a plausible partner, best first. Certain guesses use no edge twice.
std::vector<SeamGuess> infer_seams(const Pattern& pattern);

/// A "sewing-seams" sidecar with the certain seams, and under "questions" for every other edge that
/// may be sewn its candidates in the sidecar's own words: moving the right one into "seams" answers
/// it, deleting the question says that the edge is free.
io::Json sewing_questions(const Pattern& pattern, const std::vector<SeamGuess>& guesses,
                          const std::string& tool);

} // namespace sloper::pattern
