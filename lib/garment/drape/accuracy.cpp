#include <sloper/garment/drape/accuracy.hpp>
#include <sloper/garment/scene/scene.hpp>
#include <sloper/io/json.hpp>

#include <algorithm>
#include <chrono>
#include <cmath>

namespace sloper::garment {

namespace {

/// Wall time of a preset that goes on from the one before, in times of the whole until then;
/// measured, rounded up.
constexpr double NEXT_COSTS = 0.5;

} // namespace

AccuracyReport drape_to_goal(Garment& garment, const body::Body* body, const AccuracyGoal& goal,
                             const std::function<void(DrapeSettings&)>& adjust,
                             Reporter& reporter) {
  const auto start = std::chrono::steady_clock::now();
  const auto elapsed = [&] {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  };
  AccuracyReport report;
  io::Json presets = io::Json::array();
  double estimate = -1;
  std::vector<Vec3> before;
  const std::vector<std::string> names = accuracy_names();
  for (std::size_t k = 0; k < names.size(); ++k) {
    if (goal.max_error_m <= 0 && k > 1)
      break;
    if (k > 0 && goal.max_seconds > 0 && elapsed() * (1 + NEXT_COSTS) > goal.max_seconds)
      break;
    DrapeSettings settings = preset_settings(names[k]);
    adjust(settings);
    settings.accuracy = names[k];
    if (goal.max_seconds > 0)
      settings.max_seconds = std::max(goal.max_seconds - elapsed(), 1e-6);
    reporter.info("accuracy " + names[k]);
    const std::vector<Vec3> kept = garment.position;
    DrapeRequest request;
    request.carried = k > 0 && report.drape.levels.meshes > 1;
    DrapeReport now = drape(garment, body, settings, reporter, request);
    const bool worse = k > 0 && report.drape.converged && !now.converged;
    io::Json entry = {{"accuracy", names[k]}, {"converged", now.converged}, {"wall_s", now.wall_s}};
    if (worse) { // what was at rest before is given back
      garment.position = kept;
      garment.converged = true;
      presets.push_back(entry);
      break;
    }
    const bool converged = now.converged;
    if (k > 0) {
      now.levels = report.drape.levels;
      add_earlier(report.drape, now);
    }
    report.drape = std::move(now);
    if (!before.empty() && before.size() == garment.position.size()) {
      double sum = 0, largest = 0;
      for (std::size_t i = 0; i < before.size(); ++i) {
        const double d = (garment.position[i] - before[i]).norm();
        sum += d * d;
        largest = std::max(largest, d);
      }
      estimate = std::sqrt(sum / static_cast<double>(before.size()));
      entry["moved_rms_m"] = estimate;
      entry["moved_max_m"] = largest;
    }
    presets.push_back(entry);
    before = garment.position;
    if (!converged)
      break; // a finer preset would not come to rest either
    if (goal.max_error_m > 0 && estimate >= 0 && ACCURACY_MARGIN * estimate <= goal.max_error_m)
      break;
  }
  report.met =
      report.drape.converged &&
      (goal.max_error_m <= 0 || (estimate >= 0 && ACCURACY_MARGIN * estimate <= goal.max_error_m));
  report.achieved = {{"max_error_m", goal.max_error_m},
                     {"max_seconds", goal.max_seconds},
                     {"margin", ACCURACY_MARGIN},
                     {"presets", presets},
                     {"error_estimate_m", estimate < 0 ? io::Json() : io::Json(estimate)},
                     {"met", report.met}};
  return report;
}

} // namespace sloper::garment
