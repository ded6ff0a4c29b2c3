#include <pattern/mesh/smallest_angle.hpp>

#include <algorithm>
#include <cmath>

namespace sloper::pattern {

double smallest_angle(const Vec2& a, const Vec2& b, const Vec2& c) {
  const double area = (b.x() - a.x()) * (c.y() - a.y()) - (b.y() - a.y()) * (c.x() - a.x());
  if (!(area > 0))
    return 0;
  return std::min({std::atan2(area, (b - a).dot(c - a)), std::atan2(area, (c - b).dot(a - b)),
                   std::atan2(area, (a - c).dot(b - c))});
}

} // namespace sloper::pattern
