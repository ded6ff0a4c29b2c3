/// The drape that does nothing but draw crossing cloth apart.
#include <garment/simulate/audit.hpp>
#include <garment/simulate/session.hpp>
#include <sloper/base/error.hpp>
#include <sloper/garment/drape/drape.hpp>
#include <sloper/io/json.hpp>

#include <algorithm>

namespace sloper::garment {

namespace {

io::Json counts_json(const Garment& garment, const collision::BodyCollider* skin) {
  const Audit a = audit(garment, skin);
  return {{"faces_through_body", a.through.size()},
          {"vertices_inside_body", a.inside.size()},
          {"deepest_m", a.deepest_m},
          {"self_intersections", a.self.size()}};
}

bool is_clean(const io::Json& counts) {
  return counts["faces_through_body"] == 0 && counts["vertices_inside_body"] == 0 &&
         counts["self_intersections"] == 0;
}

/// Short moves first; where cloth lies deep in the body, the body is drawn in and the cloth makes
/// room as it comes back.
void resolve(DrapeSession& session, Garment& garment, Reporter& reporter) {
  int& rounds = session.telemetry().report.steps;
  const std::vector<Vec3> start = garment.position;
  std::size_t least = 0;
  {
    const PhaseTimer timer(session.telemetry(), "untangle");
    least = session.resolver().resolve_all(MAX_RESOLVE_ALL_ROUNDS, rounds);
  }
  if (least == 0 || !session.has_collider() || reporter.stop_requested())
    return;
  const std::vector<Vec3> shallow = garment.position;
  garment.position = start;
  session.push_apart(MAX_PUSH_STEPS);
  const std::size_t now = session.resolver().resolve_all(MAX_RESOLVE_ALL_ROUNDS,
                                                         rounds); // what the push leaves is shallow
  if (now >= least)
    garment.position = shallow;
}

} // namespace

DrapeReport untangle_only(Garment& garment, const body::Body* body, const DrapeSettings& settings,
                          Reporter& reporter) {
  if (garment.particle_of.empty())
    throw input_error("garment.not-sewn"_id, "", "", "the garment is not sewn yet",
                      "drape it first");
  DrapeSession session({.garment = garment, .body = body}, settings, reporter);
  session.choose_contact_alone();
  const io::Json before = counts_json(garment, session.full_skin());
  const std::vector<Vec3> start = garment.position;
  const bool was_at_rest = garment.converged;
  resolve(session, garment, reporter);
  double farthest = 0;
  std::size_t moved = 0;
  for (std::size_t i = 0; i < start.size(); ++i) {
    const double distance = (garment.position[i] - start[i]).norm();
    moved += distance > 0;
    farthest = std::max(farthest, distance);
  }
  DrapeReport report = session.finish();
  const io::Json after = counts_json(garment, session.full_skin());
  report.converged = is_clean(after);
  if (!report.converged)
    report.stop_reason = StopReason::CROSSINGS_REMAIN;
  else
    report.stop_reason = moved == 0 ? StopReason::NOTHING_CROSSED : StopReason::NOTHING_CROSSES;
  garment.converged = was_at_rest && moved == 0;
  report.quality["untangled"] = {
      {"before", before}, {"after", after}, {"particles_moved", moved}, {"farthest_m", farthest}};
  report.wall_s = session.elapsed();

  std::string text;
  for (const auto& [when, counts] : {std::pair{"before", before}, std::pair{"after", after}})
    text += (text.empty() ? "" : "; ") + std::string(when) + ": " +
            counts["faces_through_body"].dump() + " faces through the body, " +
            counts["vertices_inside_body"].dump() + " vertices inside it, " +
            counts["self_intersections"].dump() + " self intersections";
  if (is_clean(before) && is_clean(after))
    reporter.info(text);
  else
    reporter.warning({"drape.crossings"_id, text});
  return report;
}

} // namespace sloper::garment
