#include <sloper/geometry/polygon.hpp>

#include <cmath>

namespace sloper {

double polygon_area(const std::vector<Vec2>& points, const std::vector<int>& loop) {
  double sum = 0;
  for (std::size_t i = 0; i < loop.size(); ++i) {
    const Vec2 &a = points[loop[i]], &b = points[loop[(i + 1) % loop.size()]];
    sum += 0.5 * (a.x() * b.y() - a.y() * b.x());
  }
  return std::abs(sum);
}

} // namespace sloper
