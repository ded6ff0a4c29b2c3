#pragma once
/// Seams guessed for a pattern that states none (plain AAMA / ASTM files do not), as an assembly of
/// all its panels: see seam_assembly.hpp.
#include <sloper/io/json_fwd.hpp>
#include <sloper/pattern/pattern.hpp>

#include <string>
#include <vector>

namespace sloper::pattern {

struct SeamGuess {
  Seam seam;
  double score = 0;     ///< probability, 0..1
  bool certain = false; ///< of those called certain 99 % are right
  /// Of one that is not certain: the next best seam of either side, if any is worth a word.
  std::vector<SeamGuess> instead;
  int twin = -1; ///< index of its mirror image among the guesses; one answer tells both
};

/// The seams that sew the pattern together best, certain ones first, no edge twice; and those that
/// may be meant though the best assembly does without them.
/// Cost: 0.1 s for 100 edges, 3 s for 500.
std::vector<SeamGuess> infer_seams(const Pattern& pattern);

/// Names of panels that no seam, nor seams by way of others, joins to the panels that most are
/// joined to: something is missing there.
std::vector<std::string> panels_apart(const Pattern& pattern);

/// A "sewing-seams" sidecar with the certain seams, and under "questions" what is open: for each an
/// edge and up to two candidates, the better one first, in the sidecar's own words; where a
/// candidate's mirror image is open too it is its "and". Moving the right one into "seams" answers
/// a question, deleting the question says that the edge is free.
io::Json sewing_questions(const Pattern& pattern, const std::vector<SeamGuess>& guesses,
                          const std::string& tool);

} // namespace sloper::pattern
