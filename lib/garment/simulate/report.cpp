#include <sloper/base/text.hpp>
#include <sloper/garment/scene/scene.hpp>
#include <sloper/garment/simulate/report.hpp>
#include <sloper/io/files.hpp>
#include <sloper/io/json.hpp>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <sys/resource.h>

#include <sloper/base/parallel.hpp>

namespace sloper::garment {

namespace {

constexpr const char* AUDITED[] = {"faces_through_body", "vertices_inside_body",
                                   "self_intersections"};

std::string counts_text(const std::string& faces, const std::string& vertices,
                        const std::string& pairs) {
  return faces + " faces through the body, " + vertices + " vertices inside it, " + pairs +
         " self intersections";
}

std::string unclean_text(const io::Json& quality) {
  return "at rest, but " + counts_text(quality[AUDITED[0]].dump(), quality[AUDITED[1]].dump(),
                                       quality[AUDITED[2]].dump());
}

std::string unclean_frames_text(const io::Json& motion) {
  int frames = 0;
  for (const char* count : AUDITED)
    frames = std::max(frames, motion[count]["frames"].get<int>());
  const auto most = [&](int k) { return motion[AUDITED[k]]["most"].dump(); };
  return "at rest in the end, but of " + motion["frames"].dump() + " frames before " +
         std::to_string(frames) + " are not clean: at most " +
         counts_text(most(0), most(1), most(2));
}

/// Whether a phase closes seams, or brings sewn cloth to the mesh that it is for.
bool is_sewing(const std::string& phase) {
  return phase == "sew" || phase == "sew coarse" || phase == "carry to the mesh";
}

/// A limit that ended before the garment was sewn, or that sewing alone used up, says so: the state
/// reached then has no drape in it.
std::string time_limit_text(const DrapeReport& report) {
  double sewing_s = 0;
  bool settled = false;
  for (const auto& [name, wall_s] : report.phases) {
    if (is_sewing(name))
      sewing_s += wall_s;
    settled = settled || name == "settle" || name == "move";
  }
  const double limit_s = report.settings.max_seconds;
  const std::string limit = "time limit of " + decimals(limit_s, limit_s < 1 ? 3 : 1) + " s";
  if (sewing_s > 0 && !settled)
    return limit + ", before the garment was sewn";
  if (limit_s > 0 && sewing_s >= limit_s)
    return limit + ", which sewing alone used up (" + decimals(sewing_s, 1) +
           " s): it is sewn, not draped";
  return "time limit";
}

} // namespace

std::string stop_text(const DrapeReport& report) {
  switch (report.stop_reason) {
  case StopReason::NONE: return "";
  case StopReason::AT_REST: return "at rest";
  case StopReason::AT_REST_COARSE:
    return "at rest on a coarser mesh, carried to the given one and cleared there";
  case StopReason::AT_REST_UNCLEAN: return unclean_text(report.quality);
  case StopReason::AT_REST_AFTER_UNCLEAN_FRAMES:
    return unclean_frames_text(report.quality["motion"]);
  case StopReason::AT_REST_STRETCHED: return "at rest, but stretched by " + report.stop_detail;
  case StopReason::AT_REST_UNTURNED: return "at rest, but " + report.stop_detail;
  case StopReason::AT_REST_AT_FAULT:
    return "at rest, but its panels are at fault: " + report.stop_detail;
  case StopReason::STEP_LIMIT: return "step limit";
  case StopReason::TIME_LIMIT: return time_limit_text(report);
  case StopReason::INTERRUPTED: return "stopped by the user";
  case StopReason::NOT_FINITE: return "diverged";
  case StopReason::STALLED:
    return "the residual has not improved for " + std::to_string(STALLED_STEPS) + " steps";
  case StopReason::STUCK:
    return "stuck: nothing could move for " + std::to_string(UNMOVED_STEPS) + " steps";
  case StopReason::MISFIT: return "the garment " + misfit_text(report.misfit) + " too far to fit";
  case StopReason::NOTHING_CROSSED: return "nothing crossed";
  case StopReason::NOTHING_CROSSES: return "nothing crosses any more";
  case StopReason::CROSSINGS_REMAIN: return "crossings remain";
  case StopReason::PLACED_ONLY: return "placed only";
  case StopReason::NOT_DRAPED: return "not draped: the garment " + report.stop_detail;
  }
  return "";
}

void add_earlier(const DrapeReport& earlier, DrapeReport& report) {
  report.steps += earlier.steps;
  report.simulated_s += earlier.simulated_s;
  report.wall_s += earlier.wall_s;
  for (const EffectReport& before : earlier.effects) {
    const auto same = std::find_if(report.effects.begin(), report.effects.end(),
                                   [&](const EffectReport& e) { return e.name == before.name; });
    if (same == report.effects.end())
      continue;
    same->calls += before.calls;
    same->wall_s += before.wall_s;
    if (before.active && !same->active) { // as sewing, which ends with the first drape
      same->active = true;
      same->why = before.why;
    }
  }
  std::vector<std::pair<std::string, double>> phases = earlier.phases;
  for (const auto& [name, wall] : report.phases) {
    const auto same = std::find_if(phases.begin(), phases.end(),
                                   [&, n = name](const auto& p) { return p.first == n; });
    if (same != phases.end())
      same->second += wall;
    else
      phases.emplace_back(name, wall);
  }
  report.phases = std::move(phases);
  report.repairs.insert(report.repairs.begin(), earlier.repairs.begin(), earlier.repairs.end());
}

io::Json mesh_levels_json(const MeshLevels& levels) {
  io::Json out = {{"meshes", levels.meshes}};
  if (!levels.why.empty())
    out["why"] = levels.why;
  if (levels.coarse_particles > 0)
    out["coarse"] = {{"edge_m", levels.coarse_edge_m},
                     {"particles", levels.coarse_particles},
                     {"residual_force_ratio", levels.coarse_residual_force_ratio}};
  return out;
}

std::string strict_hash(const Garment& garment) {
  return io::sha256({reinterpret_cast<const char*>(garment.position.data()),
                     garment.position.size() * sizeof(Vec3)});
}

std::string quantised_hash(const Garment& garment) {
  std::vector<long> cells;
  cells.reserve(garment.position.size() * 3);
  for (const Vec3& p : garment.position)
    for (int k = 0; k < 3; ++k)
      cells.push_back(std::lround(p[k] * 1e5));
  return io::sha256({reinterpret_cast<const char*>(cells.data()), cells.size() * sizeof(long)});
}

io::Json report_json(const DrapeReport& report, const std::string& tool) {
  io::Json out = io::new_document("report", 1, tool);
  out["converged"] = report.converged;
  out["stop_reason"] = stop_text(report);
  out["steps"] = report.steps;
  out["simulated_s"] = report.simulated_s;
  out["wall_s"] = report.wall_s;
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  auto seconds = [](const timeval& t) {
    return static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_usec);
  };
  out["cpu_s"] = seconds(usage.ru_utime) + seconds(usage.ru_stime);
  out["peak_rss_mb"] = static_cast<double>(usage.ru_maxrss) / 1024;
  out["threads"] = thread_count();
  out["effects"] = io::Json::array();
  for (const EffectReport& e : report.effects)
    out["effects"].push_back({{"name", e.name},
                              {"active", e.active},
                              {"why", e.why},
                              {"calls", e.calls},
                              {"wall_s", e.wall_s}});
  out["phases"] = io::Json::object();
  for (const auto& [name, wall] : report.phases)
    out["phases"][name] = {{"wall_s", wall}};
  out["solver"] = report.solver;
  out["quality"] = report.quality;
  out["repairs"] = report.repairs;
  if (report.levels.meshes > 0)
    out["levels"] = mesh_levels_json(report.levels);
  out["settings"] = settings_json(report.settings);
  return out;
}

} // namespace sloper::garment
