#include <base/version.hpp>
#include <garment/bind.hpp>
#include <garment/drape_job.hpp>
#include <garment/follow.hpp>
#include <garment/frame_writer.hpp>
#include <garment/layers.hpp>
#include <garment/motion.hpp>
#include <io/json.hpp>
#include <io/line_follower.hpp>

namespace sloper::garment {

namespace {

DrapeReport drape_over(Garment& garment, std::vector<Garment>& under, const body::Body* body, const DrapeSettings& settings, Reporter& reporter) {
  under.push_back(std::move(garment));
  DrapeReport report = drape_layers(under, body, settings, reporter);
  garment = std::move(under.back());
  under.pop_back();
  return report;
}

DrapeReport drape_with_motion(const DrapeJob& job, Garment& garment, const body::Body& body, const DrapeSettings& settings, std::ostream& stream,
                              Reporter& reporter) {
  const BodyMoves moves = read_moves(body, job.motion, 1 / job.motion_fps);
  FrameWriter write(job.frames, "frame of " + generator_stamp(job.tool), stream);
  DrapeReport report = drape_in_motion(
      garment, body, moves, settings, [&](const MotionFrame& f, const Garment& g) { write(f, g); }, reporter);
  garment.body_sha256.clear(); // it hangs on the last skin
  if (moves.end) bind_garment(garment, *moves.end);
  else garment.bind = {};
  return report;
}

DrapeOutcome follow_edits(const DrapeJob& job, Garment& garment, const body::Body* body, const DrapeSettings& settings, std::ostream& stream,
                          Reporter& reporter) {
  io::LineFollower lines(job.follow);
  FrameWriter write(job.frames, "frame of " + generator_stamp(job.tool), stream);
  const FollowSession session{[&](int wait_ms) { return lines.next(wait_ms); }, [&] { return lines.ended(); },
                              [&](const FollowFrame& f, const Garment& g) { write(f, g); }};
  FollowReport report = follow(garment, body, settings, session, reporter);
  if (!job.edit_log.empty()) io::write_json(job.edit_log, report.log);
  io::Json document = follow_report_json(report, job.tool);
  return {std::move(report.drape), std::move(document), report.refused.size()};
}

DrapeOutcome drape_towards(const DrapeJob& job, Garment& garment, const body::Body* body, Reporter& reporter) {
  AccuracyReport report = drape_to_goal(garment, body, *job.goal, job.adjust, reporter);
  io::Json document = report_json(report.drape, job.tool);
  document["accuracy"] = report.achieved;
  return {std::move(report.drape), std::move(document), 0};
}

} // namespace

DrapeOutcome do_drape(const DrapeJob& job, Garment& garment, std::vector<Garment>& under, const body::Body* body, const DrapeSettings& settings,
                      std::ostream& stream, Reporter& reporter) {
  if (under.empty() && job.goal) return drape_towards(job, garment, body, reporter);
  if (under.empty() && !job.follow.empty()) return follow_edits(job, garment, body, settings, stream, reporter);
  DrapeReport report = !under.empty()        ? drape_over(garment, under, body, settings, reporter)
                       : !job.motion.empty() ? drape_with_motion(job, garment, *body, settings, stream, reporter)
                       : job.untangle_only   ? untangle_only(garment, body, settings, reporter)
                                             : drape(garment, body, settings, reporter, {}, job.checkpoints);
  io::Json document = report_json(report, job.tool);
  return {std::move(report), std::move(document), 0};
}

} // namespace sloper::garment
