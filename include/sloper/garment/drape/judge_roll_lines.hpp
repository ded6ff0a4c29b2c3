#pragma once
/// Whether a drape turned collars and lapels over as their pattern says.
/// Test: tests/cli/tools/drape.sh
#include <sloper/garment/drape/drape_job.hpp>
#include <sloper/garment/simulate/roll_line_states.hpp>

#include <string>
#include <vector>

namespace sloper::garment {

/// A finding for each roll line that is not turned over.
/// @param file  of the garment, to name it
std::vector<Message> unturned_findings(const std::vector<RollLineState>& states,
                                       const std::string& file);

/// Where one stands, a drape that came to rest counts as failed: converged is false in garment and
/// report, with the reason.
/// @return whether one does, and it had come to rest
bool fail_where_one_stands(const std::vector<RollLineState>& states, Garment& garment,
                           DrapeReport& report);

/// Judges a drape that has ended by its roll lines (roll_line_states.hpp): the document gets their
/// states as `roll_lines`. One that is not turned over is a finding. Where one stands, the drape
/// counts as failed (converged is false in garment, report and document, with the reason).
/// @param file  of the garment, to name it   @param outcome  of do_drape(), in and out
/// @param findings  receives the findings, each of which is a warning too
void judge_roll_lines(Garment& garment, DrapeOutcome& outcome, const std::string& file,
                      std::vector<Message>& findings, Reporter& reporter);

} // namespace sloper::garment
