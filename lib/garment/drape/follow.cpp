#include <garment/drape/edit_lines.hpp>
#include <garment/drape/follow.hpp>
#include <garment/drape/live_pattern.hpp>
#include <garment/simulate/session.hpp>
#include <sloper/base/error.hpp>
#include <sloper/io/json.hpp>

#include <algorithm>
#include <chrono>
#include <ctime>

namespace sloper::garment {

namespace {

constexpr int IDLE_MS = 20;              // between looks for a line, while at rest
constexpr int CALM_STEPS = 3;            // within the tolerances of rest, one after the other
constexpr double LARGEST_MOVE = 0.02;    // m, of a particle in one frame
constexpr double ANSWER_TOLERANCE = 0.1; // relative residual; see FOLLOW_ANSWER_ITERATIONS
constexpr double BUSY_S = 1; // after an edit: the next one is likely, and waits for a step's end
constexpr int BUSY_ITERATIONS = 6; // at most, of those steps

using Clock = std::chrono::steady_clock;

/// A session that runs for as long as edits come.
class LiveEdit {
public:
  LiveEdit(Garment& garment, const body::Body* body, const DrapeSettings& settings,
           const FollowSession& source, Reporter& reporter)
      : m_garment(garment), m_body(body), m_settings(settings), m_source(source),
        m_reporter(reporter), m_live(garment), m_lines(body != nullptr),
        m_session({.garment = garment, .body = body}, settings, reporter) {}

  FollowReport run() {
    m_session.start_live(true);
    warm_up();
    while (!m_session.stopped() && !m_lines.ended()) {
      const auto line = m_source.next_line(m_at_rest ? IDLE_MS : 0);
      if (line)
        take(*line);
      else if (m_source.ended())
        break;
      else if (!m_at_rest)
        go_on(Clock::now() - m_edited < std::chrono::duration<double>(BUSY_S));
      if (!m_session.stopped() && m_reporter.stop_requested())
        m_session.interrupt();
    }
    finish();
    m_report.log = m_lines.log();
    return std::move(m_report);
  }

private:
  /// The first step makes what all later ones go on with: the matrix and its hierarchy, near pairs,
  /// friction's anchors. It is made before an edit waits for it, and taken back. So are the panels'
  /// triangles, for the first edit that asks for another mesh.
  void warm_up() {
    const std::vector<Vec3> hung = m_garment.position;
    answer(FOLLOW_ANSWER_ITERATIONS);
    m_session.set_positions(hung);
    m_session.prefetch_contacts(m_settings.time_step_s);
    m_live.warm_up();
    m_session.forget_simulated_time();
  }

  /// One step, however long, on a budget. @return false when the session must end
  bool answer(int iterations) {
    return m_session.advance({.h = m_settings.time_step_s,
                              .largest_move_m = LARGEST_MOVE,
                              .least_cg_tolerance = ANSWER_TOLERANCE,
                              .cg_max_iterations = iterations});
  }

  void finish() {
    if (m_session.stopped()) {
      m_report.drape = m_session.finish();
      return;
    }
    Finish finish = Finish::WARM;
    if (m_report.edits > 0)
      finish = m_body ? Finish::COLD : Finish::REPLAY;
    finish = m_lines.finish().value_or(finish);
    if (finish == Finish::COLD) {
      // As if nothing had hung before: friction and folds remember the path that cloth came, so
      // only the same path gives the same drape.
      m_live.make_panels(m_live.go_to_start(), *m_body);
      m_report.drape = drape(m_garment, m_body, m_settings, m_reporter);
      return;
    }
    // A replay is as if all edits had come at once: the rest is one of the first state and of the
    // last pattern, whatever came between and when.
    if (finish == Finish::REPLAY)
      m_live.adopt(m_live.go_to_start());
    m_session.rebuild_cloth(false);
    m_session.forget_steps(); // the limit is for the steps to rest
    m_session.settle();
    m_report.drape = m_session.finish();
  }

