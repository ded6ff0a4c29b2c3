#pragma once
/// Optional inputs of a drape besides the garment, the body and the settings.
#include <optional>
#include <string>

namespace sloper::garment {

/// Bounds beyond which a garment that is not yet at rest will not fit; 0: no bound.
struct FitBounds {
  double slip_m = 0; ///< half of the particles have sunk farther than this since the start
  /// 99th percentile of strain along the threads (cloth_strain.hpp) that the extrapolated
  /// strain must not exceed.
  double strain_p99 = 0;
  /// The garment is tight at some girth. With ease all around, the decay of strain is
  /// extrapolated twice as far.
  bool tight = true;
};

/// Identity of the motion that a drape takes part in, for a run that resumes it.
struct MotionInput {
  std::string sha256; ///< motion_sha256() of its file; empty: not known, and not checked
  double fps = 0;     ///< 1/s, as it was asked for
};

struct LayersProgress; ///< checkpoint.hpp
struct LevelsProgress; ///< checkpoint.hpp

/// Where a drape saves its state now and then, so that it can be resumed after it was
/// killed.
struct Checkpoints {
  std::string file;      ///< replaced as a whole each time; empty: none is written
  int every_steps = 100; ///< solver steps between two; substeps in a motion
  /// Rebuild the solver at the same steps without writing a file: the result is that of a
  /// run with a file, to the bit.
  bool renew = false;
  /// Of a drape in motion; drape_in_motion() and drape_layers() fill it in where it is
  /// not given.
  std::optional<MotionInput> motion = {};
  const LayersProgress* layers = nullptr; ///< set by drape_layers(): of the drapes around this one
  /// Set by drape_through_levels(): of the drapes before this one.
  const LevelsProgress* levels = nullptr;
};

/// Of which limbs the ends of a garment are held.
enum class LimbEnds { NONE, SLEEVES, SLEEVES_AND_LEGS };

/// Facts about the garment's start that the caller knows and no drape can see.
struct StartFacts {
  /// What is longer than the limbs in it and has its ends at wrists or ankles (retarget()): they
  /// are held there until the cloth above them has found its folds (sleeve_ends.hpp).
  LimbEnds hold_ends = LimbEnds::NONE;
  /// The cloth is strained by how it was put there, by tucking one layer below another
  /// (drape_layers()): it first relaxes free of weight and friction, which would keep that strain.
  bool relax_first = false;
  /// The cloth comes from a coarser mesh, around the body and at most just in it
  /// (drape_through_levels()): the body is never drawn in, which would undo how the cloth hangs.
  /// What cannot be moved out of the skin at the start is left to contact.
  bool around_body = false;
};

/// Optional inputs of a drape, besides garment, body and settings.
struct DrapeRequest {
  /// End the drape, with the reason in DrapeReport::misfit, once the garment is beyond
  /// them.
  FitBounds bounds = {};
  /// Where and how often the state is saved. The solver is rebuilt at each checkpoint, so
  /// the result differs from that of a drape without, at the same accuracy.
  Checkpoints checkpoints = {};
  /// Facts of the start that the drape cannot see.
  StartFacts start = {};
  /// Ends as soon as nothing crosses body or cloth, at any speed of the cloth: for a
  /// state that was brought to rest on a coarser mesh.
  bool only_clear = false;
  /// Continues from cloth carried from a coarser mesh (drape_through_levels()): solves are
  /// more exact and inertia starts later, because both make drapes differ whose starts
  /// differ by a micrometre.
  bool carried = false;
  /// Audits the end state exactly. Off: only where it does not come to rest, because
  /// another drape follows.
  bool audit = true;
};

} // namespace sloper::garment
