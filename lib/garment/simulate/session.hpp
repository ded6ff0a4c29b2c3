#pragma once
/// One drape in progress. A session owns all state of it and goes through its phases: sew, inflate,
/// settle, and where the body moves, move and settle once more. A fresh start and a checkpoint
/// differ by the initial state alone.
///
/// Clients stand on this interface: drape() and resume_drape(), drape_in_motion(), drape_layers(),
/// drape_to_goal(), follow(), untangle_only().
#include <garment/simulate/audit.hpp>
#include <sloper/garment/simulate/checkpoint.hpp>
#include <sloper/garment/simulate/context.hpp>

#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace sloper::garment {

/// What a session works on; all but the request outlives it.
struct SessionInputs {
  Garment& garment;                 ///< in: placed panels or a sewn garment; out: the state reached
  const body::Body* body = nullptr; ///< null for none
  const BodyMoves* moves = nullptr; ///< null: the body stands still
  OnMotionFrame on_frame = {};      ///< after each frame of the motion
  DrapeRequest request = {};
};

/// One drape, from its start or from a checkpoint.
class DrapeSession : private CheckpointSink {
public:
  /// A fresh start. @throws Error INPUT for a garment that cannot be simulated
  DrapeSession(const SessionInputs& inputs, const DrapeSettings& settings, Reporter& reporter);
  /// Goes on from a checkpoint; the garment becomes the checkpoint's, and so do settings, the
  /// bounds of a fit, and how often checkpoints are taken.
  /// @throws Error INPUT for another body or another motion
  DrapeSession(const SessionInputs& inputs, const DrapeCheckpoint& from, Reporter& reporter);
  ~DrapeSession() override;

  // A whole drape.
  /// One step of the present phase, or the change to the next. @return whether there is more to do
  bool step();
  /// All of them, and the audit.
  DrapeReport run();

  // A live session, which a client leads itself.
  /// Brings the garment outside of the body and to its weight, without settling: from then on the
  /// client makes steps. @param loaded  with weight and friction
  void start_live(bool loaded);
  /// One guarded step. @return false when the session must end
  bool advance(const StepRequest& request);
  void interrupt() { m_context.stepper.stop(StopReason::INTERRUPTED); }
  bool stopped() const { return m_context.stepper.stopped(); }
  const cloth::StepResult& last_step() const { return m_context.stepper.last(); }
  /// Searches now for what the next step of h seconds would search for first.
  void prefetch_contacts(double h) { m_context.cloth.solver().prefetch_contacts(h); }
  /// @param x #P by 3, m
  void set_positions(const std::vector<Vec3>& x);
  /// The garment has other rest lengths under the same particles: it goes on in place.
  void replace_rest_shape() { m_context.cloth.replace_rest_shape(); }
  /// The garment has another mesh or other positions: cloth and solver are made anew. @param loaded
  /// with weight and friction
  void rebuild_cloth(bool loaded);
  /// The steps until now do not count for the limit, nor in the report.
  void forget_steps() { m_context.telemetry.report.steps = 0; }
  void forget_simulated_time();
  /// Brings it to rest from where it is, with weight from the first step. Call finish() then.
  void settle();

  // Without a drape.
  /// Draws the body in where the garment starts inside it, untangles, and inflates the body again;
  /// without weight. Call after choose_effects().
  void push_apart(int max_push_steps);
  /// For clients that resolve penetrations alone: only contact takes part.
  void choose_contact_alone();
  PenetrationResolver& resolver() { return m_context.resolver; }
  /// The skin itself, with nothing that stands for it. @return null where there is none
  const collision::BodyCollider* full_skin();
  bool has_collider() const { return m_context.body.collider() != nullptr; }
  Telemetry& telemetry() { return m_context.telemetry; }

  /// Audits the garment and writes the report. @return it
  DrapeReport finish();
  double elapsed() const { return m_context.telemetry.elapsed(); }

private:
  bool offer() override;
  bool offer(int count, int& last) override;
  bool takes_checkpoints() const;
  void take_checkpoint();
  DrapeState save() const;
  void restore(const DrapeCheckpoint& from);
  void restore_body(const DrapeCheckpoint& from);

  void begin();
  void start_outside_body(bool unsewn);
  void shrink_body_out_of_cloth();
  void close_seams();
  void inflate_now();
  void enter(std::size_t index, bool resumed);
  void leave();
  bool advance_to_next_phase();
  void write_quality(const Audit& audit);
  void write_solver_report();

  SimContext m_context;
  StartFacts m_start;
  bool m_audits; // DrapeRequest::audit
  Checkpoints m_checkpoints;
  int m_checkpoint_step = 0; // of all steps, where the last one was
  SewPhase m_sew;
  InflatePhase m_inflate;
  SettlePhase m_settle;
  MovePhase m_move;
  std::vector<Phase*> m_plan; // chosen once
  std::size_t m_index = 0;    // in the plan, of the present phase
  Phase* m_phase = nullptr;   // the present one; null between two
  std::unique_ptr<PhaseTimer> m_timer;
  bool m_begun = false;
  bool m_resumed = false; // and its phase has not gone on yet
};

} // namespace sloper::garment
