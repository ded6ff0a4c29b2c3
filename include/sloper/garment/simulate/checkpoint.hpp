#pragma once
/// All that a drape needs to go on from the moment between two of its steps: what each part of a
/// session saves, with the garment.
///
/// What is not here can be made again from it: the solver's matrix and hierarchy, near pairs,
/// bounding boxes. They lag behind the positions for some steps, so a drape makes them anew
/// wherever a checkpoint is due, as the run that goes on from the checkpoint does; from there both
/// make the same steps, bit by bit. Test: tests/garment/simulate/test_checkpoint.cpp
#include <sloper/garment/simulate/phases/inflate.hpp>
#include <sloper/garment/simulate/phases/move.hpp>
#include <sloper/garment/simulate/phases/settle.hpp>
#include <sloper/garment/simulate/phases/sew.hpp>
#include <sloper/garment/simulate/report.hpp>
#include <sloper/garment/simulate/request.hpp>

#include <optional>
#include <string>
#include <vector>

namespace sloper::garment {

/// What each part of a session saves. Positions are the garment's.
struct DrapeState {
  DrapePhase phase = DrapePhase::START;
  bool disturbed = false; ///< SimContext::disturbed
  CollisionBody::State body;
  StepController::State stepper;
  PenetrationResolver::State resolver;
  TemporarySupports::State supports;
  cloth::BodyContactEffect::Memory contact;
  SewPhase::State sew;
  InflatePhase::State inflate;
  SettlePhase::State settle;
  MovePhase::State move;
  FitMonitor::State fit;

  int step() const; ///< of the phase: the next one
};

/// How far a drape of garments over each other (layers.hpp) has come between the drapes that it is
/// made of.
struct LayersProgress {
  DrapeSettings settings;        ///< of the whole; a garment that is draped alone has others
  std::vector<Garment> garments; ///< from the skin outwards
  std::size_t alone = 0;         ///< which is draped alone at present; their number: all together
  std::vector<std::string> repairs; ///< so far
  double alone_s = 0;               ///< wall seconds of the drapes alone that are done
};

/// How far a drape through levels of mesh (levels/drape_levels.hpp) has come between the drapes
/// that it is made of. Where the panels were placed is the garment's.
struct LevelsProgress {
  DrapeSettings settings; ///< of the whole; those of a preset on the way are others
  std::string rung; ///< the preset that the present drape brings to rest; empty: all are done, and
                    ///< the body moves
  bool on_given_mesh = false; ///< the coarse mesh did not do: sewn on the given one
  DrapeReport before;         ///< steps, seconds, effects, phases and repairs until then
};

/// A drape interrupted: what checkpoint files hold. The report has what it had come to: steps,
/// seconds, effects, phases, repairs, settings.
struct DrapeCheckpoint {
  Garment garment;
  DrapeState state;
  DrapeReport report;
  int every_steps = 0; ///< between two checkpoints
  FitBounds bounds;    ///< that end the drape
  bool has_body = false;
  std::optional<MotionInput> motion;    ///< of a drape in motion
  std::optional<LayersProgress> layers; ///< garment, state and report are of one of its drapes
  std::optional<LevelsProgress> levels; ///< likewise
  std::string file;                     ///< where it was read, for messages

  /// @param body  that is given now, or null   @param body_sha256  of its skin; empty: trusted
  /// @throws Error INPUT where the run began on another
  void check_body(const body::Body* body, const std::string& body_sha256) const;
  /// @param moves  given now, or null   @throws Error INPUT for one where the run began without,
  /// none where it began with one, and one too short
  void check_moves(const BodyMoves* moves) const;
};

inline constexpr int CHECKPOINT_VERSION =
    3; ///< 1: without motion and layers; 2: without the bounds of a fit
/// One JSON document (format "checkpoint"), replaced as a whole. @throws Error OUTPUT
void write_checkpoint(const std::string& path, const DrapeCheckpoint& checkpoint);
/// Whether this JSON file is one, by its envelope. @throws Error INPUT for what is no JSON
bool is_checkpoint(const std::string& path);
/// @throws Error INPUT
DrapeCheckpoint read_checkpoint(const std::string& path);

} // namespace sloper::garment
