#include <body/ingest/canonical_frame.hpp>
#include <body/ingest/mirror.hpp>
#include <sloper/base/error.hpp>
#include <sloper/base/units.hpp>

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace sloper::body {

namespace {

constexpr double MIN_STATURE = 0.5, MAX_STATURE = 2.5; ///< m

std::string number_text(const char* format, double x) {
  char text[64];
  std::snprintf(text, sizeof text, format, x);
  return text;
}

/// How unlikely a person of this stature is, and a file in this unit: distance from the usual
/// stature, factors of e, and for what is rare a penalty.
double unlikeliness(const LengthUnit& unit, double stature) {
  constexpr double USUAL = 1.68, TALL = 2.1, TOO_TALL = 0.5;
  return std::abs(std::log(stature / USUAL)) + unit.rare + (stature > TALL ? TOO_TALL : 0.0);
}

std::vector<LengthUnit> likely_units(double height) {
  std::vector<LengthUnit> likely;
  for (const LengthUnit& unit : LENGTH_UNITS)
    if (const double stature = height * unit.metres;
        stature >= MIN_STATURE && stature <= MAX_STATURE)
      likely.push_back(unit);
  std::stable_sort(likely.begin(), likely.end(), [&](const LengthUnit& a, const LengthUnit& b) {
    return unlikeliness(a, height * a.metres) < unlikeliness(b, height * b.metres);
  });
  return likely;
}

LengthUnit choose_unit(double height, const SizeOptions& size, const std::string& file) {
  auto within = [&](const LengthUnit& unit, const char* option) {
    const double stature = height * unit.metres;
    if (stature >= MIN_STATURE && stature <= MAX_STATURE)
      return unit;
    throw input_error("scan.wrong-size"_id, file, "",
                      "the body would be " + number_text("%.3g", stature) + " m tall in " +
                          unit.name,
                      std::string("a person is 0.5 to 2.5 m; give another ") + option);
  };
  if (size.stature_m > 0)
    return within({"given stature", size.stature_m / height, 0}, "--stature");
  if (size.metres_per_unit > 0)
    return within({"given scale", size.metres_per_unit, 0}, "--scale");
  if (size.unit != "auto") {
    const auto named = std::find_if(std::begin(LENGTH_UNITS), std::end(LENGTH_UNITS),
                                    [&](const LengthUnit& u) { return size.unit == u.name; });
    if (named == std::end(LENGTH_UNITS))
      throw Error(ErrorKind::USAGE, "option.unknown-word"_id, "", "unit",
                  "'" + size.unit + "' is not a unit", "give auto, m, cm, mm, dm, inch or foot");
    return within(*named, "--unit");
  }
  const std::vector<LengthUnit> likely = likely_units(height);
  if (likely.empty())
    throw input_error(
        "scan.wrong-size"_id, file, "",
        "the body is " + number_text("%.4g", height) +
            " units tall, which is not a person's size in m, cm, mm, dm, inch or foot",
        "give its --stature in metres, or its --scale in metres for a unit");
  return likely.front();
}

/// Angle of the longer axis of a trunk layer, doubled so that opposite directions add up; length is
/// how clear it is.
Vec2 doubled_axis(const Moments& m) {
  return Vec2(m.xx - m.zz, 2 * m.xz) / std::max(m.xx + m.zz, 1e-12);
}

/// Unit vector, sign open, from one leg to the other, from the layers of the calves.
Vec2 leg_line(const std::vector<std::vector<Vec2>>& layers, int first, int last,
              const Vec2& rough_axis) {
  Vec2 sum = Vec2::Zero();
  for (int k = first; k < last; ++k) {
    Vec2 middle = Vec2::Zero();
    for (const Vec2& p : layers[k])
      middle += p;
    if (layers[k].size() < 8)
      continue;
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
        if (n[side])
          center[side] = total[side] / n[side];
    }
    Vec2 line = center[1] - center[0];
    if (line.dot(rough_axis) < 0)
      line = -line;
    sum += line;
  }
  return sum.norm() > 1e-9 ? Vec2(sum.normalized()) : Vec2::Zero();
}

} // namespace

std::string other_guess(double stature_m, const LengthUnit& own) {
  constexpr double NEAR = 0.6; // factors of e, as unlikeliness() has them
  const std::vector<LengthUnit> likely = likely_units(stature_m / own.metres);
  if (likely.size() < 2 || likely.front().metres != own.metres)
    return "";
  const double other = stature_m / own.metres * likely[1].metres;
  if (unlikeliness(likely[1], other) > unlikeliness(own, stature_m) + NEAR)
    return "";
  return number_text("%.2f m in ", other) + likely[1].name;
}

Mat4 turn_and_shift(double angle, const Vec3& shift) {
  const double c = std::cos(angle), s = std::sin(angle);
  Mat4 m = Mat4::Identity();
  m(0, 0) = c;
  m(0, 2) = s;
  m(2, 0) = -s;
  m(2, 2) = c;
  m.block<3, 1>(0, 3) = shift;
  return m;
}

