#pragma once
/// One guarded step after the other, and when there are no more: limits of steps and time, the
/// user's wish to stop, a number that is none.
#include <sloper/cloth/solver/implicit_step.hpp>
#include <sloper/garment/simulate/simulated_cloth.hpp>
#include <sloper/garment/simulate/telemetry.hpp>
#include <sloper/io/json_fwd.hpp>

#include <string>
#include <vector>

namespace sloper::garment {

enum class StepKind {
  PLAIN,   ///< solved to the tolerance of the settings
  SEW,     ///< solved loosely: only where panels end up counts
  DESCEND, ///< with a line search: the energy must fall
};

struct StepRequest {
  double h = 1.0 / 30; ///< s
  StepKind kind = StepKind::PLAIN;
  double inertia = 0; ///< 0..1: share of the velocity that is carried over; not with DESCEND
  double largest_move_m = 0.02; ///< of any particle
  /// Without weight and friction: seams just closed and pinched cloth have nearly all the energy,
  /// the strain that is to even out has little, so the solve does not end by its energy.
  bool unloaded = false;
  double least_cg_tolerance =
      0; ///< the solve ends at this relative residual where the settings ask for less
  int cg_max_iterations = 0; ///< fewer than the settings allow; 0: as these
};

class StepController {
public:
  /// What a checkpoint keeps.
  struct State {
    cloth::StepResult last;         ///< of the last step
    double last_h = 0;              ///< s, of that step
    std::vector<int> cg_iterations; ///< of each step
    int solves = 0;                 ///< of all of them: StepResult::newton_iterations
    std::vector<std::string> rejected;

    void write(io::Json& state) const;
    static State read(const io::Node& state); ///< @throws Error INPUT
  };

  /// All outlive this.
  StepController(SimulatedCloth& cloth, const DrapeSettings& settings, Telemetry& telemetry);

  /// Makes a step. @return false when the drape must end
  bool advance(const StepRequest& request);
  /// Counts the solves of a step that was made elsewhere, and undoes nothing. @param what  for the
  /// report, where a number is none
  /// @return false when the drape must end
  bool note(const cloth::StepResult& result, const std::string& what);
  /// Ends the drape where its time is over or the user asked for it.
  void check_time();

  void stop(StopReason reason);
  bool stopped() const { return m_stopped; }
  /// The limit is on the way to rest: steps that a motion took do not count.
  void allow_more_steps(int steps) { m_step_limit += steps; }

  const cloth::StepResult& last() const { return m_state.last; }
  double last_h() const { return m_state.last_h; }
  double speed() const {
    return m_state.last_h > 0 ? m_state.last.largest_move_m / m_state.last_h : 0;
  } ///< m/s, of the fastest particle
  const State& state() const { return m_state; }
  void restore(State state) { m_state = std::move(state); }
  /// Steps before a session went live do not count.
  void forget_iterations() { m_state.cg_iterations.clear(); }

private:
  cloth::StepOptions options_for(const StepRequest& request) const;

  SimulatedCloth& m_cloth;
  const DrapeSettings& m_settings;
  Telemetry& m_telemetry;
  State m_state;
  int m_step_limit;
  bool m_stopped = false;
};

} // namespace sloper::garment
