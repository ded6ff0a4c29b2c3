#pragma once
/// One run of drape(1) on a garment: to rest, to a goal of accuracy, over other garments,
/// with live edits, or with a body that moves.
#include <sloper/garment/drape/accuracy.hpp>
#include <sloper/garment/drape/drape.hpp>
#include <sloper/garment/simulate/checkpoint.hpp>

#include <functional>
#include <iosfwd>
#include <optional>
#include <string>

namespace sloper::garment {

/// Which of these to do; with all members at their defaults it is a plain drape.
struct DrapeJob {
  std::string tool;                 ///< the program's name, for the report and the frames
  std::optional<AccuracyGoal> goal; ///< run preset after preset until it is met
  /// With `goal`: sets the knobs that stay, in each preset.
  std::function<void(DrapeSettings&)> adjust;
  std::string motion;         ///< file of a BVH motion, or the first of a sequence of skins
  double motion_fps = 30;     ///< 1/s
  bool untangle_only = false; ///< untangle_only() in place of a drape
  std::string follow;         ///< file of edits, one a line; "-": standard input
  /// With `motion` or `follow`: folder for the frames, "-" for the stream, empty for
  /// none. Frames hold the garments under it too.
  std::string frames;
  std::string edit_log;    ///< with `follow`: where the edits taken are written
  Checkpoints checkpoints; ///< of a plain drape, one in motion, or one with garments under it
};

/// The garments of one drape; those who own them keep them.
struct Outfit {
  Garment& garment;            ///< the outermost, which the drape is about
  std::vector<Garment>& under; ///< those that lie below it, from the skin outwards
};

/// What do_drape() leaves beside the garments.
struct DrapeOutcome {
  DrapeReport report;            ///< of the garment itself
  io::Json document;             ///< the report as a document, without inputs and hashes
  std::size_t refused_lines = 0; ///< lines of `follow` that were not edits of the pattern
};

/// Does the job. After a motion the garment is bound to the last body where that is
/// known, else to none.
/// @param outfit  its garment in: placed panels or sewn; out: the state reached. Garments
/// under it come to rest together with it, and move with it where `job` has a motion
/// @param body  nullptr for none; needed by `motion` and by garments under the outermost
/// @param settings  as for drape()
/// @param stream  for frames named "-"
/// @throws Error as drape(), and INPUT for a motion or a file of edits that cannot be
/// read
DrapeOutcome do_drape(const DrapeJob& job, const Outfit& outfit, const body::Body* body,
                      const DrapeSettings& settings, std::ostream& stream, Reporter& reporter);

/// Continues a checkpoint of do_drape() to the same bytes. The garments and all settings
/// are the checkpoint's.
/// @param job  its tool, motion, frames and checkpoints.file; `motion` is given where the
/// checkpoint is of one, and only there. Frames that the checkpoint has passed stay as
/// they are in the folder; the stream gets those after it.
/// @param outfit  its garment in: body_sha256 of the body, or empty to trust the caller;
/// out: the state reached, and the garments under it
/// @param body  the one that the run began with, or nullptr where there was none
/// @throws Error INPUT for another body or another motion, compared by content
DrapeOutcome resume_job(const DrapeJob& job, const DrapeCheckpoint& checkpoint,
                        const Outfit& outfit, const body::Body* body, std::ostream& stream,
                        Reporter& reporter);

} // namespace sloper::garment
