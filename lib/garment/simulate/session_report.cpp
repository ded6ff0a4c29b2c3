/// The end of a session: the audit, and what the report says of it.
#include <garment/simulate/audit.hpp>
#include <garment/simulate/session.hpp>
#include <sloper/io/json.hpp>

#include <algorithm>

namespace sloper::garment {

namespace {

io::Json quantiles_json(const double q[3]) {
  return {{"p50", q[0]}, {"p99", q[1]}, {"max", q[2]}};
}

} // namespace

void DrapeSession::write_quality(const Audit& audit) {
  DrapeReport& report = m_context.telemetry.report;
  const cloth::StepResult& last = m_context.stepper.last();
  if (!audit.clean() && report.converged) {
    report.converged = false;
    report.stop_reason = StopReason::AT_REST_UNCLEAN;
  }
  report.quality = {{"max_speed_m_s", m_context.stepper.speed()},
                    {"residual_force_ratio", last.residual_force_ratio},
                    {"residual_force_ratio_max", last.residual_force_ratio_max},
                    {"particles_held", last.held},
                    {"strain",
                     {{"warp", quantiles_json(audit.strain_warp)},
                      {"weft", quantiles_json(audit.strain_weft)},
                      {"bias", quantiles_json(audit.strain_bias)}}},
                    {"faces_through_body", audit.through.size()},
                    {"vertices_inside_body", audit.inside.size()},
                    {"deepest_m", audit.deepest_m},
                    {"self_intersections", audit.self.size()}};
}

void DrapeSession::write_solver_report() {
  const StepController::State& state = m_context.stepper.state();
  std::vector<int> sorted = state.cg_iterations;
  std::sort(sorted.begin(), sorted.end());
  double sum = 0;
  for (int n : sorted)
    sum += n;
  const std::size_t n = std::max<std::size_t>(sorted.size(), 1);
  const int p95 = sorted.empty() ? 0 : sorted[(n - 1) * 95 / 100];
  const int max = sorted.empty() ? 0 : sorted.back();
  m_context.telemetry.report.solver = {
      {"cg_iterations", {{"mean", sum / static_cast<double>(n)}, {"p95", p95}, {"max", max}}},
      {"residual", state.last.cg.residual},
      {"newton", static_cast<double>(state.solves) / static_cast<double>(n)},
      {"rejected_steps", state.rejected}};
}

DrapeReport DrapeSession::finish() {
  DrapeReport& report = m_context.telemetry.report;
  Garment& garment = m_context.cloth.garment();
  m_context.cloth.tear_down();
  if (m_audits || !report.converged) {
    const PhaseTimer timer(m_context.telemetry, "audit");
    m_context.body.use_full_skin(); // what stood for it was only a means
    write_quality(audit(garment, m_context.body.collider()));
    write_solver_report();
    if (m_move.moves()) {
      report.quality["motion"] = m_move.report();
      if (report.converged && m_move.bad_frames() > 0) {
        report.converged = false;
        report.stop_reason = StopReason::AT_REST_AFTER_UNCLEAN_FRAMES;
      }
    }
  }
  garment.converged = report.converged;
  garment.offset_m = m_context.settings.contact_gap_m;
  report.wall_s = elapsed();
  return std::move(report);
}

} // namespace sloper::garment
