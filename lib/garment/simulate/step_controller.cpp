#include <sloper/garment/simulate/step_controller.hpp>
#include <sloper/io/json.hpp>
#include <sloper/io/json_lists.hpp>

#include <algorithm>

namespace sloper::garment {

namespace {

constexpr double ENERGY_LEFT = 0.15; // of a solve's error in the energy norm; 0.03 to 0.1 and 0.3
                                     // took as long or longer over seven garments
constexpr double EXACT_ENERGY_LEFT =
    0.05; // the same of cloth from a coarser mesh: on a T-shirt and trousers three starts 1 um
          // apart end 0.3 and 0.2 mm apart in place of 0.5 and 2.8, in 0.7 of the steps
constexpr double LEFT_AT_REST = 0.025; // the same where all is as slow as at rest: what is slack
                                       // and still moving has little of the energy
constexpr double ROUGH = 0.01;         // relative residual; who asks for less means it
constexpr double SEW_TOLERANCE = 0.05; // relative residual of a step while sewing
constexpr double DRAWN_BY_TENSION =
    100; // weights: forces above come from strain. A band taken in by 30 % is at rest after 80 to
         // 110 steps in place of 79 to 1,500, with any number from 1 to 1,000 (12 starts)

} // namespace

StepController::StepController(SimulatedCloth& cloth, const DrapeSettings& settings,
                               Telemetry& telemetry)
    : m_cloth(cloth), m_settings(settings), m_telemetry(telemetry),
      m_step_limit(settings.max_steps) {}

cloth::StepOptions StepController::options_for(const StepRequest& request) const {
  cloth::StepOptions options;
  options.h = request.h;
  options.inertia = request.inertia;
  options.largest_move_m = request.largest_move_m;
  options.line_search = request.kind == StepKind::DESCEND;
  options.cg_tolerance = std::max(request.least_cg_tolerance, m_settings.cg_tolerance);
  if (request.warm)
    options.blocking_force_ratio = DRAWN_BY_TENSION;
  if (request.kind == StepKind::SEW)
    options.cg_tolerance = std::max(SEW_TOLERANCE, options.cg_tolerance);
  options.cg_max_iterations = m_settings.cg_max_iterations;
  if (request.cg_max_iterations > 0)
    options.cg_max_iterations = std::min(options.cg_max_iterations, request.cg_max_iterations);
  if (request.kind != StepKind::PLAIN && !request.unloaded && m_settings.cg_tolerance >= ROUGH) {
    const double left = request.exact ? EXACT_ENERGY_LEFT : ENERGY_LEFT;
    const bool slow = options.line_search &&
                      m_state.last.largest_move_m < m_settings.settle_speed_m_s * m_state.last_h;
    options.cg_energy_tolerance = slow ? LEFT_AT_REST : left;
  }
  return options;
}

bool StepController::note(const cloth::StepResult& result, const std::string& what) {
  m_state.last = result;
  m_state.cg_iterations.push_back(result.cg.iterations);
  m_state.solves += result.newton_iterations;
  if (result.finite)
    return true;
  m_state.rejected.push_back(what + ": not finite, undone");
  m_cloth.solver().stop();
  stop(StopReason::NOT_FINITE);
  return false;
}

bool StepController::advance(const StepRequest& request) {
  DrapeReport& report = m_telemetry.report;
  const cloth::StepResult result = m_cloth.solver().step(options_for(request));
  ++report.steps;
  report.simulated_s += request.h;
  m_state.last_h = request.h;
  if (!note(result, "step " + std::to_string(report.steps)))
    return false;
  check_time();
  const int limit = m_step_limit + (m_patient ? m_settings.extra_steps : 0);
  if (!m_stopped && report.steps >= limit)
    stop(StopReason::STEP_LIMIT);
  return !m_stopped;
}

void StepController::check_time() {
  if (m_stopped)
    return;
  if (m_settings.max_seconds > 0 && m_telemetry.elapsed() > m_settings.max_seconds)
    stop(StopReason::TIME_LIMIT);
  else if (m_telemetry.reporter.stop_requested())
    stop(StopReason::INTERRUPTED);
}

void StepController::stop(StopReason reason) {
  m_stopped = true;
  m_telemetry.report.stop_reason = reason;
}

} // namespace sloper::garment
