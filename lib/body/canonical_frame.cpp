#include <base/error.hpp>
#include <base/units.hpp>
#include <body/canonical_frame.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

namespace sloper::body {

namespace {

constexpr double MIN_STATURE = 0.5, MAX_STATURE = 2.5; ///< m

struct Unit {
  const char* name;
  double metres;
};
constexpr Unit UNITS[] = {{"m", 1}, {"cm", 0.01}, {"mm", 0.001}, {"inch", 0.0254}};

std::string number_text(const char* format, double x) {
  char text[64];
  std::snprintf(text, sizeof text, format, x);
  return text;
}

Unit guess_unit(double height, const std::string& wanted, const std::string& file) {
  for (const Unit& unit : UNITS) {
    if (wanted != "auto" && wanted != unit.name) continue;
    const double stature = height * unit.metres;
    if (stature >= MIN_STATURE && stature <= MAX_STATURE) {
      if (wanted == "auto" && std::string(unit.name) == "cm" && stature < 1.0) { // 26 to 98 inches would be 26 to 98 cm
        const double in_inches = height * UNITS[3].metres;
        if (in_inches > 1.3 && in_inches < 2.2) return UNITS[3];
      }
      return unit;
    }
  }
  if (wanted != "auto") {
    const double stature = height * (wanted == "m" ? 1 : wanted == "cm" ? 0.01 : 0.001);
    throw input_error(file, "", "the body would be " + number_text("%.3g", stature) + " m tall in " + wanted, "a person is 0.5 to 2.5 m; give another --unit");
  }
  throw input_error(file, "", "the body is " + number_text("%.4g", height) + " units tall, which is no person in m, cm, mm or inch",
                    "scale the scan to a known unit");
}

/// Mean position and the 2x2 covariance of horizontal points, each occupied cell counted once.
struct Moments {
  Vec2 mean = Vec2::Zero();
  double xx = 0, xz = 0, zz = 0;
  int n = 0;
};

Moments moments_of(std::vector<Vec2> points, double cell) {
  std::vector<std::pair<long, long>> cells;
  cells.reserve(points.size());
  for (const Vec2& p : points) cells.emplace_back(std::lround(p.x() / cell), std::lround(p.y() / cell));
  std::sort(cells.begin(), cells.end());
  cells.erase(std::unique(cells.begin(), cells.end()), cells.end());
  Moments m;
  for (const auto& c : cells) m.mean += cell * Vec2(static_cast<double>(c.first), static_cast<double>(c.second));
  m.n = static_cast<int>(cells.size());
  if (m.n == 0) return m;
  m.mean /= m.n;
  for (const auto& c : cells) {
    const Vec2 d = cell * Vec2(static_cast<double>(c.first), static_cast<double>(c.second)) - m.mean;
    m.xx += d.x() * d.x(), m.xz += d.x() * d.y(), m.zz += d.y() * d.y();
  }
  m.xx /= m.n, m.xz /= m.n, m.zz /= m.n;
  return m;
}

/// Angle of the longer axis of a trunk layer, doubled so that opposite directions add up; length is how clear it is.
Vec2 doubled_axis(const Moments& m) { return Vec2(m.xx - m.zz, 2 * m.xz) / std::max(m.xx + m.zz, 1e-12); }

/// Unit vector, sign open, from one leg to the other, from the layers of the calves.
Vec2 leg_line(const std::vector<std::vector<Vec2>>& layers, int first, int last, const Vec2& rough_axis) {
  Vec2 sum = Vec2::Zero();
  for (int k = first; k < last; ++k) {
    Vec2 middle = Vec2::Zero();
    for (const Vec2& p : layers[k]) middle += p;
    if (layers[k].size() < 8) continue;
    middle /= static_cast<double>(layers[k].size());
    // two means, started on both sides of the middle
    Vec2 center[2] = {middle - 0.1 * rough_axis, middle + 0.1 * rough_axis};
    for (int round = 0; round < 6; ++round) {
      Vec2 total[2] = {Vec2::Zero(), Vec2::Zero()};
      int n[2] = {0, 0};
      for (const Vec2& p : layers[k]) {
        const int side = (p - center[0]).squaredNorm() <= (p - center[1]).squaredNorm() ? 0 : 1;
        total[side] += p;
        ++n[side];
      }
      for (int side = 0; side < 2; ++side)
        if (n[side]) center[side] = total[side] / n[side];
    }
    Vec2 line = center[1] - center[0];
    if (line.dot(rough_axis) < 0) line = -line;
    sum += line;
  }
  return sum.norm() > 1e-9 ? Vec2(sum.normalized()) : Vec2::Zero();
}

/// Outline of one layer as radius over angle around its centre.
struct RadialLayer {
  Vec2 center;
  std::vector<double> radius; ///< negative where there is no point
};

constexpr int N_ANGLES = 90;

/// Median radius per angle of the points of one layer that are within `reach` of the centre.
RadialLayer radial_layer(const std::vector<Vec2>& points, const Vec2& center, double reach) {
  RadialLayer layer{center, std::vector<double>(N_ANGLES, -1)};
  std::vector<std::vector<double>> bins(N_ANGLES);
  for (const Vec2& p : points) {
    const Vec2 d = p - center;
    const double r = d.norm();
    if (r > reach) continue;
    const int k = static_cast<int>((std::atan2(d.y(), d.x()) + units::PI) / (2 * units::PI) * N_ANGLES);
    bins[std::clamp(k, 0, N_ANGLES - 1)].push_back(r);
  }
  for (int k = 0; k < N_ANGLES; ++k)
    if (!bins[k].empty()) {
      std::nth_element(bins[k].begin(), bins[k].begin() + static_cast<std::ptrdiff_t>(bins[k].size() / 2), bins[k].end());
      layer.radius[k] = bins[k][bins[k].size() / 2];
    }
  return layer;
}

/// How far the layers are from their mirror images in the upright plane through `offset` across, turned by `angle`:
/// the median of |r - r'|, m. The layers are in the body frame.
double asymmetry(const std::vector<RadialLayer>& layers, double angle, double offset) {
  const Vec2 normal(std::cos(angle), -std::sin(angle)); // of the mirror plane; +x at angle 0
  static const std::array<Vec2, N_ANGLES> rays = [] {
    std::array<Vec2, N_ANGLES> all;
    for (int k = 0; k < N_ANGLES; ++k) {
      const double theta = -units::PI + (k + 0.5) * 2 * units::PI / N_ANGLES;
      all[k] = Vec2(std::cos(theta), std::sin(theta));
    }
    return all;
  }();
  std::vector<double> misses;
  for (const RadialLayer& layer : layers)
    for (int k = 0; k < N_ANGLES; ++k) {
      if (layer.radius[k] < 0) continue;
      const Vec2 p = layer.center + layer.radius[k] * rays[k];
      const Vec2 q = p - 2 * (normal.dot(p) - offset) * normal - layer.center;
      const double column = (std::atan2(q.y(), q.x()) + units::PI) / (2 * units::PI) * N_ANGLES - 0.5;
      const int a = ((static_cast<int>(std::floor(column)) % N_ANGLES) + N_ANGLES) % N_ANGLES, b = (a + 1) % N_ANGLES;
      if (layer.radius[a] < 0 || layer.radius[b] < 0) continue;
      const double w = column - std::floor(column);
      misses.push_back(std::abs(q.norm() - (1 - w) * layer.radius[a] - w * layer.radius[b]));
    }
  if (misses.size() < 100) return 1e300;
  const auto middle = misses.begin() + static_cast<std::ptrdiff_t>(misses.size() * 6 / 10);
  std::nth_element(misses.begin(), middle, misses.end());
  double sum = 0;
  for (auto it = misses.begin(); it != middle; ++it) sum += *it;
  return sum / static_cast<double>(middle - misses.begin());
}

/// Turns and shifts the frame so that the trunk is its own mirror image: the legs alone tell the heading to a few degrees.
Mat4 refine_by_symmetry(const TriangleMesh& scan, const SortedScan& sorted, const Mat4& scan_to_body, double stature) {
  constexpr int N = 60;
  std::vector<std::vector<Vec2>> points(N);
  const std::size_t stride = 1 + scan.positions.size() / 60000; // medians of radii need no more
  for (std::size_t v = 0; v < scan.positions.size(); v += stride) {
    if (!sorted.is_body[v]) continue;
    const Vec3 p = transform(scan_to_body, scan.positions[v]);
    const int k = static_cast<int>(N * (p.y() / stature - 0.5) / 0.3); // trunk below the shoulders
    if (k >= 0 && k < N && std::hypot(p.x(), p.z()) < 0.2 * stature) points[k].emplace_back(p.x(), p.z());
  }
  std::vector<RadialLayer> layers;
  for (const auto& layer : points) {
    if (layer.size() < 40) continue;
    Vec2 center = moments_of(layer, stature / 150).mean;
    center.x() *= 0.5;
    layers.push_back(radial_layer(layer, center, 0.16 * stature));
  }
  double angle = 0, offset = 0;
  double angle_step = units::radians(2.0), offset_step = 0.004 * stature;
  for (int round = 0; round < 4; ++round) {
    double best = 1e300, best_angle = angle, best_offset = offset;
    const int n = round == 0 ? 4 : 2;
    for (int i = -n; i <= n; ++i)
      for (int j = -n; j <= n; ++j) {
        const double miss = asymmetry(layers, angle + i * angle_step, offset + j * offset_step) * (1 + 1e-6 * (std::abs(i) + std::abs(j)));
        if (miss < best) best = miss, best_angle = angle + i * angle_step, best_offset = offset + j * offset_step;
      }
    if (best > 1e299) return scan_to_body;
    angle = best_angle, offset = best_offset;
    angle_step /= 2.5, offset_step /= 2.5;
  }
  // the mirror plane's normal (cos, -sin) becomes +x
  const Mat4 turn = turn_and_shift(-angle, Vec3(-offset, 0, 0));
  return turn * scan_to_body;
}

} // namespace

Mat4 turn_and_shift(double angle, const Vec3& shift) {
  const double c = std::cos(angle), s = std::sin(angle);
  Mat4 m = Mat4::Identity();
  m(0, 0) = c, m(0, 2) = s, m(2, 0) = -s, m(2, 2) = c;
  m.block<3, 1>(0, 3) = shift;
  return m;
}

Vec3 transform(const Mat4& m, const Vec3& p) { return m.block<3, 3>(0, 0) * p + m.block<3, 1>(0, 3); }

CanonicalFrame guess_frame(const TriangleMesh& scan, const SortedScan& sorted, const std::string& unit, const std::string& file) {
  CanonicalFrame frame;
  const double height = sorted.high - sorted.low;
  if (!shows_a_person(sorted))
    throw input_error(file, "",
                      sorted.head_share >= sorted.leg_share ? "no standing person: no two legs in any axis direction"
                                                            : "no standing person: no head above the shoulders",
                      "a scan must show a whole standing body with its legs apart; check --up, cut away what is not the body, or, for a torso without "
                      "legs, give --torso-only");
  if (sorted.second_share > 0.5) throw input_error(file, "", "two bodies stand in this scan", "cut the scan so that one person is left");
  const Unit chosen = guess_unit(height, unit, file);
  frame.unit = chosen.name;
  const double stature = height * chosen.metres;
  frame.stature_m = stature;

  // y up, metres, heading still the scan's
  Eigen::Matrix3d upright = Eigen::Matrix3d::Identity();
  const Vec3 up = sorted.up;
  const Vec3 side = up.x() != 0 ? Vec3::UnitY() : Vec3::UnitX();
  upright.row(1) = up.transpose();
  upright.row(0) = side.transpose();
  upright.row(2) = side.cross(up).transpose();
  constexpr int N_LAYERS = 100;
  std::vector<std::vector<Vec2>> layers(N_LAYERS + 1);
  for (std::size_t v = 0; v < scan.positions.size(); ++v) {
    if (!sorted.is_body[v]) continue;
    const Vec3 p = upright * scan.positions[v] * chosen.metres;
    const int k = static_cast<int>(N_LAYERS * (p.y() - sorted.low * chosen.metres) / stature);
    layers[std::clamp(k, 0, N_LAYERS)].emplace_back(p.x(), p.z());
  }
  auto collect = [&](int first, int last) {
    std::vector<Vec2> points;
    for (int k = first; k < last; ++k) points.insert(points.end(), layers[k].begin(), layers[k].end());
    return points;
  };
  const double cell = stature / 150;
  const Moments calves = moments_of(collect(10, 30), cell);
  if (calves.n == 0) throw input_error(file, "", "no legs below the trunk", "a scan must show a whole standing body");
  // left-right axis: trunk layers are wider than deep, legs stand side by side
  Vec2 doubled = Vec2::Zero();
  for (int k = 50; k < 72; ++k) {
    std::vector<Vec2> near;
    for (const Vec2& p : layers[k])
      if ((p - calves.mean).norm() < 0.16 * stature) near.push_back(p);
    if (near.size() > 8) doubled += doubled_axis(moments_of(near, cell)) / 22;
  }
  doubled += 2 * doubled_axis(calves);
  double angle = 0.5 * std::atan2(doubled.y(), doubled.x());
  Vec2 axis(std::cos(angle), std::sin(angle));
  const Vec2 legs = leg_line(layers, 10, 30, axis);
  if (legs.norm() > 0.5) axis = (axis + 2 * (legs.dot(axis) < 0 ? Vec2(-legs) : legs)).normalized();
  // facing: the foot reaches further forward of the ankle than back of it
  Vec2 forward(-axis.y(), axis.x());
  const Moments ankles = moments_of(collect(5, 9), cell);
  double front = 0, back = 0;
  std::vector<double> reach;
  for (const Vec2& p : collect(0, 4)) reach.push_back((p - ankles.mean).dot(forward));
  if (reach.size() > 20) {
    std::sort(reach.begin(), reach.end());
    front = reach[reach.size() * 98 / 100];
    back = -reach[reach.size() * 2 / 100];
  }
  const double margin = std::abs(front - back) / std::max(front + back, 1e-9);
  if (back > front) forward = -forward;
  if (margin < 0.15) frame.findings.push_back({"warning", "the feet hardly show which way the body faces", "feet"});
  // +x is the body's left: x = y cross z
  const Vec3 z(forward.x(), 0, forward.y()), y = Vec3::UnitY(), x = y.cross(z);
  Eigen::Matrix3d heading;
  heading.row(0) = x.transpose(), heading.row(1) = y.transpose(), heading.row(2) = z.transpose();
  const Eigen::Matrix3d rotation = heading * upright;
  frame.scan_to_body.block<3, 3>(0, 0) = chosen.metres * rotation;
  const Vec3 foot(calves.mean.x(), sorted.low * chosen.metres, calves.mean.y());
  frame.scan_to_body.block<3, 1>(0, 3) = -(heading * foot);
  frame.scan_to_body = refine_by_symmetry(scan, sorted, frame.scan_to_body, stature);
  const Vec3 facing = frame.scan_to_body.block<1, 3>(2, 0).transpose().normalized();
  frame.front = number_text("%.4f", facing.x()) + number_text(" %.4f", facing.y()) + number_text(" %.4f", facing.z());
  return frame;
}

} // namespace sloper::body
