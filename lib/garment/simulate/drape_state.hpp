#pragma once
/// All that a drape needs to go on from the moment between two of its steps; a checkpoint keeps it with the garment.
///
/// What is not here can be made again from it: the solver's matrix and hierarchy, near pairs, bounding boxes. They lag behind the
/// positions for some steps, so a drape makes them anew wherever a checkpoint is due, as the run that goes on from the checkpoint does;
/// from there both make the same steps, bit by bit. Test: tests/garment/simulate/test_checkpoint.cpp
#include <cloth/contact/body_contact.hpp>
#include <cloth/solver/implicit_step.hpp>
#include <garment/simulate/drape.hpp>

#include <limits>
#include <optional>

namespace sloper::garment {

struct BodyMoves; ///< motion.hpp

enum class DrapePhase { START, SEW, INFLATE, SETTLE, MOVE };

/// A motion of the body, between two of its frames, with the sums that its report will have.
struct MotionState {
  std::size_t frame = 0;      ///< the next one; in the phase MOVE the skin is that of the frame before it
  bool over = false;          ///< all frames are done, the cloth settles in the last pose
  std::vector<Vec3> velocity; ///< MOVE: #P by 3, m/s
  int parts = 0, forced = 0;  ///< see cloth/motion/body_motion.hpp
  int noted = 0;              ///< parts at the last checkpoint
  int forced_frames = 0, asleep_frames = 0;
  int bad_frames[3] = {}, most[3] = {};      ///< faces through the body, vertices inside it, self intersections
  double largest_way_m = 0, simulated_s = 0; ///< m, of a skin vertex in one frame; s
  double wall_s = 0, elapsed_s = 0;          ///< of moving the skin alone; of all of it
};

struct DrapeState {
  DrapePhase phase = DrapePhase::START;
  int step = 0;            ///< of the phase: the next one
  unsigned covered = 0;    ///< of CoveredSkin::Ends: cloth is near them
  bool whole_skin = false; ///< it meets no coarser one any more
  bool arms_aside = false; ///< forearms and hands are not in the way until the garment hangs, see Forearms
  bool shrunk = false;     ///< the body was drawn in at some time
  double scale = 1;        ///< of the body, see BodyShrink
  std::vector<Vec3> skin;  ///< INFLATE: of the body as the cloth meets it, m
  bool disturbed = false;  ///< by sewing, or by a body that was drawn in
  cloth::StepResult last;  ///< of the last step
  double last_h = 0;       ///< s, of that step
  cloth::BodyContactEffect::Memory contact;
  std::vector<int> cg_iterations; ///< of each step
  int solves = 0;                 ///< of all of them: StepResult::newton_iterations
  std::vector<std::string> rejected;
  // SEW
  double pull = 0;          ///< N, of a stitch at its reach
  int pull_changed = 0;     ///< step
  std::vector<double> gaps; ///< m, largest, by step
  // INFLATE
  double latest = 0, farthest = 0; ///< m, how far skin may stay back, and does
  std::vector<int> tucks;          ///< particles that may pass through each other until weight and friction come: sewing left them tucked in
  std::vector<Vec3> held;          ///< m, where sleeve ends are held (sleeve_ends.hpp), until weight and friction come
  // SETTLE
  double h = 0; ///< s
  int calm = 0, unmoved = 0, pushed = 0, best_at = 0, untanglings = 0, partings = 0;
  double best = std::numeric_limits<double>::infinity(); ///< least residual so far, weights
  std::vector<double> start_height;                      ///< #P, m, where settling began
  std::optional<double> thawed_at;                       ///< m, mean height when calm cloth was last let go of what a search kept in place
  int looked_at = 0;                                     ///< step, when cloth that may still be on its way was last looked at
  std::vector<Vec3> looked_from;                         ///< #P by 3, m, where it was some steps before the next look
  int free_steps = 0;                                    ///< still to go with its inertia
  std::vector<Vec3> velocity;                            ///< #P by 3, m/s, in the middle of those; else empty
  MotionState motion;                                    ///< of a drape in motion
};

/// How far a drape of garments over each other (layers.hpp) has come between the drapes that it is made of.
struct LayersProgress {
  DrapeSettings settings;           ///< of the whole; a garment that is draped alone has others
  std::vector<Garment> garments;    ///< from the skin outwards
  std::size_t alone = 0;            ///< which is draped alone at present; their number: all together
  std::vector<std::string> repairs; ///< so far
  double alone_s = 0;               ///< wall seconds of the drapes alone that are done
};

/// A drape interrupted: what checkpoint files hold. The report has what it had come to: steps, seconds, effects, phases, repairs, settings.
struct DrapeCheckpoint {
  Garment garment;
  DrapeState state;
  DrapeReport report;
  int every_steps = 0; ///< between two checkpoints
  bool has_body = false;
  std::optional<MotionInput> motion;    ///< of a drape in motion
  std::optional<LayersProgress> layers; ///< garment, state and report are of one of its drapes
  std::string file;                     ///< where it was read, for messages

  /// @param body  that is given now, or null   @param body_sha256  of its skin; empty: trusted
  /// @throws Error INPUT where the run began on another
  void check_body(const body::Body* body, const std::string& body_sha256) const;
  /// @param moves  given now, or null   @throws Error INPUT for one where the run began without, none where it began with one, and one too short
  void check_moves(const BodyMoves* moves) const;
};

inline constexpr int CHECKPOINT_VERSION = 2; ///< 1: without motion and layers
/// One JSON document (format "checkpoint"), replaced as a whole. @throws Error OUTPUT
void write_checkpoint(const std::string& path, const DrapeCheckpoint& checkpoint);
/// @throws Error INPUT
DrapeCheckpoint read_checkpoint(const std::string& path);

/// resume_drape() from what was read. @param checkpoints as for drape(); how often is the checkpoint's
DrapeReport resume_drape(const DrapeCheckpoint& checkpoint, Garment& garment, const body::Body* body, Reporter& reporter, Checkpoints checkpoints);

} // namespace sloper::garment
