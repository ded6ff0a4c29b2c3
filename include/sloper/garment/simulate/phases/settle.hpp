#pragma once
/// Brings the sewn garment to rest.
///
/// A garment whose start is strained first relaxes free of weight and friction, which
/// would keep that strain. Then each step must lower the energy; cloth that still drifts
/// makes some steps with inertia. Crossings with the skin or of the cloth with itself
/// that remain are resolved meanwhile.
#include <sloper/garment/simulate/phases/phase.hpp>
#include <sloper/io/json_fwd.hpp>

#include <limits>
#include <optional>
#include <vector>

namespace sloper::garment {

/// The phase that ends at rest; it runs again after a motion.
class SettlePhase : public Phase {
public:
  /// State that a checkpoint keeps.
  struct State {
    int step = 0;    ///< the next one
    double h = 0;    ///< s
    int calm = 0;    ///< steps within the tolerances of rest, one after the other
    int unmoved = 0; ///< steps in which nothing moved, one after the other
    /// Steps at rest in which contact pushed crossing faces out of the skin.
    int pushed = 0;
    int best_residual_step = 0; ///< at which best_residual was reached
    double best_residual = std::numeric_limits<double>::infinity(); ///< weights
    std::vector<double> start_height;                               ///< #P, m, where settling began
    /// Mean height at the last release of particles that a line search blocked.
    std::optional<double> release_height_m;
    int probe_step = 0;               ///< when drift was last looked at
    std::vector<Vec3> probe_position; ///< #P by 3, m, some steps before the next look
    int dynamic_steps = 0;            ///< still to go with inertia
    int knots_opened = 0;             ///< how often cloth at rest that crossed itself was let pass
    int knots_close_at = -1;          ///< the step at which that ends; -1: nothing passes
    std::vector<Vec3> velocity;       ///< #P by 3, m/s; only in a checkpoint taken within those

    /// Adds its keys to a checkpoint's object; read() is the inverse.
    void write(io::Json& state) const;
    /// @throws Error INPUT, where lists do not belong to the garment too
    static State read(const io::Node& state, std::size_t n_particles);
  };

  DrapePhase id() const override { return DrapePhase::SETTLE; }
  const char* name() const override { return "settle"; }
  bool is_needed(const SimContext&) const override { return true; }
  void begin(SimContext& context, bool resumed) override;
  PhaseStatus step(SimContext& context) override;
  void end(SimContext& context) override;
  bool is_loaded(const SimContext& context) const override;
  bool keeps_velocity() const override { return m_state.dynamic_steps > 0; }

  /// For checkpoints.
  const State& state() const { return m_state; }
  /// Takes the state of a checkpoint.
  void restore(State state) { m_state = std::move(state); }
  /// Before it settles once more after a motion.
  void forget_progress();

private:
  PhaseStatus iterate(SimContext& context);
  void prepare_step(SimContext& context);
  void look_for_drift(SimContext& context);
  void end_dynamic_step(SimContext& context);
  void adapt_step(SimContext& context);
  bool has_stalled(SimContext& context);
  bool nears_rest(SimContext& context) const;
  bool release_blocked(SimContext& context);
  void judge_fit(SimContext& context);
  bool resolve_leftovers(SimContext& context);
  PhaseStatus conclude(SimContext& context);
  bool open_knots(SimContext& context);
  void close_knots(SimContext& context);
  void let_arms_hang(SimContext& context);
  void drop_coarse_proxy(SimContext& context);
  void restart_calm(SimContext& context);
  int unloaded_steps(const SimContext& context) const;

  State m_state;
};

} // namespace sloper::garment
