#include <sloper/garment/drape/judge_roll_lines.hpp>
#include <sloper/garment/simulate/roll_line_states.hpp>
#include <sloper/io/files.hpp>
#include <sloper/io/json.hpp>

namespace sloper::garment {

void judge_roll_lines(Garment& garment, DrapeOutcome& outcome, const std::string& file,
                      std::vector<Message>& findings, Reporter& reporter) {
  const std::vector<RollLineState> states = roll_line_states(garment);
  if (states.empty())
    return;
  outcome.document["roll_lines"] = roll_lines_json(states);
  for (const RollLineState& state : states) {
    if (state.is_turned())
      continue;
    findings.push_back({"drape.not-turned"_id,
                        io::file_name(file) + ": " + turned_text(state) +
                            "; draw the line where cloth can fold, or a smaller --edge-length"});
    reporter.warning(findings.back());
  }
  const std::string standing = standing_text(states);
  DrapeReport& report = outcome.report;
  if (!report.converged || standing.empty())
    return;
  report.converged = garment.converged = false;
  report.stop_reason = StopReason::AT_REST_UNTURNED;
  report.stop_detail = standing;
  outcome.document["converged"] = false;
  outcome.document["stop_reason"] = stop_text(report);
}

} // namespace sloper::garment
