#include <garment/levels/coarse_start.hpp>
#include <garment/levels/drape_levels.hpp>
#include <garment/simulate/session.hpp>
#include <sloper/garment/scene/scene.hpp>
#include <sloper/garment/simulate/roll_line_states.hpp>

#include <algorithm>
#include <chrono>

namespace sloper::garment {

namespace {

constexpr const char* FIRST_RUNG = "draft";
constexpr const char* SPRUNG_APART =
    "cloth of the coarse mesh still crossed: carried again, stiff where it did";
const std::string ON_GIVEN_MESH = "draped on the given mesh alone: ";

bool is_clean(const DrapeReport& report) {
  return report.quality.value("faces_through_body", 0) == 0 &&
         report.quality.value("vertices_inside_body", 0) == 0 &&
         report.quality.value("self_intersections", 0) == 0;
}

/// The panels as they were placed, unsewn.
void take_apart(Garment& garment) {
  garment.particle_of.clear();
  garment.position.clear();
  garment.bind = {};
  garment.converged = false;
}

std::string rung_after(const std::string& rung) {
  const std::vector<std::string> names = accuracy_names();
  const auto at = std::find(names.begin(), names.end(), rung);
  return at + 1 < names.end() ? *(at + 1) : rung;
}

/// One drape through levels: what is done between its sessions, and what a checkpoint in one of
/// them needs to know.
class LevelsDrape {
public:
  /// @param at  where it stands   @param from  the checkpoint that its present session goes on
  /// from, or null
  LevelsDrape(Garment& garment, const body::Body* body, LevelsProgress at,
              const DrapeCheckpoint* from, Reporter& reporter, const DrapeRequest& request)
      : m_garment(garment), m_body(body), m_at(std::move(at)), m_from(from), m_reporter(reporter),
        m_request(request), m_wall_before(m_at.before.wall_s) {
    m_request.checkpoints.levels = &m_at;
  }

  DrapeReport run() {
    if (!m_from)
      start();
    DrapeReport report = climb();
    if (!ended(report) && crosses(report) && !m_at.sprung) {
      m_at.before = report;
      spring_apart();
      report = climb();
    }
    if (!ended(report)) {
      m_at.before = report;
      sew_on_given_mesh(why_not(report));
      report = climb();
    }
    if (report.stop_reason == StopReason::AT_REST && !m_at.on_given_mesh &&
        m_at.settings.accuracy == FIRST_RUNG)
      report.stop_reason = StopReason::AT_REST_COARSE;
    report.settings = m_at.settings;
    report.wall_s = elapsed();
    return report;
  }

private:
  double elapsed() const {
    return m_wall_before + std::chrono::duration<double>(Clock::now() - m_began).count();
  }

  void start() {
    m_at.rung = FIRST_RUNG;
    m_at.before.levels.meshes = 2;
    sew_on_coarse(CarriedCrossings::KEPT);
  }

  void sew_on_coarse(CarriedCrossings crossings) {
    const std::string why =
        sew_on_coarse_mesh(m_garment, *m_body, m_at.settings, crossings, m_reporter, m_at.before);
    if (!why.empty())
      sew_on_given_mesh(why);
  }

  /// Sews on the coarse mesh once more; what crossed when it was carried is sprung flat.
  void spring_apart() {
    m_reporter.info(SPRUNG_APART);
    m_at.before.repairs.push_back(SPRUNG_APART);
    take_apart(m_garment);
    m_at.sprung = true;
    m_at.rung = FIRST_RUNG;
    sew_on_coarse(CarriedCrossings::SPRUNG);
  }

  void sew_on_given_mesh(const std::string& why) {
    m_reporter.info(ON_GIVEN_MESH + why);
    m_at.before.repairs.push_back(ON_GIVEN_MESH + why);
    take_apart(m_garment);
    m_at.before.levels.meshes = 1;
    m_at.before.levels.why = why;
    m_at.on_given_mesh = true;
    m_at.rung = m_at.settings.accuracy;
  }

  /// Sessions from the present rung to the one that was asked for. @return what all came to
  DrapeReport climb() {
    for (;;) {
      DrapeReport report = run_session();
      add_earlier(m_at.before, report);
      report.levels = m_at.before.levels;
      if (is_last() || !report.converged || !standing().empty())
        return report; // what is not clear now seldom becomes so, nor does what stands fold
      report.wall_s = elapsed();
      m_at.before = std::move(report);
      m_at.rung = rung_after(m_at.rung);
    }
  }

