#pragma once
/// A draped garment that follows edits of its pattern as they come: rest lengths change in place,
/// the cloth goes on from where it hangs. Only an edit that asks for another mesh makes one, and
/// carries the draped state across.
#include <sloper/garment/drape/drape.hpp>

#include <functional>
#include <optional>

namespace sloper::garment {

/// The frame that answers an edit is a state before rest, so its solve has a fixed budget:
/// conjugate gradients go down in energy from the first iteration on, and the frames after it go on
/// from there. A budget of iterations, not of time: same lines, same bytes.
inline constexpr int FOLLOW_ANSWER_ITERATIONS = 12;

/// One step of the cloth that follows.
struct FollowFrame {
  int number = 0;         ///< from 1
  int edits = 0;          ///< taken so far
  double latency_ms = -1; ///< from the arrival of the edit to this frame's positions; negative
                          ///< where no edit came since the last
  double cpu_ms =
      0; ///< of all threads, over that time: what a machine with nothing else to do needs
  bool remeshed = false; ///< particles are not those of the frame before
  double speed_m_s = 0;  ///< of the fastest particle
  int cg_iterations = 0; ///< of the step; at most FOLLOW_ANSWER_ITERATIONS where it answers an
                         ///< edit, 0 where that shows another mesh
  bool at_rest = false;
};

/// Where edits come from, and who wants to see frames.
struct FollowSession {
  /// The next line, waiting at most so many milliseconds.
  std::function<std::optional<std::string>(int)> next_line;
  std::function<bool()> ended;                                      ///< no more lines
  std::function<void(const FollowFrame&, const Garment&)> on_frame; ///< may be empty
};

/// What a live session came to.
struct FollowReport {
  DrapeReport drape; ///< of the state at the end, at rest
  int edits = 0, remeshed = 0, frames = 0;
  std::vector<std::string>
      refused; ///< "line 3: ...": lines that are no edits of this pattern; they changed nothing
  std::vector<double> latency_ms, cpu_ms; ///< of each edit
  io::Json log; ///< the edits taken, as a document that pattern-mesh --edits replays
};

/// Lines: a head {"format": "edits", "version": 1, "length_unit": "cm"} (with "edits" too where
/// some are to be taken at once), then one edit a line, as pattern::apply_edits() knows them;
/// {"edit": "end"} ends the session where nothing else does. Blank lines are skipped. What a
/// session ends in is a cold drape of the edited pattern, to the bytes of pattern-mesh --edits and
/// drape with the same settings: what cloth comes to rest in remembers the way that it came (by
/// friction and folds: millimetres), and only that way is in no file.
/// {"edit": "end", "finish": "warm"} leaves the cloth in its own rest; "finish": "replay" goes back
/// to where the session began and makes all edits at once: the same bytes for the same last
/// pattern, whatever came between and however fast. Without a body the panels cannot be placed
/// anew, and a session ends in a replay; without an edit the garment stays as it hangs. After each
/// edit the cloth makes at least one step before the next line is looked at; when no line comes, it
/// goes on to rest, for a second in steps shorter than an answer. An edit that asks for another
/// mesh is answered by that mesh where the cloth hangs, and the step is the frame after it.
/// @param garment  sewn, with the pattern it was meshed from (panels.source); left at rest, with
/// that pattern edited
/// @throws Error INPUT for a garment without its pattern, or whose panels are no longer its
/// pattern's
FollowReport follow(Garment& garment, const body::Body* body, const DrapeSettings& settings,
                    const FollowSession& session, Reporter& reporter);

io::Json follow_report_json(const FollowReport& report, const std::string& tool);

} // namespace sloper::garment
