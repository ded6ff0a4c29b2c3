#include <garment/drape/layers.hpp>

#include <garment/levels/drape_levels.hpp>
#include <garment/simulate/audit.hpp>
#include <garment/simulate/session.hpp>
#include <sloper/base/error.hpp>
#include <sloper/collision/skin_cache.hpp>
#include <sloper/io/json.hpp>

#include <algorithm>
#include <cmath>

namespace sloper::garment {

namespace {

constexpr double MUCH_TUCKED =
    0.01; // of the particles: an outer garment is stretched by so much cloth below it
constexpr double LAYER_SLACK_M =
    0.001; // beyond thickness, by which an outer garment keeps off the skin while it is alone
constexpr double LARGEST_GAP_M = 0.02; // to the skin, of an outer garment while it is alone

/// One run of garments over each other: each alone, then all together.
class LayeredDrape {
public:
  /// @param at  where it stands   @param from  the checkpoint that its present drape goes on from,
  /// or null
  LayeredDrape(LayersProgress& at, const DrapeCheckpoint* from, const body::Body* body,
               Reporter& reporter, const Checkpoints& checkpoints, const FollowedMotion& motion)
      : m_at(at), m_from(from), m_body(body), m_reporter(reporter), m_checkpoints(checkpoints),
        m_motion(motion) {
    if (!body || body->skin.triangles.empty())
      throw input_error("drape.no-body"_id, "", "layers", "layer order needs a body",
                        "give --body body.json");
    m_checkpoints.layers = &at;
  }

  DrapeReport run() {
    for (; m_at.alone < m_at.garments.size(); ++m_at.alone) {
      const std::optional<DrapeReport> ended = drape_alone(m_at.alone);
      if (ended)
        return *ended;
    }
    return drape_together();
  }

private:
  /// One drape, or what a checkpoint left of it.
  DrapeReport drape_one(Garment& garment, const DrapeSettings& settings, const BodyMoves* moves,
                        const StartFacts& start) {
    const SessionInputs inputs{.garment = garment,
                               .body = m_body,
                               .moves = moves,
                               .on_frame = m_motion.on_frame,
                               .request = {.checkpoints = m_checkpoints, .start = start}};
    if (!m_from) {
      if (settings.levels > 1 && garment.particle_of.empty())
        return drape_through_levels(garment, m_body, settings, m_reporter, inputs.request);
      return DrapeSession(inputs, settings, m_reporter).run();
    }
    const DrapeCheckpoint& from = *m_from;
    m_from = nullptr;
    if (from.levels)
      return resume_through_levels(from, garment, m_body, m_reporter, m_checkpoints);
    return DrapeSession(inputs, from, m_reporter).run();
  }

  /// @return the report of a drape that was ended before its end: then all ends
  std::optional<DrapeReport> drape_alone(std::size_t k) {
    if (!m_from && !m_at.garments[k].particle_of.empty())
      return std::nullopt;
    DrapeSettings alone = m_at.settings;
    const double gap = m_at.settings.contact_gap_m +
                       static_cast<double>(k) * (m_at.settings.self_thickness_m + LAYER_SLACK_M);
    alone.contact_gap_m = std::min(LARGEST_GAP_M, gap);
    DrapeReport report = drape_one(m_at.garments[k], alone, nullptr, {});
    m_at.alone_s += report.wall_s;
    for (const std::string& r : report.repairs)
      m_at.repairs.push_back(layer_prefix(k) + "alone: " + r);
    const bool ended = report.stop_reason == StopReason::TIME_LIMIT ||
                       report.stop_reason == StopReason::INTERRUPTED;
    return ended ? std::optional(std::move(report)) : std::nullopt;
  }

  DrapeReport drape_together() {
    collision::BodyCollider collider =
        collision::make_collider(m_body->skin, m_body->skin_cache.get());
    Garment merged;
    StartFacts start;
    if (!m_from) {
      const LayerOrder order =
          order_layers(m_at.garments, collider, m_at.settings.self_thickness_m);
      note(order);
      merged = merge_layers(m_at.garments);
      start.relax_first = static_cast<double>(order.tucked) >
                          MUCH_TUCKED * static_cast<double>(merged.position.size());
    }
    DrapeReport report = drape_one(merged, m_at.settings, m_motion.moves, start);
    split_layers(merged, m_at.garments);
    report.repairs.insert(report.repairs.begin(), m_at.repairs.begin(), m_at.repairs.end());
    report.phases.insert(report.phases.begin(), {"garments alone", m_at.alone_s});
    report.wall_s += m_at.alone_s;
    const std::size_t frames =
        m_motion.moves ? report.quality["motion"]["frames"].get<std::size_t>() : 0;
    if (frames > 0)
      collider.set_positions(m_motion.moves->skin(frames - 1));
    report.quality["layers"] = layers_json(collider);
    return report;
  }

  void note(const LayerOrder& order) {
    if (order.tucked == 0)
      return;
    m_at.repairs.push_back("layers: " + std::to_string(order.tucked) +
                           " inner particles lay beyond an outer garment and were tucked in, by " +
                           std::to_string(std::lround(1000 * order.farthest_m)) + " mm at most; " +
                           std::to_string(order.crossed) + " crossings of layers, " +
                           std::to_string(order.remain) + " remained");
  }

  io::Json layers_json(const collision::BodyCollider& collider) const {
    const std::vector<std::size_t> wrong = order_violations(m_at.garments, collider);
    io::Json layers = io::Json::array();
    for (std::size_t k = 0; k < m_at.garments.size(); ++k) {
      const Garment& garment = m_at.garments[k];
      const Audit a = audit(garment, &collider);
      layers.push_back({{"garment", garment.panels.name},
                        {"particles", garment.position.size()},
                        {"strain_p99", a.strain_p99},
                        {"faces_through_body", a.through.size()},
                        {"vertices_inside_body", a.inside.size()},
                        {"self_intersections", a.self.size()},
                        {"order_violations", wrong[k]}});
    }
    return layers;
  }

  LayersProgress& m_at;
  const DrapeCheckpoint* m_from;
  const body::Body* m_body;
  Reporter& m_reporter;
  Checkpoints m_checkpoints;
  const FollowedMotion& m_motion;
};

} // namespace

DrapeReport drape_layers(std::vector<Garment>& garments, const body::Body* body,
                         const DrapeSettings& settings, Reporter& reporter,
                         const Checkpoints& checkpoints, const FollowedMotion& motion) {
  LayersProgress at{settings, garments, 0, {}, 0};
  Checkpoints taken = checkpoints;
  if (motion.moves && !taken.motion)
    taken.motion = motion.moves->input(); // while one is alone too
  DrapeReport report = LayeredDrape(at, nullptr, body, reporter, taken, motion).run();
  garments = std::move(at.garments);
  return report;
}

DrapeReport resume_layers(const DrapeCheckpoint& checkpoint, std::vector<Garment>& garments,
                          const body::Body* body, Reporter& reporter,
                          const Checkpoints& checkpoints, const FollowedMotion& motion) {
  if (!checkpoint.layers)
    throw input_error("checkpoint.other-run"_id, checkpoint.file, "",
                      "is of a run without garments over each other");
  checkpoint.check_moves(motion.moves);
  LayersProgress at = *checkpoint.layers;
  Checkpoints taken = checkpoints;
  taken.renew = true;
  taken.every_steps = checkpoint.every_steps;
  taken.motion = checkpoint.motion;
  DrapeReport report = LayeredDrape(at, &checkpoint, body, reporter, taken, motion).run();
  garments = std::move(at.garments);
  return report;
}

} // namespace sloper::garment
