#pragma once
/// All that a drape needs to go on from the moment between two of its steps; a checkpoint keeps it with the garment.
///
/// What is not here can be made again from it: the solver's matrix and hierarchy, near pairs, bounding boxes. They lag behind the
/// positions for some steps, so a drape makes them anew wherever a checkpoint is due, as the run that goes on from the checkpoint does;
/// from there both make the same steps, bit by bit. Test: tests/garment/test_checkpoint.cpp
#include <cloth/body_contact.hpp>
#include <cloth/implicit_step.hpp>
#include <garment/drape.hpp>

#include <limits>

namespace sloper::garment {

enum class DrapePhase { START, SEW, INFLATE, SETTLE };

struct DrapeState {
  DrapePhase phase = DrapePhase::START;
  int step = 0;           ///< of the phase: the next one
  bool mitten = false;    ///< cloth is near a hand
  bool shrunk = false;    ///< the body was drawn in at some time
  double scale = 1;       ///< of the body, see BodyShrink
  std::vector<Vec3> skin; ///< INFLATE: of the body as the cloth meets it, m
  bool disturbed = false; ///< by sewing, or by a body that was drawn in
  cloth::StepResult last; ///< of the last step
  double last_h = 0;      ///< s, of that step
  cloth::BodyContactEffect::Memory contact;
  std::vector<int> cg_iterations; ///< of each step
  std::vector<std::string> rejected;
  // SEW
  double pull = 0;          ///< N, of a stitch at its reach
  int pull_changed = 0;     ///< step
  std::vector<double> gaps; ///< m, largest, by step
  // INFLATE
  double latest = 0, farthest = 0; ///< m, how far skin may stay back, and does
  // SETTLE
  double h = 0; ///< s
  int calm = 0, unmoved = 0, pushed = 0, best_at = 0, untanglings = 0, partings = 0;
  double best = std::numeric_limits<double>::infinity(); ///< least residual so far, weights
  std::vector<double> start_height;                      ///< #P, m, where settling began
};

/// A drape interrupted: what checkpoint files hold. The report has what it had come to: steps, seconds, effects, phases, repairs, settings.
struct DrapeCheckpoint {
  Garment garment;
  DrapeState state;
  DrapeReport report;
  int every_steps = 0; ///< between two checkpoints
  bool has_body = false;
};

inline constexpr int CHECKPOINT_VERSION = 1;
/// One JSON document (format "checkpoint"), replaced as a whole. @throws Error OUTPUT
void write_checkpoint(const std::string& path, const DrapeCheckpoint& checkpoint);
/// @throws Error INPUT
DrapeCheckpoint read_checkpoint(const std::string& path);

} // namespace sloper::garment
