#include <pattern/mesh/roll_lines.hpp>

#include <algorithm>
#include <cmath>

namespace sloper::pattern {

constexpr double ROLL_SAMPLE = 0.002; // m between the points by which a curved roll line is known

RollLines::RollLines(const Panel& panel) {
  for (const InnerLine& line : panel.lines) {
    if (line.kind != "roll")
      continue;
    const ArcLength arc(line.path);
    const int n = std::clamp(static_cast<int>(std::ceil(arc.length() / ROLL_SAMPLE)), 1, 2000);
    m_lines.emplace_back();
    for (int k = 0; k <= n; ++k)
      m_lines.back().push_back(arc.at(arc.length() * k / n));
  }
}

std::pair<double, Vec2> RollLines::across(const Vec2& x) const {
  double least = 1e300, side = 0;
  Vec2 image = x;
  for (const std::vector<Vec2>& line : m_lines)
    for (std::size_t i = 0; i + 1 < line.size(); ++i) {
      const Vec2 from = line[i], along = line[i + 1] - from;
      const double t = (x - from).dot(along) / along.squaredNorm();
      const Vec2 near = from + std::clamp(t, 0.0, 1.0) * along;
      if (!((x - near).norm() < least))
        continue;
      least = (x - near).norm();
      const bool goes_on = (t < 0 && i == 0) || (t > 1 && i + 2 == line.size());
      const Vec2 foot = goes_on ? Vec2(from + t * along) : near;
      const double left = along.x() * (x - from).y() - along.y() * (x - from).x();
      side = std::copysign((x - foot).norm(), left);
      image = 2 * foot - x;
    }
  return {side, image};
}

} // namespace sloper::pattern
