#pragma once
/// One phase of a drape: sew, inflate, settle, move.
#include <sloper/garment/simulate/context.hpp>

namespace sloper::garment {

/// Phases in the order in which they run.
enum class DrapePhase {
  START,
  SEW,
  INFLATE,
  SETTLE,
  MOVE,
};

/// Outcome of a step: how the session continues.
enum class PhaseStatus {
  CONTINUE,
  DONE, ///< on to the next phase
  STOP, ///< the drape has ended
};

/// Interface of a phase. A session calls is_needed(), begin(), step() until it is not
/// CONTINUE, end().
class Phase {
public:
  virtual ~Phase() = default;
  /// Which phase it is.
  virtual DrapePhase id() const = 0;
  /// As report.json's `phases` names it; empty for a phase that keeps its time itself.
  virtual const char* name() const = 0;
  /// Whether there is anything to do.
  virtual bool is_needed(const SimContext& context) const = 0;
  /// Once before the first step.
  /// @param resumed  the phase continues from a checkpoint, with its state restored
  virtual void begin(SimContext& context, bool resumed) = 0;
  /// One step, or what belongs to one.
  virtual PhaseStatus step(SimContext& context) = 0;
  /// Also where the drape has ended.
  virtual void end(SimContext& /*context*/) {}

  /// Whether the cloth is built with open seams in this phase.
  virtual bool has_open_seams() const { return false; }
  /// Whether weight and friction act at the present step.
  virtual bool is_loaded(const SimContext& /*context*/) const { return false; }
  /// Whether a rebuilt solver starts with the present velocity.
  virtual bool keeps_velocity() const { return false; }
};

/// Builds the cloth anew in the middle of a phase, as a run that resumes from a
/// checkpoint does.
/// @param contact  memory of the body contact before
inline void rebuild(SimContext& context, const Phase& phase,
                    const cloth::BodyContactEffect::Memory& contact, bool keep_velocity) {
  context.build_cloth(phase.has_open_seams(), keep_velocity);
  if (phase.is_loaded(context))
    context.cloth.add_load();
  if (context.cloth.body_contact())
    context.cloth.body_contact()->recall(contact);
}

} // namespace sloper::garment
