#pragma once
/// Whether a drape turned collars and lapels over as their pattern says.
/// Test: tests/cli/tools/drape.sh
#include <sloper/garment/drape/drape_job.hpp>

#include <string>
#include <vector>

namespace sloper::garment {

/// Judges a drape that has ended by its roll lines (roll_line_states.hpp): the document gets their
/// states as `roll_lines`. One that is not turned over is a finding. Where one stands, the drape
/// counts as failed (converged is false in garment, report and document, with the reason).
/// @param file  of the garment, to name it   @param outcome  of do_drape(), in and out
/// @param findings  receives the findings, each of which is a warning too
void judge_roll_lines(Garment& garment, DrapeOutcome& outcome, const std::string& file,
                      std::vector<Message>& findings, Reporter& reporter);

} // namespace sloper::garment
