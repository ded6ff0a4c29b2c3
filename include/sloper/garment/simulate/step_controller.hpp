#pragma once
/// Makes guarded steps and decides when there are no more: limits of steps and time, the
/// user's wish to stop, a result that is not finite.
#include <sloper/cloth/solver/implicit_step.hpp>
#include <sloper/garment/simulate/simulated_cloth.hpp>
#include <sloper/garment/simulate/telemetry.hpp>
#include <sloper/io/json_fwd.hpp>

#include <string>
#include <vector>

namespace sloper::garment {

/// How a step is solved.
enum class StepKind {
  PLAIN,   ///< solved to the tolerance of the settings
  SEW,     ///< solved loosely: only where panels end up counts
  DESCEND, ///< with a line search: the energy must fall
};

/// One step as a phase asks for it.
struct StepRequest {
  double h = 1.0 / 30;             ///< s
  StepKind kind = StepKind::PLAIN; ///< tolerance and line search
  double inertia = 0; ///< 0..1: share of the velocity that is carried over; not with DESCEND
  double largest_move_m = 0.02; ///< of any particle
  /// Without weight and friction: seams just closed and pinched cloth have nearly all the energy,
  /// the strain that is to even out has little, so the solve does not end by its energy.
  bool unloaded = false;
  /// A solve leaves less of the energy's error than usual: DrapeRequest::carried.
  bool exact = false;
  /// Of cloth that came sewn, outside the body and not from a coarser mesh: sewing has left no
  /// pinches, so nothing is blocked where tension draws all of it.
  bool warm = false;
  /// Lower bound of the relative residual at which the solve ends, where the settings ask
  /// for less.
  double least_cg_tolerance = 0;
  int cg_max_iterations = 0; ///< fewer than the settings allow; 0: as these
};

/// Steps the session's cloth and counts.
class StepController {
public:
  /// State that a checkpoint keeps.
  struct State {
    cloth::StepResult last;         ///< of the last step
    double last_h = 0;              ///< s, of that step
    std::vector<int> cg_iterations; ///< of each step
    int solves = 0;                 ///< of all of them: StepResult::newton_iterations
    /// Steps that were undone, with the reason.
    std::vector<std::string> rejected;

    /// Adds its keys to a checkpoint's object; read() is the inverse.
    void write(io::Json& state) const;
    static State read(const io::Node& state); ///< @throws Error INPUT
  };

  /// All outlive this.
  StepController(SimulatedCloth& cloth, const DrapeSettings& settings, Telemetry& telemetry);

  /// Makes a step. @return false when the drape must end
  bool advance(const StepRequest& request);
  /// Counts the solves of a step that was made elsewhere; it undoes nothing.
  /// @param what  begins the entry of the report where the result is not finite
  /// @return false when the drape must end
  bool note(const cloth::StepResult& result, const std::string& what);
  /// Ends the drape where its time is over or the user asked for it.
  void check_time();

  /// Ends the drape with this reason.
  void stop(StopReason reason);
  /// Whether the drape has ended.
  bool stopped() const { return m_stopped; }
  /// Raises the step limit, which is meant for the time until rest: substeps of a motion
  /// do not count.
  void allow_more_steps(int steps) { m_step_limit += steps; }
  /// Whether DrapeSettings::extra_steps may follow the limit, until this is set anew.
  void set_patient(bool patient) { m_patient = patient; }

  /// Result of the last step and its length, s.
  const cloth::StepResult& last() const { return m_state.last; }
  double last_h() const { return m_state.last_h; }
  /// Speed of the fastest particle in the last step, m/s.
  double speed() const {
    return m_state.last_h > 0 ? m_state.last.largest_move_m / m_state.last_h : 0;
  }
  const State& state() const { return m_state; }
  /// Takes the state of a checkpoint.
  void restore(State state) { m_state = std::move(state); }
  /// Drops the counts of steps made before a live session began.
  void forget_iterations() { m_state.cg_iterations.clear(); }

private:
  cloth::StepOptions options_for(const StepRequest& request) const;

  SimulatedCloth& m_cloth;
  const DrapeSettings& m_settings;
  Telemetry& m_telemetry;
  State m_state;
  int m_step_limit;
  bool m_patient = false; ///< extra steps may follow the limit
  bool m_stopped = false;
};

} // namespace sloper::garment