Vec3 transform(const Mat4& m, const Vec3& p) {
  return m.block<3, 3>(0, 0) * p + m.block<3, 1>(0, 3);
}

void refine_heading(std::vector<Vec3> points, CanonicalFrame& frame) {
  for (Vec3& p : points)
    p = transform(frame.scan_to_body, p);
  // the mirror plane's normal (cos, -sin) becomes +x
  if (const auto mirror = mirror_plane(points, frame.stature_m))
    frame.scan_to_body =
        turn_and_shift(-mirror->angle, Vec3(-mirror->offset, 0, 0)) * frame.scan_to_body;
  const Vec3 facing = frame.scan_to_body.block<1, 3>(2, 0).transpose().normalized();
  frame.front = number_text("%.4f", facing.x()) + number_text(" %.4f", facing.y()) +
                number_text(" %.4f", facing.z());
}

CanonicalFrame guess_frame(const TriangleMesh& scan, const SegmentedScan& sorted,
                           const std::vector<Vec3>& shape, const SizeOptions& size,
                           const std::string& file) {
  CanonicalFrame frame;
  const double height = sorted.high - sorted.low;
  if (!shows_a_person(sorted))
    throw input_error("scan.no-person"_id, file, "",
                      sorted.head_share >= sorted.leg_share
                          ? "no standing person: no two legs in any axis direction"
                          : "no standing person: no head above the shoulders",
                      "a scan must show a whole standing body with its legs apart; check --up, cut "
                      "away what is not the body, or, for a torso without "
                      "head or legs, give --torso-only");
  if (sorted.second_share > 0.5)
    throw input_error("scan.two-people"_id, file, "", "two bodies stand in this scan",
                      "cut the scan so that one person is left");
  const LengthUnit chosen = choose_unit(height, size, file);
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
    if (!sorted.is_body[v])
      continue;
    const Vec3 p = upright * scan.positions[v] * chosen.metres;
    const int k = static_cast<int>(N_LAYERS * (p.y() - sorted.low * chosen.metres) / stature);
    layers[std::clamp(k, 0, N_LAYERS)].emplace_back(p.x(), p.z());
  }
  auto collect = [&](int first, int last) {
    std::vector<Vec2> points;
    for (int k = first; k < last; ++k)
      points.insert(points.end(), layers[k].begin(), layers[k].end());
    return points;
  };
  const double cell = stature / 150;
  const Moments calves = moments_of(collect(10, 30), cell);
  if (calves.n == 0)
    throw input_error("scan.no-person"_id, file, "", "no legs below the trunk",
                      "a scan must show a whole standing body");
  // left-right axis: trunk layers are wider than deep, legs stand side by side
  Vec2 doubled = Vec2::Zero();
  for (int k = 50; k < 72; ++k) {
    std::vector<Vec2> near;
    for (const Vec2& p : layers[k])
      if ((p - calves.mean).norm() < 0.16 * stature)
        near.push_back(p);
    if (near.size() > 8)
      doubled += doubled_axis(moments_of(near, cell)) / 22;
  }
  doubled += 2 * doubled_axis(calves);
  double angle = 0.5 * std::atan2(doubled.y(), doubled.x());
  Vec2 axis(std::cos(angle), std::sin(angle));
  const Vec2 legs = leg_line(layers, 10, 30, axis);
  if (legs.norm() > 0.5)
    axis = (axis + 2 * (legs.dot(axis) < 0 ? Vec2(-legs) : legs)).normalized();
  // facing: the foot reaches further forward of the ankle than back of it
  Vec2 forward(-axis.y(), axis.x());
  const Moments ankles = moments_of(collect(5, 9), cell);
  double front = 0, back = 0;
  std::vector<double> reach;
  for (const Vec2& p : collect(0, 4))
    reach.push_back((p - ankles.mean).dot(forward));
  if (reach.size() > 20) {
    std::sort(reach.begin(), reach.end());
    front = reach[reach.size() * 98 / 100];
    back = -reach[reach.size() * 2 / 100];
  }
  const double margin = std::abs(front - back) / std::max(front + back, 1e-9);
  if (back > front)
    forward = -forward;
  if (margin < 0.15)
    frame.findings.push_back({"scan.front-unclear"_id, "warning",
                              "the feet hardly show which way the body faces", "feet"});
  // +x is the body's left: x = y cross z
  const Vec3 z(forward.x(), 0, forward.y()), y = Vec3::UnitY(), x = y.cross(z);
  Eigen::Matrix3d heading;
  heading.row(0) = x.transpose();
  heading.row(1) = y.transpose();
  heading.row(2) = z.transpose();
  const Eigen::Matrix3d rotation = heading * upright;
  frame.scan_to_body.block<3, 3>(0, 0) = chosen.metres * rotation;
  const Vec3 foot(calves.mean.x(), sorted.low * chosen.metres, calves.mean.y());
  frame.scan_to_body.block<3, 1>(0, 3) = -(heading * foot);
  refine_heading(shape, frame);
  return frame;
}

} // namespace sloper::body
