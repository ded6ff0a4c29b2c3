#pragma once
/// All that a drape needs to continue between two of its steps: the state of each part of
/// a session, with the garment.
///
/// What is not here is rebuilt: the solver's matrix and hierarchy, near pairs, bounding
/// boxes. They lag behind the positions for some steps, so a drape rebuilds them wherever
/// a checkpoint is due, as does the run that resumes; from there both make the same
/// steps, bit by bit. Test: tests/garment/simulate/test_checkpoint.cpp
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

/// State of each part of a session. Positions are the garment's.
struct DrapeState {
  DrapePhase phase = DrapePhase::START; ///< that the session is in
  bool disturbed = false;               ///< SimContext::disturbed
  /// One member for each part that has a state.
  CollisionBody::State body;
  StepController::State stepper;            ///< last step, counts
  PenetrationResolver::State resolver;      ///< counts
  TemporarySupports::State supports;        ///< sleeve ends, tangles
  cloth::BodyContactEffect::Memory contact; ///< friction anchors
  SewPhase::State sew;                      ///< of the phases
  InflatePhase::State inflate;              ///< skin lag
  SettlePhase::State settle;                ///< step size, calm steps, probe
  MovePhase::State move;                    ///< frame, counts
  FitMonitor::State fit;                    ///< strains seen

  int step() const; ///< next step of the present phase
};

/// Progress of a drape of garments over each other (layers.hpp) between its single
/// drapes.
struct LayersProgress {
  DrapeSettings settings;        ///< of the whole; a garment that is draped alone has others
  std::vector<Garment> garments; ///< from the skin outwards
  std::size_t alone = 0;         ///< which is draped alone at present; their number: all together
  std::vector<std::string> repairs; ///< so far
  double alone_s = 0;               ///< wall seconds of the drapes alone that are done
};

/// Progress of a drape through levels of mesh (levels/drape_levels.hpp) between its
/// single drapes. The places of the panels are the garment's.
struct LevelsProgress {
  DrapeSettings settings; ///< of the whole; those of intermediate presets differ
  /// Preset that the present drape brings to rest; empty: all are done, and the body
  /// moves.
  std::string rung;
  bool on_given_mesh = false; ///< the coarse mesh failed: sewn on the given one
  /// What crossed at first on the given mesh was sprung apart (sew_on_coarse_mesh()).
  bool sprung = false;
  DrapeReport before; ///< steps, seconds, effects, phases and repairs until then
};

/// Contents of a checkpoint file: a drape interrupted. The report is that of the run so
/// far: steps, seconds, effects, phases, repairs, settings.
struct DrapeCheckpoint {
  Garment garment;                      ///< with its positions
  DrapeState state;                     ///< of the session
  DrapeReport report;                   ///< until now
  int every_steps = 0;                  ///< between two checkpoints
  FitBounds bounds;                     ///< that end the drape
  bool has_body = false;                ///< the run has a body
  std::optional<MotionInput> motion;    ///< of a drape in motion
  std::optional<LayersProgress> layers; ///< garment, state and report are of one of its drapes
  /// As `layers`, for a drape through levels of mesh.
  std::optional<LevelsProgress> levels;
  std::string file; ///< where it was read, for messages

  /// @param body  that is given now, or null   @param body_sha256  of its skin; empty: trusted
  /// @throws Error INPUT where the run began on another
  void check_body(const body::Body* body, const std::string& body_sha256) const;
  /// @param moves  given now, or null   @throws Error INPUT for one where the run began without,
  /// none where it began with one, and one too short
  void check_moves(const BodyMoves* moves) const;
};

/// Version of the document. 1 has no motion and layers; 2 no bounds of a fit.
inline constexpr int CHECKPOINT_VERSION = 3;
/// One JSON document (format "checkpoint"), replaced as a whole. @throws Error OUTPUT
void write_checkpoint(const std::string& path, const DrapeCheckpoint& checkpoint);
/// Whether this JSON file is a checkpoint, by its envelope.
/// @throws Error INPUT for a file that is not JSON
bool is_checkpoint(const std::string& path);
/// Reads a checkpoint file.
/// @throws Error INPUT with its place
DrapeCheckpoint read_checkpoint(const std::string& path);

} // namespace sloper::garment
