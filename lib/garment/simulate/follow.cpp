#include <base/error.hpp>
#include <cloth/forces/shear.hpp>
#include <garment/retarget/carry.hpp>
#include <garment/scene/effects.hpp>
#include <garment/sewing.hpp>
#include <garment/simulate/drape_run.hpp>
#include <garment/simulate/follow.hpp>
#include <io/json.hpp>
#include <pattern/edit/edits.hpp>
#include <pattern/mesh/folds.hpp>
#include <pattern/mesh/mesh_pattern.hpp>
#include <pattern/place/place_panels.hpp>
#include <pattern/seams/check_pattern.hpp>

#include <algorithm>
#include <chrono>
#include <ctime>

namespace sloper::garment {
enum class Finish { WARM, REPLAY, COLD };

namespace {

constexpr double LEAST_ANGLE = 15;   // degrees: a mesh that follows an edit is kept while it is no worse
constexpr double OFF_OUTLINE = 1e-4; // m: vertices further off are not of this pattern
constexpr int IDLE_MS = 20;          // between looks for a line, while at rest
constexpr int CALM_STEPS = 3;
constexpr double LARGEST_MOVE = 0.02;    // m, of a particle in one frame
constexpr double ANSWER_TOLERANCE = 0.1; // relative residual; see FOLLOW_ANSWER_ITERATIONS
constexpr double BUSY_S = 1;             // after an edit: the next one is likely to come, and waits for the step it comes into
constexpr int BUSY_ITERATIONS = 6;       // at most, of those steps

using Clock = std::chrono::steady_clock;

} // namespace

/// A DrapeRun that goes on for as long as edits come.
class FollowRun {
public:
  FollowRun(Garment& garment, const body::Body* body, const DrapeSettings& settings, const FollowSession& session, Reporter& reporter)
      : m_garment(garment), m_session(session), m_reporter(reporter), m_run(garment, body, settings, reporter) {
    if (garment.particle_of.empty()) throw input_error("", "", "the garment is not sewn yet", "drape it first, then let it follow edits");
    if (!garment.panels.source) throw input_error("", "", "the garment does not know the pattern it was made from", "mesh and drape the pattern again");
    m_pattern = *garment.panels.source;
    ready_follower();
    if (m_follower->off_outline() > OFF_OUTLINE)
      throw input_error("", "",
                        "the panels are no longer those of the garment's pattern: a vertex lies " + pattern::centimetres(m_follower->off_outline()) +
                            " off its outline",
                        "edits can follow a garment that drape made, not one that was regraded");
    note_untaped();
    m_start = m_garment;
    m_log = {{"format", "edits"}, {"version", 1}, {"length_unit", "m"}, {"edits", io::Json::array()}};
  }

  FollowReport run() {
    m_run.m_report.effects = choose_effects(m_garment, m_run.m_body, m_run.m_settings);
    m_run.start_outside_body(false);
    m_run.build_solver(false);
    m_run.inflate();
    go_live();
    warm_up();
    while (!m_run.m_stopped && !m_end) {
      const auto line = m_session.next_line(m_at_rest ? IDLE_MS : 0);
      if (line) take(*line);
      else if (m_session.ended()) break;
      else if (!m_at_rest) frame(-1, 0, Clock::now() - m_edited < std::chrono::duration<double>(BUSY_S));
      m_run.m_stopped = m_run.m_stopped || m_reporter.stop_requested();
    }
    settle();
    m_report.log = m_log;
    m_report.drape = std::move(m_run.m_report);
    return std::move(m_report);
  }

private:
  void note_untaped() {
    m_untaped = m_garment.rest_scale;
    if (const auto scale = pattern::tape_scales(m_garment.panels); !scale.empty())
      for (std::size_t f = 0; f < m_untaped.size(); ++f)
        for (std::size_t k = 0; k < 3; ++k) m_untaped[f][k] /= scale[f][k];
  }

  /// Weight and friction from the first frame on.
  void go_live() {
    m_run.add_load();
    m_run.m_settling = true;
  }

  void ready_follower() {
    if (!m_follower) m_follower.emplace(m_pattern, m_garment.panels);
  }

