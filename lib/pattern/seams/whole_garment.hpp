#pragma once
/// What the settled seams make as a whole. A garment is one piece of cloth in the end: one part, a
/// surface without handles, with a few rims. Of 202 GarmentCode designs that were drawn at random
/// all are one part, 195 have no handle, all have 2 to 7 rims.
/// Test: tests/pattern/seams/test_whole_garment.cpp
#include <pattern/seams/open_rims.hpp>
#include <pattern/seams/seam_assembly.hpp>
#include <sloper/pattern/seams/seam_guess.hpp>

namespace sloper::pattern {

/// Takes back what would make a handle, exchanges sides where the others then make none, and sews
/// rims of parts that nothing joins.
/// @param sure  log-odds from which a pair stays whatever the others are
/// @param doubtful  log-odds below which a pair is no answer: it stays only among what is known of
///        each pair
/// @param weights  of garment_score(), by which the whole is improved in the end; none: it is not
/// @returns the pairs, no side twice; what was sewn here has the log-odds of a question
SeamAssembly::Result as_one_garment(const Pattern& pattern, const std::vector<SeamSide>& sides,
                                    SeamAssembly::Result found, double sure, double doubtful,
                                    const std::vector<double>& weights);

/// Sews what is left open between two edges that are too short for sides, as chamfers are. No body
/// goes through a hole of a centimetre. As sure as the seams that leave it.
void close_slivers(const Pattern& pattern, std::vector<SeamGuess>& guesses);

} // namespace sloper::pattern
