#include <garment/drape/follow.hpp>
#include <sloper/io/json.hpp>

#include <algorithm>

namespace sloper::garment {

io::Json follow_report_json(const FollowReport& report, const std::string& tool) {
  io::Json out = report_json(report.drape, tool);
  const auto spread = [](std::vector<double> sorted) {
    std::sort(sorted.begin(), sorted.end());
    const auto at = [&](double q) {
      return sorted.empty()
                 ? 0.0
                 : sorted[static_cast<std::size_t>(q * static_cast<double>(sorted.size() - 1))];
    };
    return io::Json{{"p50", at(0.5)}, {"p95", at(0.95)}, {"max", at(1)}};
  };
  out["follow"] = {{"edits", report.edits},           {"remeshed", report.remeshed},
                   {"frames", report.frames},         {"latency_ms", spread(report.latency_ms)},
                   {"cpu_ms", spread(report.cpu_ms)}, {"refused", report.refused}};
  return out;
}

} // namespace sloper::garment
