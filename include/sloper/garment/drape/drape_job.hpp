#pragma once
/// What one run of drape does with a garment: come to rest, to a goal, under other garments, with
/// edits or with a body that moves.
#include <sloper/garment/drape/accuracy.hpp>
#include <sloper/garment/drape/drape.hpp>
#include <sloper/garment/simulate/checkpoint.hpp>

#include <functional>
#include <iosfwd>
#include <optional>
#include <string>

namespace sloper::garment {

/// One of these ways; all left as they are: a plain drape.
struct DrapeJob {
  std::string tool;                 ///< the program's name, for the report and the frames
  std::optional<AccuracyGoal> goal; ///< climb the presets until it is met
  std::function<void(DrapeSettings&)>
      adjust;             ///< with `goal`: sets the knobs that stay, in each preset
  std::string motion;     ///< file of a BVH motion, or the first of a sequence of skins
  double motion_fps = 30; ///< 1/s
  bool untangle_only = false;
  std::string follow; ///< file of edits, one a line; "-": standard input
  std::string frames; ///< with `motion` or `follow`: a folder, "-" for the stream, empty for none;
                      ///< with garments under it they are in each
  std::string edit_log;    ///< with `follow`: where the edits taken are written
  Checkpoints checkpoints; ///< of a plain drape, one in motion, or one with garments under it
};

struct DrapeOutcome {
  DrapeReport report;
  io::Json document;             ///< the report as a document, without inputs and hashes
  std::size_t refused_lines = 0; ///< of `follow`, that were no edits
};

/// Does the job. The motion leaves the garment bound to the last body where that is known, else to
/// none.
/// @param garment  in: placed panels or a sewn garment; out: the state reached
/// @param under    garments that lie below it, from the skin outwards; they come to rest together,
/// and move together where `job` has a motion
/// @param body     nullptr for none; needed by `motion` and by garments `under` it
/// @param stream   where frames named "-" go   @throws Error as drape(), follow(), read_moves()
DrapeOutcome do_drape(const DrapeJob& job, Garment& garment, std::vector<Garment>& under,
                      const body::Body* body, const DrapeSettings& settings, std::ostream& stream,
                      Reporter& reporter);

/// Goes on from a checkpoint of do_drape() to the same bytes. What the garments are, and all
/// settings, are the checkpoint's.
/// @param job      its tool, motion, frames and checkpoints.file; `motion` is given where the
/// checkpoint is of one, and only there. Frames that the
///                 checkpoint has passed stay as they are in the folder; the stream gets those
///                 after it.
/// @param garment  in: body_sha256 of the body, or empty to trust the caller; out: the state
/// reached
/// @param under    out: the garments that lie below it   @param body  the one that the run began
/// with, or nullptr where there was none
/// @throws Error INPUT for another body or another motion, which are told from the first by their
/// content
DrapeOutcome resume_job(const DrapeJob& job, const DrapeCheckpoint& checkpoint, Garment& garment,
                        std::vector<Garment>& under, const body::Body* body, std::ostream& stream,
                        Reporter& reporter);

} // namespace sloper::garment