  void take(const std::string& line) {
    const auto arrived = Clock::now();
    const std::clock_t cpu = std::clock();
    bool same_mesh = true;
    try {
      EditLines::Taken taken = m_lines.take(line, m_live.pattern());
      if (taken.edits == 0)
        return;
      same_mesh = m_live.adopt(std::move(*taken.next));
      if (same_mesh)
        m_session.replace_rest_shape();
      m_lines.log_taken(taken);
      m_report.edits += static_cast<int>(taken.edits);
    } catch (const Error& e) {
      m_report.refused.push_back(e.what());
      m_reporter.warning({e.id(), m_report.refused.back()});
      return;
    }
    m_edited = arrived;
    if (same_mesh)
      answer_edit(arrived, cpu);
    else
      show_remeshed(arrived, cpu);
  }

  /// The answer to an edit that asks for another mesh is that mesh, where the cloth hangs; the step
  /// is the frame after it.
  void show_remeshed(Clock::time_point arrived, std::clock_t cpu) {
    ++m_report.remeshed;
    m_reporter.info(
        "the edit asks for another mesh: vertex ids are new, the draped state is carried across");
    FollowFrame f = next_frame();
    f.remeshed = true;
    note_latency(f, arrived, cpu);
    if (m_source.on_frame)
      m_source.on_frame(f, m_garment);
    m_session.rebuild_cloth(true);
    go_on(true);
    m_live.ready_follower();
  }

  void answer_edit(Clock::time_point arrived, std::clock_t cpu) {
    m_session.forget_steps(); // a session has no step limit
    if (!answer(FOLLOW_ANSWER_ITERATIONS))
      return;
    FollowFrame f = frame_of_step();
    note_latency(f, arrived, cpu);
    show(f);
  }

  /// One step towards rest. @param busy  on a budget and without a line search, as an answer
  /// is: sooner done
  void go_on(bool busy) {
    m_session.forget_steps();
    const StepRequest request{
        .h = m_settings.time_step_s, .kind = StepKind::DESCEND, .largest_move_m = LARGEST_MOVE};
    if (!(busy ? answer(BUSY_ITERATIONS) : m_session.advance(request)))
      return;
    show(frame_of_step());
  }

  void show(const FollowFrame& f) {
    if (m_source.on_frame)
      m_source.on_frame(f, m_garment);
    m_session.prefetch_contacts(m_settings.time_step_s); // while no edit waits
  }

  FollowFrame next_frame() {
    FollowFrame f;
    f.number = ++m_report.frames;
    f.edits = m_report.edits;
    return f;
  }

  FollowFrame frame_of_step() {
    const cloth::StepResult& last = m_session.last_step();
    FollowFrame f = next_frame();
    f.cg_iterations = last.cg.iterations;
    f.speed_m_s = last.largest_move_m / m_settings.time_step_s;
    const bool still = f.speed_m_s < m_settings.settle_speed_m_s &&
                       last.residual_force_ratio < m_settings.settle_force_ratio;
    m_calm = still ? m_calm + 1 : 0;
    f.at_rest = m_at_rest = m_calm >= CALM_STEPS;
    return f;
  }

  void note_latency(FollowFrame& f, Clock::time_point arrived, std::clock_t cpu) {
    f.latency_ms = std::chrono::duration<double, std::milli>(Clock::now() - arrived).count();
    f.cpu_ms = 1e3 * static_cast<double>(std::clock() - cpu) / CLOCKS_PER_SEC;
    m_report.latency_ms.push_back(f.latency_ms);
    m_report.cpu_ms.push_back(f.cpu_ms);
  }

  Garment& m_garment;
  const body::Body* m_body;
  const DrapeSettings& m_settings;
  const FollowSession& m_source;
  Reporter& m_reporter;
  LivePattern m_live;
  EditLines m_lines;
  DrapeSession m_session;
  FollowReport m_report;
  int m_calm = 0;
  bool m_at_rest = false;
  Clock::time_point m_edited = Clock::now() - std::chrono::hours(1); // the last edit
};

} // namespace

FollowReport follow(Garment& garment, const body::Body* body, const DrapeSettings& settings,
                    const FollowSession& session, Reporter& reporter) {
  return LiveEdit(garment, body, settings, session, reporter).run();
}

} // namespace sloper::garment
