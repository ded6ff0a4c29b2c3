#include <garment/drape/follow.hpp>
#include <garment/drape/frame_writer.hpp>
#include <garment/drape/layers.hpp>
#include <garment/drape/motion.hpp>
#include <sloper/base/error.hpp>
#include <sloper/base/version.hpp>
#include <sloper/garment/bind/bind.hpp>
#include <sloper/garment/drape/drape_job.hpp>
#include <sloper/garment/simulate/checkpoint.hpp>
#include <sloper/io/files.hpp>
#include <sloper/io/json.hpp>
#include <sloper/io/line_follower.hpp>

#include <filesystem>

namespace sloper::garment {

namespace {

/// Parts the outermost garment from those under it.
void take_off(const Outfit& outfit) {
  outfit.garment = std::move(outfit.under.back());
  outfit.under.pop_back();
}

DrapeReport drape_over(const Outfit& outfit, const body::Body* body, const DrapeSettings& settings,
                       Reporter& reporter, const Checkpoints& checkpoints,
                       const FollowedMotion& motion = {}) {
  outfit.under.push_back(std::move(outfit.garment));
  DrapeReport report = drape_layers(outfit.under, body, settings, reporter, checkpoints, motion);
  take_off(outfit);
  return report;
}

DrapeReport resume_over(const DrapeCheckpoint& c, const Outfit& outfit, const body::Body* body,
                        Reporter& reporter, const Checkpoints& checkpoints,
                        const FollowedMotion& motion = {}) {
  DrapeReport report = resume_layers(c, outfit.under, body, reporter, checkpoints, motion);
  take_off(outfit);
  return report;
}

/// The motion of a job, and where its frames go.
class MovingJob {
public:
  /// @param fps  frames a second of the motion   @param done  frames that are written already
  MovingJob(const DrapeJob& job, const body::Body& body, double fps, std::size_t done,
            std::ostream& stream)
      : moves(read_moves(body, job.motion, 1 / fps)),
        m_write(job.frames, "frame of " + generator_stamp(job.tool), stream, done) {}

  /// The motion, and what writes a frame when it is done. This outlives it.
  FollowedMotion followed() {
    return {.moves = &moves, .on_frame = [this](const MotionFrame& frame, const Garment& garment) {
              m_write(frame, garment);
            }};
  }
  /// The garments hang on the last skin from now on.
  void leave(const Outfit& outfit) const {
    leave(outfit.garment);
    for (Garment& garment : outfit.under)
      leave(garment);
  }

  const BodyMoves moves;

private:
  void leave(Garment& garment) const {
    garment.body_sha256.clear();
    if (moves.end)
      bind_garment(garment, *moves.end);
    else
      garment.bind = {};
  }

