#pragma once
/// What a drape may be given beside the garment, the body and the settings.
#include <optional>
#include <string>

namespace sloper::garment {

/// Where a garment that is not yet at rest stands when it is plain that it will not fit; 0: never.
struct FitBounds {
  double slip_m = 0; ///< half of the particles have sunk farther than this since the start
  double strain_p99 =
      0; ///< along the threads (cloth_strain.hpp), and by how it falls it will not come below
  bool tight = true; ///< the garment is tight at some girth; where it has ease all around, strain
                     ///< is waited for twice as long
};

/// What a checkpoint knows of the motion that the drape takes part in, for whoever gives it again.
struct MotionInput {
  std::string sha256; ///< motion_sha256() of its file; empty: not known, and not checked
  double fps = 0;     ///< 1/s, as it was asked for
};

struct LayersProgress; ///< checkpoint.hpp
struct LevelsProgress; ///< checkpoint.hpp

/// Where a drape notes its state now and then, so that it can go on from there after it was killed.
struct Checkpoints {
  std::string file; ///< replaced as a whole each time; empty: none is written
  int every_steps = 100;
  bool renew = false; ///< without a file too: what a run with a file does, to the bit
  std::optional<MotionInput> motion = {}; ///< of a drape in motion; drape_in_motion() and
                                          ///< drape_layers() fill it in where it is not given
  const LayersProgress* layers = nullptr; ///< set by drape_layers(): of the drapes around this one
  const LevelsProgress* levels =
      nullptr; ///< set by drape_through_levels(): of the drapes before this one
};

/// What the caller knows of the garment's start and no drape can see.
struct StartFacts {
  /// Sleeves are longer than the arms and their ends are at the wrists (retarget()): they are held
  /// there until the cloth above them has found its folds (sleeve_ends.hpp).
  bool hold_sleeve_ends = false;
  /// The cloth is strained by how it was put there, by tucking one layer below another
  /// (drape_layers()): it first relaxes free of weight and friction, which would keep that strain.
  bool relax_first = false;
  /// The cloth comes from a coarser mesh, around the body and at most just in it
  /// (drape_through_levels()): the body is never drawn in, which would undo how the cloth hangs.
  /// What cannot be moved out of the skin at the start is left to contact.
  bool around_body = false;
};

/// What a drape may be given beside the garment, the body and the settings.
struct DrapeRequest {
  FitBounds bounds = {}; ///< end the drape, with the reason in DrapeReport::misfit, once the
                         ///< garment is beyond them
  /// With a file: from one to the next the solver begins anew, so the result is another, as good,
  /// than without.
  Checkpoints checkpoints = {};
  StartFacts start = {};
  /// Ends as soon as nothing crosses body or cloth, however fast the cloth moves: for a state that
  /// was brought to rest on a coarser mesh.
  bool only_clear = false;
  /// Looks for what is unclean at the end. Off: only where it does not come to rest; another drape
  /// follows.
  bool audit = true;
};

} // namespace sloper::garment