  /// The first step makes what all later ones go on with: the matrix and its hierarchy, near pairs, friction's anchors. It is made before
  /// an edit waits for it, and taken back. So are the panels' triangles, for the first edit that asks for another mesh.
  void warm_up() {
    const std::vector<Vec3> hung = m_run.m_solver->x();
    answer();
    m_run.m_solver->set_positions(hung);
    m_run.m_solver->look_ahead(m_run.m_settings.time_step_s);
    pattern::Pattern on_grid = m_pattern; // as after any edit
    pattern::apply_edits(on_grid, io::Json{{"format", "edits"}, {"length_unit", "m"}, {"edits", io::Json::array()}}, "");
    pattern::mesh_pattern(on_grid, m_garment.panels.edge_length, "edits", m_garment.panels.seam_length, &m_memory);
    m_run.m_at.cg_iterations.clear();
    m_run.m_report.simulated_s = 0;
  }

  /// One step, however long, on the budget of an answer. @return false when the run must end
  bool answer(int iterations = FOLLOW_ANSWER_ITERATIONS) {
    const DrapeSettings settings = m_run.m_settings;
    m_run.m_settings.cg_tolerance = std::max(settings.cg_tolerance, ANSWER_TOLERANCE);
    m_run.m_settings.cg_max_iterations = std::min(settings.cg_max_iterations, iterations);
    m_run.m_settling = false;
    const bool goes_on = m_run.step(settings.time_step_s, 0, LARGEST_MOVE);
    m_run.m_settings = settings;
    return goes_on;
  }

  void settle() {
    if (m_run.m_stopped) {
      m_run.finish();
      m_run.m_report.wall_s = m_run.elapsed();
      return;
    }
    if (!m_finish) m_finish = m_report.edits == 0 ? Finish::WARM : m_run.m_body ? Finish::COLD : Finish::REPLAY;
    if (m_finish == Finish::COLD) return drape_cold();
    m_garment.position = m_run.m_solver->x();
    if (m_finish == Finish::REPLAY) change_from_start();
    m_run.build_solver(false);
    m_run.m_report.steps = 0;     // the limit is for the way to rest
    m_run.m_at.disturbed = false; // it hangs: without weight it would ride up
    m_run.settle();
    m_run.finish();
    m_run.m_report.wall_s = m_run.elapsed();
  }

  /// As if nothing had hung before: friction and folds remember the way that cloth came, so only the same way gives the same drape. The
  /// panels are those of pattern-mesh --edits: of the first mesh while it can follow, else meshed anew.
  void drape_cold() {
    const pattern::Pattern last = to_start();
    if (!m_follower->follow(last, m_garment.panels, LEAST_ANGLE)) {
      m_garment.panels = pattern::mesh_pattern(last, m_garment.panels.edge_length, "edits", m_garment.panels.seam_length, &m_memory);
      m_untaped.clear();
    }
    m_garment.panels.source = std::make_shared<pattern::Pattern>(last);
    tape();
    pattern::place_panels(last, *m_run.m_body, m_garment.panels);
    m_garment.particle_of.clear(), m_garment.position.clear(), m_garment.bind = {};
    m_run.m_report = drape(m_garment, m_run.m_body, m_run.m_settings, m_reporter);
  }

  /// As if all edits had come at once: the rest is then one of the first state and of the last pattern, whatever came between and when.
  void change_from_start() { adopt(to_start()); }

  /// The garment as it came. @return the last pattern
  pattern::Pattern to_start() {
    pattern::Pattern last = std::move(m_pattern);
    m_garment = m_start;
    m_pattern = *m_start.panels.source;
    m_follower.reset(), ready_follower();
    note_untaped();
    return last;
  }

