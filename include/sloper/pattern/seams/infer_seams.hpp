#pragma once
/// Seams inferred for a pattern that states none (plain AAMA / ASTM files do not), as an
/// assembly of all its panels.
/// Test: tests/pattern/seams/test_infer.cpp
#include <sloper/io/json_fwd.hpp>
#include <sloper/pattern/seams/seam_guess.hpp>

#include <string>
#include <vector>

namespace sloper::pattern {

/// The seams that sew the pattern together best, certain ones first, no edge twice; then
/// plausible seams that the best assembly does without. 0.1 s for 100 edges, 3 s for 500.
std::vector<SeamGuess> infer_seams(const Pattern& pattern);

/// The first answer to every question: all guesses, the surest first, but those that would sew
/// cloth that is sewn already. What was not certain has `certain` false still.
std::vector<SeamGuess> first_answers(const std::vector<SeamGuess>& guesses);

/// How much cloth guesses sew and how surely: the sum of 2 p - 1 times the lengths of both sides,
/// m, over those of a probability p above 0.5.
double sewn_surely(const Pattern& pattern, const std::vector<SeamGuess>& guesses);

/// Names of panels that are not connected by seams to the largest connected group: a seam
/// is missing there.
std::vector<std::string> panels_apart(const Pattern& pattern);

/// Takes pieces that nothing is sewn to out of a sewn pattern, as bindings and plackets of a style
/// are of which no edge fits any other. None is taken where two such pieces are sewn to each other,
/// or where they are more than a tenth of the cloth.
/// @returns their names
std::vector<std::string> leave_out_unsewn(Pattern& pattern);

/// A "sewing-seams" sidecar with the certain seams, and "questions" for the others: each
/// has an edge and up to two candidates, the better one first, in the sidecar's format;
/// where a candidate's mirror image, or another guess that the same answer decides, is open
/// too it is its "and". Moving the right one into "seams" answers a question, deleting the
/// question states that the edge is free.
/// Which version of a part is made is a question of its own, without an edge: "versions" has the
/// names of the pieces of each, and a candidate those that it takes and leaves out. "without" of
/// the document leaves out what the first candidates do; for another one the file is read again
/// without what that one leaves out.
/// @param guesses   of infer_seams()
/// @param versions  of take_versions(), which has taken all but the first out of the pattern
io::Json sewing_questions(const Pattern& pattern, const std::vector<SeamGuess>& guesses,
                          const std::string& tool, const std::vector<PieceVersions>& versions = {});

} // namespace sloper::pattern
