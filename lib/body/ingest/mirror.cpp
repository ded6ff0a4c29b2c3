#include <body/ingest/mirror.hpp>
#include <sloper/base/statistics.hpp>
#include <sloper/base/units.hpp>

#include <algorithm>
#include <cmath>
#include <span>

namespace sloper::body {

namespace {

/// Outline of one layer as radius over angle around its centre.
struct RadialLayer {
  Vec2 center;
  double height = 0;          ///< m
  std::vector<double> radius; ///< negative where there is no point
  std::vector<Vec2> outline;  ///< at those radii
};

constexpr int N_ANGLES = 90;
constexpr std::size_t FEWEST = 100; ///< pairs of radii that tell anything

/// Median radius per angle of the points of one layer that are within `reach` of the centre.
RadialLayer radial_layer(const std::vector<Vec2>& points, const Vec2& center, double reach) {
  RadialLayer layer{center, 0, std::vector<double>(N_ANGLES, -1),
                    std::vector<Vec2>(N_ANGLES, center)};
  std::vector<std::vector<double>> bins(N_ANGLES);
  for (const Vec2& p : points) {
    const Vec2 d = p - center;
    const double r = d.norm();
    if (r > reach)
      continue;
    const int k =
        static_cast<int>((std::atan2(d.y(), d.x()) + units::PI) / (2 * units::PI) * N_ANGLES);
    bins[std::clamp(k, 0, N_ANGLES - 1)].push_back(r);
  }
  for (int k = 0; k < N_ANGLES; ++k)
    if (!bins[k].empty()) {
      layer.radius[k] = upper_median(bins[k]);
      const double theta = -units::PI + (k + 0.5) * 2 * units::PI / N_ANGLES;
      layer.outline[k] += layer.radius[k] * Vec2(std::cos(theta), std::sin(theta));
    }
  return layer;
}

/// The angle of (x, y) from +x in -pi .. pi within 2e-8 rad: what is interpolated between columns
/// of four degrees asks no more, and the search for the mirror plane asks half a million times.
/// Polynomial of Abramowitz and Stegun 4.4.49.
double quick_angle(double y, double x) {
  const double ax = std::abs(x), ay = std::abs(y), larger = std::max(ax, ay);
  if (larger == 0)
    return 0;
  const double t = std::min(ax, ay) / larger, u = t * t;
  double angle = 0.0028662257;
  for (const double c : {-0.0161657367, 0.0429096138, -0.0752896400, 0.1065626393, -0.1420889944,
                         0.1999355085, -0.3333314528, 1.0})
    angle = angle * u + c;
  angle *= t;
  if (ay > ax)
    angle = units::PI / 2 - angle;
  if (x < 0)
    angle = units::PI - angle;
  return y < 0 ? -angle : angle;
}

/// How far the layers are from their mirror images in the upright plane through `offset` across,
/// turned by `angle`: the mean of the lower six tenths of |r - r'|, m. The layers are in the body
/// frame. `misses` is room to work in.
double asymmetry(std::span<const RadialLayer> layers, double angle, double offset,
                 std::vector<double>& misses) {
  const Vec2 normal(std::cos(angle), -std::sin(angle)); // of the mirror plane; +x at angle 0
  misses.clear();
  for (const RadialLayer& layer : layers)
    for (int k = 0; k < N_ANGLES; ++k) {
      if (layer.radius[k] < 0)
        continue;
      const Vec2& p = layer.outline[k];
      const Vec2 q = p - 2 * (normal.dot(p) - offset) * normal - layer.center;
      const double column = (quick_angle(q.y(), q.x()) + units::PI) / (2 * units::PI) * N_ANGLES -
                            0.5; // -0.5 to N_ANGLES - 0.5
      const int a = column < 0 ? N_ANGLES - 1 : static_cast<int>(column),
                b = a + 1 == N_ANGLES ? 0 : a + 1;
      if (layer.radius[a] < 0 || layer.radius[b] < 0)
        continue;
      const double w = column - std::floor(column);
      misses.push_back(std::abs(q.norm() - (1 - w) * layer.radius[a] - w * layer.radius[b]));
    }
  if (misses.size() < FEWEST)
    return 1e300;
  const auto middle = place_rank(misses, misses.size() * 6 / 10);
  double sum = 0;
  for (auto it = misses.begin(); it != middle; ++it)
    sum += *it;
  return sum / static_cast<double>(middle - misses.begin());
}

/// Layers of `points` (body frame, m) between two heights as outlines around about their middle.
std::vector<RadialLayer> trunk_outlines(const std::vector<Vec3>& points, double stature) {
  constexpr int N = 40;
  std::vector<std::vector<Vec2>> layers(N);
  for (const Vec3& p : points) {
    const int k = static_cast<int>(
        std::floor(N * (p.y() / stature - 0.5) / 0.3)); // trunk below the shoulders
    if (k >= 0 && k < N && std::hypot(p.x(), p.z()) < 0.2 * stature)
      layers[k].emplace_back(p.x(), p.z());
  }
  std::vector<RadialLayer> outlines;
  for (int k = 0; k < N; ++k) {
    if (layers[k].size() < 40)
      continue;
    Vec2 center = moments_of(layers[k], stature / 150).mean;
    center.x() *= 0.5;
    outlines.push_back(radial_layer(layers[k], center, 0.16 * stature));
    outlines.back().height = stature * (0.5 + 0.3 * (k + 0.5) / N);
  }
  return outlines;
}

} // namespace

Moments moments_of(const std::vector<Vec2>& points, double cell) {
  std::vector<std::pair<long, long>> cells;
  cells.reserve(points.size());
  for (const Vec2& p : points)
    cells.emplace_back(std::lround(p.x() / cell), std::lround(p.y() / cell));
  std::sort(cells.begin(), cells.end());
  cells.erase(std::unique(cells.begin(), cells.end()), cells.end());
  Moments m;
  for (const auto& c : cells)
    m.mean += cell * Vec2(static_cast<double>(c.first), static_cast<double>(c.second));
  m.n = static_cast<int>(cells.size());
  if (m.n == 0)
    return m;
  m.mean /= m.n;
  for (const auto& c : cells) {
    const Vec2 d =
        cell * Vec2(static_cast<double>(c.first), static_cast<double>(c.second)) - m.mean;
    m.xx += d.x() * d.x();
    m.xz += d.x() * d.y();
    m.zz += d.y() * d.y();
  }
  m.xx /= m.n;
  m.xz /= m.n;
  m.zz /= m.n;
  return m;
}

std::optional<MirrorPlane> mirror_plane(const std::vector<Vec3>& points, double stature) {
  const std::vector<RadialLayer> layers = trunk_outlines(points, stature);
  std::vector<double> misses;
  double angle = 0, offset = 0;
  double angle_step = units::radians(2.0), offset_step = 0.004 * stature;
  for (int round = 0; round < 4; ++round) {
    double best = 1e300, best_angle = angle, best_offset = offset;
    const int n = round == 0 ? 4 : 2;
    for (int i = -n; i <= n; ++i)
      for (int j = -n; j <= n; ++j) {
        const double miss =
            asymmetry(layers, angle + i * angle_step, offset + j * offset_step, misses) *
            (1 + 1e-6 * (std::abs(i) + std::abs(j)));
        if (miss < best) {
          best = miss;
          best_angle = angle + i * angle_step;
          best_offset = offset + j * offset_step;
        }
      }
    if (best > 1e299)
      return std::nullopt;
    angle = best_angle;
    offset = best_offset;
    angle_step /= 2.5;
    offset_step /= 2.5;
  }
  return MirrorPlane{angle, offset};
}

std::optional<double> mirror_roll(const std::vector<Vec3>& points, double stature) {
  constexpr std::size_t GROUP = 4; // layers: one alone tells too little
  const std::vector<RadialLayer> layers = trunk_outlines(points, stature);
  std::vector<Vec2> middles; // height, offset
  std::vector<double> misses;
  for (std::size_t k = 0; k + GROUP <= layers.size(); k += GROUP) {
    const std::span<const RadialLayer> group(layers.data() + k, GROUP);
    double offset = 0, best = 1e300;
    for (double step = 0.01 * stature; step > 1e-4; step /= 3) {
      const double around = offset;
      for (int i = -3; i <= 3; ++i)
        if (const double miss =
                asymmetry(group, 0, around + i * step, misses) * (1 + 1e-6 * std::abs(i));
            miss < best) {
          best = miss;
          offset = around + i * step;
        }
    }
    if (best < 1e299)
      middles.emplace_back(group[GROUP / 2].height, offset);
  }
  std::vector<double> slopes; // their median (Theil 1950, Sen 1968)
  for (std::size_t i = 0; i < middles.size(); ++i)
    for (std::size_t j = 0; j < i; ++j)
      if (const double rise = middles[i].x() - middles[j].x(); rise > 0.1 * stature)
        slopes.push_back((middles[i].y() - middles[j].y()) / rise);
  if (slopes.size() < 8)
    return std::nullopt;
  return std::atan(upper_median(slopes));
}

} // namespace sloper::body
