#include <garment/drapemeter/shadow.hpp>

#include <algorithm>
#include <cmath>

namespace sloper::garment {

namespace {

double side_of(const Vec2& a, const Vec2& b, const Vec2& q) {
  return (b.x() - a.x()) * (q.y() - a.y()) - (b.y() - a.y()) * (q.x() - a.x());
}

} // namespace

double shadow_area(const std::vector<Triangle>& triangles, const std::vector<Vec3>& position,
                   double cell_m, double hole_radius_m) {
  if (triangles.empty())
    return 0;
  Vec2 low(1e300, 1e300), high(-1e300, -1e300);
  for (const Vec3& p : position) {
    low = low.cwiseMin(Vec2(p.x(), p.z()));
    high = high.cwiseMax(Vec2(p.x(), p.z()));
  }
  const auto columns = static_cast<std::ptrdiff_t>((high.x() - low.x()) / cell_m) + 1,
             rows = static_cast<std::ptrdiff_t>((high.y() - low.y()) / cell_m) + 1;
  std::vector<char> dark(static_cast<std::size_t>(columns * rows), 0);
  const auto cell = [&](double v, double least, std::ptrdiff_t n) {
    return std::clamp(static_cast<std::ptrdiff_t>((v - least) / cell_m), std::ptrdiff_t{0}, n - 1);
  };
  for (const Triangle& t : triangles) {
    Vec2 p[3];
    for (int k = 0; k < 3; ++k)
      p[k] = Vec2(position[t[k]].x(), position[t[k]].z());
    const Vec2 first = p[0].cwiseMin(p[1]).cwiseMin(p[2]),
               last = p[0].cwiseMax(p[1]).cwiseMax(p[2]);
    for (auto r = cell(first.y(), low.y(), rows); r <= cell(last.y(), low.y(), rows); ++r)
      for (auto c = cell(first.x(), low.x(), columns); c <= cell(last.x(), low.x(), columns); ++c) {
        const Vec2 q(low.x() + (static_cast<double>(c) + 0.5) * cell_m,
                     low.y() + (static_cast<double>(r) + 0.5) * cell_m);
        const double a = side_of(p[0], p[1], q), b = side_of(p[1], p[2], q),
                     d = side_of(p[2], p[0], q);
        if ((a >= 0 && b >= 0 && d >= 0) || (a <= 0 && b <= 0 && d <= 0))
          dark[r * columns + c] = q.norm() >= hole_radius_m;
      }
  }
  return static_cast<double>(std::count(dark.begin(), dark.end(), 1)) * cell_m * cell_m;
}

int count_folds(const std::vector<Vec3>& rim, double swing_m) {
  if (rim.size() < 3)
    return 0;
  const auto n = static_cast<double>(rim.size());
  Vec2 middle = Vec2::Zero();
  for (const Vec3& p : rim)
    middle += Vec2(p.x(), p.z()) / n;
  std::vector<double> radius;
  double mean = 0;
  for (const Vec3& p : rim) {
    radius.push_back((Vec2(p.x(), p.z()) - middle).norm());
    mean += radius.back() / n;
  }
  // It begins where the line is surely inside, so that a fold over the start counts once.
  const auto start =
      static_cast<std::size_t>(std::min_element(radius.begin(), radius.end()) - radius.begin());
  if (radius[start] > mean - swing_m)
    return 0;
  int folds = 0;
  bool outside = false;
  for (std::size_t k = 0; k < radius.size(); ++k) {
    const double r = radius[(start + k) % radius.size()];
    const bool now = r > mean + (outside ? -swing_m : swing_m);
    folds += now && !outside;
    outside = now;
  }
  return folds;
}

} // namespace sloper::garment
