#include <cloth/body_motion.hpp>

#include <algorithm>
#include <chrono>

namespace sloper::cloth {

namespace {

/// Of one advance: so many, and one more for so long a way, m; then what is left of the way is gone at once. Mean parts are 0.5 to 2 mm long.
constexpr int MOST_PARTS = 100;
constexpr double SHORTEST_PART = 2e-4;
/// Time given to a part is at least this share of the advance's, however short its way. Without it cloth that must be as fast as the skin
/// at once would never be: parts, and the time in which the contact speeds the cloth up, shrink with the distance.
constexpr double LEAST_TIME = 0.02;

double longest_of(const std::vector<Vec3>& way) {
  double longest = 0;
  for (const Vec3& w : way) longest = std::max(longest, w.norm());
  return longest;
}

} // namespace

StepResult BodyMotion::advance(const std::vector<Vec3>& target, const StepOptions& options, const std::function<StepResult(const StepOptions&)>& step) {
  ++calls;
  StepResult result;
  std::vector<Vec3> way(target.size()), skin;
  double left = 1, moved = 0; // left: share of the way; moved: of all parts together, m
  int most_parts = 0;
  for (int part = 1;; ++part) {
    const auto began = std::chrono::steady_clock::now();
    skin = m_body.mesh().positions;
    for (std::size_t v = 0; v < way.size(); ++v) way[v] = target[v] - skin[v];
    const double longest = longest_of(way);
    if (part == 1) {
      largest_way_m = std::max(largest_way_m, longest);
      most_parts = MOST_PARTS + static_cast<int>(std::min(longest / SHORTEST_PART, 1e6));
    }
    double share = m_contact.free_share(m_solver.x(), way);
    const bool force = part >= most_parts && share < 1;
    if (force) share = 1;
    if (share > 0 && longest > 0) {
      for (std::size_t v = 0; v < way.size(); ++v) skin[v] = share < 1 ? Vec3(skin[v] + share * way[v]) : target[v];
      m_contact.move_body(skin);
    }
    if (force) {
      ++forced;
      m_contact.refresh();
    }
    wall_s += std::chrono::duration<double>(std::chrono::steady_clock::now() - began).count();
    StepOptions o = options;
    const double time = share * left;
    if (options.inertia > 0) o.h = std::max(LEAST_TIME, time) * options.h;
    left -= time;
    result = step ? step(o) : m_solver.step(o);
    ++parts;
    moved += result.largest_move_m;
    result.largest_move_m = moved;
    if (!result.finite || share >= 1) return result;
  }
}

} // namespace sloper::cloth