  void take(const std::string& line) {
    const auto arrived = Clock::now();
    const std::clock_t cpu = std::clock();
    ++m_line;
    if (line.find_first_not_of(" \t") == std::string::npos) return;
    try {
      const std::string place = "line " + std::to_string(m_line);
      if (!line.starts_with('{')) throw input_error(place, "", "is no JSON object", R"(write an edit such as {"edit": "scale", ...} on one line)");
      io::Json json = io::parse_json(line, place);
      const io::Node node(json, place);
      if (!node.is_object()) node.fail("a line is a head or an edit");
      io::Json document = m_head;
      if (node.has("format")) {
        m_head = json, m_head["edits"] = io::Json::array();
        document = json;
        if (!node.has("edits")) document["edits"] = io::Json::array();
      } else {
        if (node.at("edit").string() == "end") {
          if (!node.has("finish")) {
            m_end = true;
            return;
          }
          const std::string finish = node.at("finish").string();
          if (finish != "warm" && finish != "replay" && finish != "cold") node.fail("there is no finish '" + finish + "'", "known are warm, replay and cold");
          if (finish == "cold" && !m_run.m_body) node.fail("without a body the panels cannot be placed for a cold finish", "give --body, or finish warm");
          m_end = true, m_finish = finish == "cold" ? Finish::COLD : finish == "replay" ? Finish::REPLAY : Finish::WARM;
          return;
        }
        if (m_head.is_null()) node.fail("there is no head line before the first edit", R"(begin with {"format": "edits", "version": 1, "length_unit": "cm"})");
        document["edits"].push_back(json);
      }
      const std::size_t count = document["edits"].size();
      pattern::Pattern next = m_pattern;
      pattern::apply_edits(next, document, place);
      if (count == 0) return;
      pattern::require_sewable(next, place);
      change(std::move(next));
      for (const io::Json& edit : document["edits"]) m_log["edits"].push_back(edit);
      m_log["length_unit"] = document["length_unit"];
      m_report.edits += static_cast<int>(count);
    } catch (const Error& e) {
      m_report.refused.push_back(e.what());
      m_reporter.warning(m_report.refused.back());
      return;
    }
    m_edited = arrived;
    const auto since = [&] { return std::chrono::duration<double, std::milli>(Clock::now() - arrived).count(); };
    if (!m_remeshed) return frame(since(), cpu);
    FollowFrame f = next_frame();
    answered(f, since(), cpu);
    if (m_session.on_frame) m_session.on_frame(f, m_garment);
    m_remeshed = false;
    m_run.build_solver(false);
    go_live();
    frame(-1, 0, true);
    ready_follower();
  }

  FollowFrame next_frame() {
    FollowFrame f;
    f.number = ++m_report.frames, f.edits = m_report.edits, f.remeshed = m_remeshed;
    return f;
  }

  void answered(FollowFrame& f, double latency_ms, std::clock_t cpu) {
    f.latency_ms = latency_ms;
    f.cpu_ms = 1e3 * static_cast<double>(std::clock() - cpu) / CLOCKS_PER_SEC;
    m_report.latency_ms.push_back(f.latency_ms), m_report.cpu_ms.push_back(f.cpu_ms);
  }

  /// The garment has this pattern from now on.
  void change(pattern::Pattern next) {
    m_garment.position = m_run.m_solver->x();
    if (adopt(std::move(next))) rest_changed();
    else {
      m_remeshed = true, ++m_report.remeshed;
      m_reporter.info("the edit asks for another mesh: vertex ids are new, the draped state is carried across");
    } // the solver is made once the mesh was shown
  }

  /// @return whether particles are as before
  bool adopt(pattern::Pattern next) {
    ready_follower();
    const bool follows = m_follower->follow(next, m_garment.panels, LEAST_ANGLE);
    if (!follows) {
      carry_to(m_garment, pattern::mesh_pattern(next, m_garment.panels.edge_length, "edits", m_garment.panels.seam_length, &m_memory));
      m_follower.reset(); // made when there is time
      m_untaped.clear();  // it counted old triangles
    }
    m_pattern = std::move(next);
    m_garment.panels.source = std::make_shared<pattern::Pattern>(m_pattern);
    tape();
    return follows;
  }

  /// Elastic tapes on top of the rest lengths that the garment came with.
  void tape() {
    std::vector<std::array<double, 3>> scale = pattern::tape_scales(m_garment.panels);
    if (scale.empty()) scale = m_untaped;
    else
      for (std::size_t f = 0; f < m_untaped.size(); ++f)
        for (std::size_t k = 0; k < 3; ++k) scale[f][k] *= m_untaped[f][k];
    m_garment.rest_scale = std::move(scale);
  }

