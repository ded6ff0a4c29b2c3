#include <sloper/garment/drape/judge_roll_lines.hpp>
#include <sloper/io/files.hpp>
#include <sloper/io/json.hpp>

namespace sloper::garment {

std::vector<Message> unturned_findings(const std::vector<RollLineState>& states,
                                       const std::string& file) {
  std::vector<Message> out;
  for (const RollLineState& state : states)
    if (!state.is_turned())
      out.push_back({"drape.not-turned"_id,
                     io::file_name(file) + ": " + turned_text(state) +
                         "; draw the line where cloth can fold, or a smaller --edge-length"});
  return out;
}

bool fail_where_one_stands(const std::vector<RollLineState>& states, Garment& garment,
                           DrapeReport& report) {
  const std::string standing = standing_text(states);
  if (!report.converged || standing.empty())
    return false;
  report.converged = garment.converged = false;
  report.stop_reason = StopReason::AT_REST_UNTURNED;
  report.stop_detail = standing;
  return true;
}

void judge_roll_lines(Garment& garment, DrapeOutcome& outcome, const std::string& file,
                      std::vector<Message>& findings, Reporter& reporter) {
  const std::vector<RollLineState> states = roll_line_states(garment);
  if (states.empty())
    return;
  outcome.document["roll_lines"] = roll_lines_json(states);
  for (const Message& finding : unturned_findings(states, file)) {
    findings.push_back(finding);
    reporter.warning(finding);
  }
  if (!fail_where_one_stands(states, garment, outcome.report))
    return;
  outcome.document["converged"] = false;
  outcome.document["stop_reason"] = stop_text(outcome.report);
}

} // namespace sloper::garment
