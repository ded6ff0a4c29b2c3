#pragma once
/// Drapes of panels in which pattern-mesh found a fault: at rest, but no garment.
/// Test: tests/garment/drape/test_judge_faults.cpp
#include <sloper/garment/drape/drape_job.hpp>

#include <string>

namespace sloper::garment {

/// Where pattern-mesh ended with exit status 4 on the panels (PanelMesh::faults), a drape that came
/// to rest counts as failed all the same: converged is false in garment and report, with the
/// reason. A pattern that is half sewn may hang still and clean, and is no garment.
/// @return whether they are at fault, and it had come to rest
bool fail_where_at_fault(Garment& garment, DrapeReport& report);

/// The same of a drape whose document is written too.
void judge_faults(Garment& garment, DrapeOutcome& outcome);

/// The warning on a drape that is not done, with its next step.
/// @param written  the file that has the state reached
Message not_done(const DrapeReport& report, const std::string& written);

} // namespace sloper::garment