  /// New rest lengths, areas and masses under the same particles. Terms that keep a copy of the rest state are made anew.
  void rest_changed() {
    for (const auto& effect : m_run.m_solver->effects())
      for (const char* keeps : {"membrane", "triangle_stretch", "dihedral_bending"})
        if (effect->name() == std::string(keeps)) { // made with settings of the scene
          m_run.build_solver(false);
          go_live();
          return;
        }
    *m_run.m_cloth = cloth_mesh_of(m_garment);
    if (!m_run.active("damping")) {
      for (cloth::EdgeSpring& s : m_run.m_cloth->springs) s.damping_s = 0;
      for (cloth::Fabric& f : m_run.m_cloth->fabrics) f.damping_s = 0;
    }
    for (const auto& effect : m_run.m_solver->effects())
      if (effect->name() == std::string("shear")) static_cast<cloth::ShearEffect&>(*effect).set_rest(*m_run.m_cloth);
  }

  /// One step on the way to rest, or, where an edit came `since_edit_ms` ago, the one that answers it.
  /// @param wide  on a budget and not searched, as an answer is not: sooner done
  void frame(double since_edit_ms = -1, std::clock_t cpu = 0, bool wide = false) {
    const auto began = Clock::now();
    const double h = m_run.m_settings.time_step_s;
    const bool edited = since_edit_ms >= 0;
    m_run.m_report.steps = 0; // a session has no step limit
    m_run.m_settling = true;  // the way to rest is searched
    if (!(edited ? answer() : wide ? answer(BUSY_ITERATIONS) : m_run.step(h, 0, LARGEST_MOVE))) return;
    FollowFrame f = next_frame();
    f.cg_iterations = m_run.m_at.last.cg.iterations;
    f.speed_m_s = m_run.m_at.last.largest_move_m / h;
    const bool still = f.speed_m_s < m_run.m_settings.settle_speed_m_s && m_run.m_at.last.residual_force_ratio < m_run.m_settings.settle_force_ratio;
    m_calm = still ? m_calm + 1 : 0;
    f.at_rest = m_at_rest = m_calm >= CALM_STEPS;
    m_garment.position = m_run.m_solver->x();
    if (edited) answered(f, since_edit_ms + std::chrono::duration<double, std::milli>(Clock::now() - began).count(), cpu);
    if (m_session.on_frame) m_session.on_frame(f, m_garment);
    m_run.m_solver->look_ahead(h); // while no edit waits
  }

  Garment& m_garment;
  const FollowSession& m_session;
  Reporter& m_reporter;
  DrapeRun m_run;
  pattern::Pattern m_pattern;
  std::optional<pattern::MeshFollower> m_follower; ///< none: of m_pattern and the panels as they are
  pattern::MeshMemory m_memory;
  std::vector<std::array<double, 3>> m_untaped; ///< rest_scale without the tapes, or empty
  io::Json m_head, m_log;
  Garment m_start; ///< as it came
  FollowReport m_report;
  int m_line = 0, m_calm = 0;
  std::optional<Finish> m_finish; ///< as asked for
  bool m_end = false, m_at_rest = false, m_remeshed = false;
  Clock::time_point m_edited = Clock::now() - std::chrono::hours(1); ///< the last edit
};

FollowReport follow(Garment& garment, const body::Body* body, const DrapeSettings& settings, const FollowSession& session, Reporter& reporter) {
  return FollowRun(garment, body, settings, session, reporter).run();
}

io::Json follow_report_json(const FollowReport& report, const std::string& tool) {
  io::Json out = report_json(report.drape, tool);
  const auto spread = [](std::vector<double> sorted) {
    std::sort(sorted.begin(), sorted.end());
    const auto at = [&](double q) { return sorted.empty() ? 0.0 : sorted[static_cast<std::size_t>(q * static_cast<double>(sorted.size() - 1))]; };
    return io::Json{{"p50", at(0.5)}, {"p95", at(0.95)}, {"max", at(1)}};
  };
  out["follow"] = {{"edits", report.edits},           {"remeshed", report.remeshed}, {"frames", report.frames}, {"latency_ms", spread(report.latency_ms)},
                   {"cpu_ms", spread(report.cpu_ms)}, {"refused", report.refused}};
  return out;
}

} // namespace sloper::garment
