#pragma once
/// The body moves, frame by frame, and the cloth follows it with its own inertia.
#include <sloper/cloth/motion/body_motion.hpp>
#include <sloper/garment/simulate/body_moves.hpp>
#include <sloper/garment/simulate/phases/phase.hpp>
#include <sloper/io/json_fwd.hpp>

#include <optional>
#include <vector>

namespace sloper::garment {

/// How long cloth has been at rest on a body that stands still. It goes by the distance
/// from one place, not by speed or force, since single particles can flip between two
/// states of contact for ever.
class RestClock {
public:
  /// Something moves near the cloth: the rest begins anew.
  void reset() { m_from.clear(); }
  /// Adds a simulated frame: its time counts while every particle stays near the place
  /// where the rest began.
  /// @param x  #P by 3, m
  /// @param frame_s  s
  void note(const std::vector<Vec3>& x, double frame_s);
  /// Whether that has lasted long enough for the cloth to sleep.
  bool is_at_rest() const;

private:
  std::vector<Vec3> m_from; // where the cloth was when the rest began; none: it moves
  double m_s = 0;
};

/// The phase that advances the body; skipped without a motion.
class MovePhase : public Phase {
public:
  /// State that a checkpoint keeps: where the motion is, with the sums that its report will have.
  struct State {
    /// The next one; while the body moves the skin is that of the frame before it.
    std::size_t frame = 0;
    bool over = false;          ///< all frames are done, the cloth settles in the last pose
    std::vector<Vec3> velocity; ///< #P by 3, m/s; only in a checkpoint taken in this phase
    /// Substeps; advances in which skin was forced through cloth
    /// (cloth/motion/body_motion.hpp).
    int parts = 0, forced = 0;
    int noted = 0; ///< substeps at the last checkpoint
    /// Frames in which skin was forced through cloth; frames in which the cloth slept and
    /// was not simulated.
    int forced_frames = 0, asleep_frames = 0;
    /// Frames with, and largest count in a frame of: faces through the body, vertices
    /// inside it, self-intersections.
    int bad_frames[3] = {}, most[3] = {};
    /// Largest displacement of a skin vertex in one frame, m; simulated time, s.
    double largest_way_m = 0, simulated_s = 0;
    double wall_s = 0, elapsed_s = 0; ///< of moving the skin alone; of all of it

    /// For a checkpoint; read() is the inverse.
    io::Json to_json() const;
    static State read(const io::Node& state); ///< @throws Error INPUT
  };

  /// @param moves  null: the body stands still; outlives this   @param on_frame  after each frame;
  /// may be empty
  MovePhase(const BodyMoves* moves, OnMotionFrame on_frame)
      : m_moves(moves), m_on_frame(std::move(on_frame)) {}

  DrapePhase id() const override { return DrapePhase::MOVE; }
  const char* name() const override { return ""; }
  bool is_needed(const SimContext& context) const override;
  void begin(SimContext& context, bool resumed) override;
  PhaseStatus step(SimContext& context) override;
  void end(SimContext& context) override;
  bool is_loaded(const SimContext&) const override { return true; }
  bool keeps_velocity() const override { return true; }

  /// As given; null: the body stands still.
  const BodyMoves* moves() const { return m_moves; }
  /// As it is now, the seconds that it took too.
  State state(const SimContext& context) const;
  /// Takes the state of a checkpoint.
  void restore(State state) { m_state = std::move(state); }
  /// Frames with faces through the body, vertices inside it or self-intersections: the
  /// largest of the three counts.
  int bad_frames() const;
  /// `quality.motion` of report.json.
  io::Json report() const;

private:
  struct Substeps {
    std::size_t count;
    cloth::StepOptions options;
  };
  Substeps substeps(const SimContext& context) const;
  void make_motion(SimContext& context);
  bool wakes(const SimContext& context, const std::vector<Vec3>& from,
             const std::vector<Vec3>& to) const;
  void move_skin(SimContext& context, const std::vector<Vec3>& from, MotionFrame& frame);
  void audit(const SimContext& context, MotionFrame& frame) const;
  void count(MotionFrame& frame);

  const BodyMoves* m_moves;
  OnMotionFrame m_on_frame;
  State m_state;
  std::optional<cloth::BodyMotion> m_motion;
  RestClock m_rest;
  MotionFrame m_last;       // counts of an audit hold while nothing moves
  std::vector<Vec3> m_skin; // #V of the body by 3, m, as it stands
  double m_began = 0;       // s of the drape's clock, as if it had all been one run
};

} // namespace sloper::garment
