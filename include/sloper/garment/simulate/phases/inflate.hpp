#pragma once
/// Brings a body that was drawn in back to its full size, without passing through cloth that is
/// clear of it.
///
/// Each vertex of the skin moves at most half its clearance per step, then the cloth makes room.
/// Where the cloth is slow the skin may lag, by MAX_SKIN_LAG and less and less once the rest of the
/// body is back; then it is forced through, and contact pushes the cloth.
#include <sloper/garment/simulate/phases/phase.hpp>
#include <sloper/io/json_fwd.hpp>

#include <vector>

namespace sloper::garment {

/// The phase after sewing in a body that was drawn in.
class InflatePhase : public Phase {
public:
  /// State that a checkpoint keeps.
  struct State {
    double max_skin_lag_m = 0; ///< how far skin may stay back
    double skin_lag_m = 0;     ///< how far it does
    /// #V of the collider by 3, m; only in a checkpoint taken in this phase.
    std::vector<Vec3> skin;

    /// Adds its keys to a checkpoint's object; read() is the inverse.
    void write(io::Json& state) const;
    static State read(const io::Node& state); ///< @throws Error INPUT
  };

  DrapePhase id() const override { return DrapePhase::INFLATE; }
  const char* name() const override { return "inflate body"; }
  bool is_needed(const SimContext& context) const override;
  void begin(SimContext& context, bool resumed) override;
  PhaseStatus step(SimContext& context) override;
  void end(SimContext& context) override;

  /// For checkpoints.
  const State& state() const { return m_state; }
  /// Takes the state of a checkpoint.
  void restore(State state) { m_state = std::move(state); }

private:
  void move_skin(SimContext& context);
  bool is_done(const SimContext& context) const;

  State m_state;
  std::vector<Vec3> m_skin; // #V of the collider by 3, m, as it stands
};

} // namespace sloper::garment