  bool is_last() const { return m_at.rung == m_at.settings.accuracy; }

  DrapeReport run_session() {
    const bool first = m_at.rung == FIRST_RUNG && !m_at.on_given_mesh;
    DrapeRequest request = m_request;
    request.only_clear = first;
    request.carried = !m_at.on_given_mesh;
    request.start.around_body = first;
    request.audit = first || is_last();
    const SessionInputs inputs{.garment = m_garment, .body = m_body, .request = request};
    if (!m_from)
      return DrapeSession(inputs, settings_of_rung(), m_reporter).run();
    const DrapeCheckpoint& from = *m_from;
    m_from = nullptr;
    return DrapeSession(inputs, from, m_reporter).run();
  }

  /// Those of the preset; all knobs that presets leave alone are kept, and so are all of them on
  /// the last rung.
  DrapeSettings settings_of_rung() const {
    DrapeSettings settings = m_at.settings;
    if (!is_last()) {
      const DrapeSettings preset = preset_settings(m_at.rung);
      settings.cg_tolerance = preset.cg_tolerance;
      settings.settle_force_ratio = preset.settle_force_ratio;
      settings.settle_speed_m_s = preset.settle_speed_m_s;
      settings.accuracy = preset.accuracy;
    }
    if (settings.max_seconds > 0)
      settings.max_seconds = std::max(settings.max_seconds - elapsed(), 1e-6);
    return settings;
  }

  /// Whether this is the end, and the given mesh alone is not tried.
  bool ended(const DrapeReport& report) const {
    const bool interrupted = report.stop_reason == StopReason::INTERRUPTED ||
                             report.stop_reason == StopReason::TIME_LIMIT;
    return m_at.on_given_mesh || interrupted || report.misfit != Misfit::NONE ||
           (report.converged && is_clean(report) && standing().empty());
  }

  /// Whether cloth of the coarse mesh is calm, and its leaves lie as they ought to, but it is not
  /// clear.
  bool crosses(const DrapeReport& report) const {
    const bool calm = report.converged || report.stop_reason == StopReason::AT_REST_UNCLEAN;
    return calm && !is_clean(report) && standing().empty();
  }

  std::string standing() const { return standing_text(roll_line_states(m_garment)); }

  /// Why cloth of the coarse mesh is not kept.
  std::string why_not(const DrapeReport& report) const {
    const bool at_rest = report.converged || report.stop_reason == StopReason::AT_REST_UNCLEAN;
    if (!at_rest)
      return "cloth of the coarse mesh did not come to rest";
    const std::string stands = standing();
    return stands.empty() ? "cloth of the coarse mesh still crossed" : stands;
  }

  using Clock = std::chrono::steady_clock;
  Garment& m_garment;
  const body::Body* m_body;
  LevelsProgress m_at;
  const DrapeCheckpoint* m_from;
  Reporter& m_reporter;
  DrapeRequest m_request;
  double m_wall_before; // s, of the run before a checkpoint
  Clock::time_point m_began = Clock::now();
};

} // namespace

DrapeReport drape_through_levels(Garment& garment, const body::Body* body,
                                 const DrapeSettings& settings, Reporter& reporter,
                                 const DrapeRequest& request) {
  if (const std::string why = refusal_of_levels(garment, body, settings); !why.empty()) {
    reporter.info(ON_GIVEN_MESH + why);
    DrapeReport report =
        DrapeSession({.garment = garment, .body = body, .request = request}, settings, reporter)
            .run();
    report.levels = {.meshes = 1, .why = why};
    return report;
  }
  LevelsProgress at;
  at.settings = settings;
  return LevelsDrape(garment, body, std::move(at), nullptr, reporter, request).run();
}

DrapeReport resume_through_levels(const DrapeCheckpoint& from, Garment& garment,
                                  const body::Body* body, Reporter& reporter,
                                  const Checkpoints& checkpoints) {
  DrapeRequest request{.bounds = from.bounds, .checkpoints = checkpoints};
  request.checkpoints.renew = true;
  request.checkpoints.every_steps = from.every_steps;
  request.checkpoints.motion = from.motion;
  garment = from.garment;
  return LevelsDrape(garment, body, *from.levels, &from, reporter, request).run();
}

} // namespace sloper::garment