  FrameWriter m_write;
};

DrapeReport drape_with_motion(const DrapeJob& job, const Outfit& outfit, const body::Body& body,
                              const DrapeSettings& settings, std::ostream& stream,
                              Reporter& reporter) {
  Checkpoints checkpoints = job.checkpoints;
  if (!checkpoints.file.empty())
    checkpoints.motion = {motion_sha256(job.motion), job.motion_fps};
  MovingJob moving(job, body, job.motion_fps, 0, stream);
  const FollowedMotion motion = moving.followed();
  DrapeReport report = outfit.under.empty()
                           ? drape_in_motion(outfit.garment, body, settings, motion, reporter,
                                             {.checkpoints = checkpoints})
                           : drape_over(outfit, &body, settings, reporter, checkpoints, motion);
  moving.leave(outfit);
  return report;
}

DrapeReport resume_with_motion(const DrapeJob& job, const DrapeCheckpoint& c, const Outfit& outfit,
                               const body::Body& body, std::ostream& stream, Reporter& reporter) {
  if (job.motion.empty())
    throw input_error("checkpoint.other-run"_id, c.file, "",
                      "this drape began with a motion of the body",
                      "give the same --motion as before");
  if (!c.motion->sha256.empty() && motion_sha256(job.motion) != c.motion->sha256)
    throw input_error("checkpoint.other-run"_id, job.motion, "",
                      "is not the motion with which this drape began",
                      "give the same --motion as before");
  MovingJob moving(job, body, c.motion->fps, c.state.move.frame, stream);
  const FollowedMotion motion = moving.followed();
  DrapeReport report =
      c.layers ? resume_over(c, outfit, &body, reporter, job.checkpoints, motion)
               : resume_in_motion(c, outfit.garment, body, motion, reporter, job.checkpoints);
  moving.leave(outfit);
  return report;
}

/// A document of edits is whole, and nothing more comes after it: followed as lines, it would be
/// waited on without end.
void refuse_document(const std::string& path) {
  if (path == "-" || !std::filesystem::is_regular_file(path))
    return; // a stream must not be read twice
  const std::string text = io::read_file(path);
  if (!io::Json::accept(text))
    return; // lines, or none yet
  const io::Json json = io::Json::parse(text);
  if (json.is_object() && json.contains("edits") && !json["edits"].empty())
    throw input_error(
        "edit.bad-line"_id, path, "/edits",
        "is a document of edits, where --follow wants lines as they come",
        R"(write {"format": "edits", "version": 1, "length_unit": "cm"} on the first line, then one edit a line, at last {"edit": "end"}; )"
        "or give the document to pattern-mesh --edits");
}

DrapeOutcome follow_edits(const DrapeJob& job, Garment& garment, const body::Body* body,
                          const DrapeSettings& settings, std::ostream& stream, Reporter& reporter) {
  refuse_document(job.follow);
  io::LineFollower lines(job.follow);
  FrameWriter write(job.frames, "frame of " + generator_stamp(job.tool), stream);
  const FollowSession session{[&](int wait_ms) { return lines.next(wait_ms); },
                              [&] { return lines.ended(); },
                              [&](const FollowFrame& f, const Garment& g) { write(f, g); }};
  FollowReport report = follow(garment, body, settings, session, reporter);
  if (!job.edit_log.empty())
    io::write_json(job.edit_log, report.log);
  io::Json document = follow_report_json(report, job.tool);
  return {std::move(report.drape), std::move(document), report.refused.size()};
}

DrapeOutcome drape_towards(const DrapeJob& job, Garment& garment, const body::Body* body,
                           Reporter& reporter) {
  AccuracyReport report = drape_to_goal(garment, body, *job.goal, job.adjust, reporter);
  io::Json document = report_json(report.drape, job.tool);
  document["accuracy"] = report.achieved;
  return {std::move(report.drape), std::move(document), 0};
}

} // namespace

DrapeOutcome do_drape(const DrapeJob& job, const Outfit& outfit, const body::Body* body,
                      const DrapeSettings& settings, std::ostream& stream, Reporter& reporter) {
  Garment& garment = outfit.garment;
  const bool alone = outfit.under.empty();
  if (alone && job.goal)
    return drape_towards(job, garment, body, reporter);
  if (alone && !job.follow.empty())
    return follow_edits(job, garment, body, settings, stream, reporter);
  DrapeReport report = [&] {
    if (!job.motion.empty())
      return drape_with_motion(job, outfit, *body, settings, stream, reporter);
    if (!alone)
      return drape_over(outfit, body, settings, reporter, job.checkpoints);
    if (job.untangle_only)
      return untangle_only(garment, body, settings, reporter);
    return drape(garment, body, settings, reporter, {.checkpoints = job.checkpoints});
  }();
  io::Json document = report_json(report, job.tool);
  return {std::move(report), std::move(document), 0};
}

DrapeOutcome resume_job(const DrapeJob& job, const DrapeCheckpoint& c, const Outfit& outfit,
                        const body::Body* body, std::ostream& stream, Reporter& reporter) {
  c.check_body(body, outfit.garment.body_sha256);
  if (!c.motion && !job.motion.empty())
    throw input_error("checkpoint.other-run"_id, c.file, "", "this drape began without a motion",
                      "leave --motion out");
  DrapeReport report = [&] {
    if (c.motion)
      return resume_with_motion(job, c, outfit, *body, stream, reporter);
    if (c.layers)
      return resume_over(c, outfit, body, reporter, job.checkpoints);
    return resume_drape(c, outfit.garment, body, reporter, job.checkpoints);
  }();
  io::Json document = report_json(report, job.tool);
  return {std::move(report), std::move(document), 0};
}

} // namespace sloper::garment
