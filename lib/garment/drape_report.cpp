#include <garment/drape.hpp>
#include <garment/scene.hpp>
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

} // namespace sloper::garment
