#include <sloper/garment/drape/judge_faults.hpp>
#include <sloper/io/json.hpp>

namespace sloper::garment {

bool fail_where_at_fault(Garment& garment, DrapeReport& report) {
  if (!report.converged || garment.panels.faults.empty())
    return false;
  report.converged = garment.converged = false;
  report.stop_reason = StopReason::AT_REST_AT_FAULT;
  report.stop_detail = garment.panels.faults.front();
  return true;
}

void judge_faults(Garment& garment, DrapeOutcome& outcome) {
  if (!fail_where_at_fault(garment, outcome.report))
    return;
  outcome.document["converged"] = false;
  outcome.document["stop_reason"] = stop_text(outcome.report);
}

Message not_done(const DrapeReport& report, const std::string& written) {
  const std::string fact = "not done: " + stop_text(report);
  if (report.stop_reason == StopReason::AT_REST_AT_FAULT)
    return {"drape.panels-at-fault"_id,
            fact +
                "; mend that with pattern-mesh, or give drape --accept-faults where it is meant "
                "so; the garment as it hangs is in " +
                written};
  return {"drape.not-at-rest"_id, fact + " after " + std::to_string(report.steps) +
                                      " steps; the state reached is in " + written};
}

} // namespace sloper::garment
