#include <garment/scene/scene.hpp>
#include <garment/simulate/drape_run.hpp>
#include <io/files.hpp>
#include <io/json.hpp>

#include <cmath>
#include <cstring>
#include <sys/resource.h>

#include <base/parallel.hpp>

namespace sloper::garment {

std::string strict_hash(const Garment& garment) {
  return io::sha256({reinterpret_cast<const char*>(garment.position.data()), garment.position.size() * sizeof(Vec3)});
}

std::string quantised_hash(const Garment& garment) {
  std::vector<long> cells;
  cells.reserve(garment.position.size() * 3);
  for (const Vec3& p : garment.position)
    for (int k = 0; k < 3; ++k) cells.push_back(std::lround(p[k] * 1e5));
  return io::sha256({reinterpret_cast<const char*>(cells.data()), cells.size() * sizeof(long)});
}

io::Json report_json(const DrapeReport& report, const std::string& tool) {
  io::Json out = io::new_document("report", 1, tool);
  out["converged"] = report.converged;
  out["stop_reason"] = report.stop_reason;
  out["steps"] = report.steps;
  out["simulated_s"] = report.simulated_s;
  out["wall_s"] = report.wall_s;
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  auto seconds = [](const timeval& t) { return static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_usec); };
  out["cpu_s"] = seconds(usage.ru_utime) + seconds(usage.ru_stime);
  out["peak_rss_mb"] = static_cast<double>(usage.ru_maxrss) / 1024;
  out["threads"] = thread_count();
  out["effects"] = io::Json::array();
  for (const EffectReport& e : report.effects)
    out["effects"].push_back({{"name", e.name}, {"active", e.active}, {"why", e.why}, {"calls", e.calls}, {"wall_s", e.wall_s}});
  out["phases"] = io::Json::object();
  for (const auto& [name, wall] : report.phases) out["phases"][name] = {{"wall_s", wall}};
  out["solver"] = report.solver;
  out["quality"] = report.quality;
  out["repairs"] = report.repairs;
  out["settings"] = settings_json(report.settings);
  return out;
}

void DrapeRun::report_effects() {
  for (const auto& effect : m_solver->effects())
    for (EffectReport& r : m_report.effects)
      if (r.name == effect->name()) {
        r.calls += effect->calls;
        r.wall_s += effect->wall_s;
      }
  for (EffectReport& r : m_report.effects) // damping and friction live in the terms that they belong to
    if (r.name == "friction" && m_body_contact) r.calls += m_body_contact->friction_calls;
    else if (r.name == "layers" && r.active && m_self_contact) r.calls += m_self_contact->calls;
    else if (r.name == "damping" && r.active) r.calls = m_report.steps;
}

void DrapeRun::note_solves() {
  m_at.cg_iterations.push_back(m_at.last.cg.iterations);
  m_at.solves += m_at.last.newton_iterations;
}

void DrapeRun::finish() {
  if (m_solver) {
    m_garment.position = m_solver->x();
    report_effects();
  }
  const Phase phase(*this, "audit");
  meet_bare_skin(); // mittens and the coarser skin were only means
  const Audit a = audit(m_garment, m_collider ? &*m_collider : nullptr);
  if (!a.clean() && m_report.converged) {
    m_report.converged = false;
    m_report.stop_reason = "at rest, but " + std::to_string(a.through.size()) + " faces through the body, " + std::to_string(a.inside.size()) +
                           " vertices inside it, " + std::to_string(a.self.size()) + " self intersections";
  }
  auto triple = [](const double q[3]) { return io::Json{{"p50", q[0]}, {"p99", q[1]}, {"max", q[2]}}; };
  m_report.quality = {{"max_speed_m_s", m_at.last_h > 0 ? m_at.last.largest_move_m / m_at.last_h : 0},
                      {"residual_force_ratio", m_at.last.residual_force_ratio},
                      {"residual_force_ratio_max", m_at.last.residual_force_ratio_max},
                      {"particles_held", m_at.last.held},
                      {"strain", {{"warp", triple(a.strain_warp)}, {"weft", triple(a.strain_weft)}, {"bias", triple(a.strain_bias)}}},
                      {"faces_through_body", a.through.size()},
                      {"vertices_inside_body", a.inside.size()},
                      {"deepest_m", a.deepest_m},
                      {"self_intersections", a.self.size()}};
  std::vector<int> sorted = m_at.cg_iterations;
  std::sort(sorted.begin(), sorted.end());
  double mean = 0;
  for (int n : sorted) mean += n;
  const std::size_t n = std::max<std::size_t>(sorted.size(), 1);
  m_report.solver = {
      {"cg_iterations",
       {{"mean", mean / static_cast<double>(n)}, {"p95", sorted.empty() ? 0 : sorted[(n - 1) * 95 / 100]}, {"max", sorted.empty() ? 0 : sorted.back()}}},
      {"residual", m_at.last.cg.residual},
      {"newton", static_cast<double>(m_at.solves) / static_cast<double>(n)},
      {"rejected_steps", m_at.rejected}};
  m_garment.converged = m_report.converged;
  if (m_moves) {
    m_report.quality["motion"] = motion_report();
    const MotionState& m = m_at.motion;
    const int bad = *std::max_element(std::begin(m.bad_frames), std::end(m.bad_frames));
    if (bad > 0 && m_report.converged) {
      m_report.converged = false;
      m_report.stop_reason = "at rest in the end, but of " + std::to_string(m.frame) + " frames before " + std::to_string(bad) + " are not clean: at most " +
                             std::to_string(m.most[0]) + " faces through the body, " + std::to_string(m.most[1]) + " vertices inside it, " +
                             std::to_string(m.most[2]) + " self intersections";
    }
  }
  m_garment.offset_m = m_settings.contact_gap_m;
}

} // namespace sloper::garment
