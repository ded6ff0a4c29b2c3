#pragma once
/// Draws the placed panels together along their seams, without weight, and welds the seams.
#include <sloper/garment/simulate/phases/phase.hpp>
#include <sloper/io/json_fwd.hpp>

#include <vector>

namespace sloper::garment {

/// The first phase of unsewn panels.
class SewPhase : public Phase {
public:
  /// State that a checkpoint keeps.
  struct State {
    int step = 0;             ///< the next one
    double pull = 0;          ///< N, of a stitch at SEW_REACH
    int pull_changed = 0;     ///< step
    std::vector<double> gaps; ///< m, largest, by step

    /// Adds its keys to a checkpoint's object; read() is the inverse.
    void write(io::Json& state) const;
    static State read(const io::Node& state); ///< @throws Error INPUT
  };

  DrapePhase id() const override { return DrapePhase::SEW; }
  const char* name() const override { return "sew"; }
  bool is_needed(const SimContext& context) const override;
  void begin(SimContext& context, bool resumed) override;
  PhaseStatus step(SimContext& context) override;
  bool has_open_seams() const override { return true; }

  /// For checkpoints.
  const State& state() const { return m_state; }
  /// Takes the state of a checkpoint.
  void restore(State state) { m_state = std::move(state); }

private:
  bool adapt_pull();
  void weld_seams(SimContext& context) const;

  State m_state;
};

} // namespace sloper::garment
