#include <Eigen/Cholesky>
#include <body/landmarks/landmark_finder.hpp>
#include <body/measure/narrowest_neck.hpp>
#include <sloper/base/units.hpp>

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace sloper::body {

namespace {

/// Length of the closed curve of four quarter ellipses through front, left, back and right.
double ring_length(const std::array<Vec3, 4>& corner) {
  const Vec3 middle = 0.5 * (corner[0] + corner[2]);
  constexpr int STEPS = 16;
  double length = 0;
  Vec3 last = corner[0];
  for (int k = 0; k < 4; ++k)
    for (int i = 1; i <= STEPS; ++i) {
      const double a = 0.5 * units::PI * i / STEPS;
      const Vec3 p = middle + std::cos(a) * (corner[k] - middle) +
                     std::sin(a) * (corner[(k + 1) % 4] - middle);
      length += (p - last).norm();
      last = p;
    }
  return length;
}

/// Length of the circle that fits the points best (Kasa 1976: least squares of |p|^2 - 2 c.p - k);
/// 0 for too few of them.
double circle_through(const std::vector<Vec2>& points) {
  if (points.size() < 10)
    return 0;
  Eigen::Matrix3d squares = Eigen::Matrix3d::Zero();
  Vec3 right = Vec3::Zero();
  for (const Vec2& p : points) {
    const Vec3 row(2 * p.x(), 2 * p.y(), 1);
    squares += row * row.transpose();
    right += p.squaredNorm() * row;
  }
  const Vec3 fit = squares.ldlt().solve(right);
  const double r2 = fit.z() + fit.head<2>().squaredNorm();
  return r2 > 0 ? 2 * units::PI * std::sqrt(r2) : 0;
}

constexpr double TOO_WIDE = 1.35; ///< of the usual girth: the section has run into the trunk
/// m: of a fresh scan whose arms had grown together with the trunk both upper arms were 47 to 50 mm
/// too small.
constexpr double TOUCHING_ERROR = 0.05;

/// Girth of an arm in a plane through `center`; 0 where there is no section. Where the arm hangs on
/// the trunk there, `outward` is not zero and `usual` is exceeded, the circle through the outline
/// of the free side stands for it.
struct ArmGirth {
  double value = 0;
  bool touches = false;
};

ArmGirth arm_girth(const Finder& f, const ArmTrace& arm, const Vec3& center, const Vec3& axis,
                   double usual) {
  const double reach = 0.09 * f.s;
  const Plane plane = cross_plane(center, axis);
  const std::vector<Loop> loops = cut(f.levels.skin(), plane, &arm.triangles);
  const Loop* nearest = nullptr;
  for (const Loop& loop : loops)
    if (loop.area > 0 && loop.centroid.norm() < (nearest ? nearest->centroid.norm() : 0.05 * f.s))
      nearest = &loop;
  ArmGirth girth;
  if (nearest)
    girth.value = taut_girth(*nearest);
  if (nearest && girth.value < TOO_WIDE * usual)
    return girth;
  // the free side faces away from the body's middle plane, square to the arm
  const Vec3 out = (arm.left ? Vec3::UnitX() : Vec3(-Vec3::UnitX())) -
                   (arm.left ? axis.x() : -axis.x()) / axis.squaredNorm() * axis;
  std::vector<Vec2> points;
  for (const Loop& loop : loops)
    for (const auto& segment : loop.segments)
      if (const Vec3 d = plane.point(segment[0]) - center; d.dot(out) >= 0 && d.norm() < reach)
        points.push_back(segment[0]);
  girth.value = circle_through(points);
  girth.touches = true;
  if (girth.value > TOO_WIDE * usual || girth.value < 0.6 * usual)
    girth.value = 0; // that side is not free either
  return girth;
}

/// A taut tape from the waist in front, through between the legs, to the waist behind: the hull of
/// the trunk's outline beside the middle plane, without its upper side. It spans the cleft of the
/// seat. 0 where the trunk is not seen.
double crotch_length(const Finder& f) {
  constexpr double BESIDE = 0.03, STEP = 0.005; // of stature
  const auto waist = f.body.levels.find("waist_semantic");
  if (!f.has("crotch") || waist == f.body.levels.end())
    return 0;
  const Vec3& crotch = f.at("crotch");
  const double top = waist->second.y;
  std::vector<Vec2> outline = {Vec2(crotch.z(), crotch.y())};
  const int n = std::max(2, static_cast<int>((top - crotch.y()) / (STEP * f.s)));
  double across = 0;
  for (int k = 1; k <= n; ++k) {
    const double y = crotch.y() + (top - crotch.y()) * k / n;
    const auto profile = midline(f.levels, y, crotch.x(), BESIDE * f.s);
    if (!profile)
      continue;
    outline.emplace_back(profile->front, y);
    outline.emplace_back(profile->back, y);
    if (k == n)
      across = profile->front - profile->back;
  }
  return across > 0 ? closed_length(convex_hull(outline)) - across : 0;
}

/// Length of the neck's middle by four places of the skin: neck rings run higher at the sides than
/// in front. 0 where one of them is not seen.
double neck_ring(const Finder& f, const Vec3& front, const Vec3& back, const Vec3& center) {
  const double s = f.s;
  const double rise = f.number("neck.girth_up") * s, side_rise = f.number("neck.girth_up_side") * s;
  const auto fore = midline(f.levels, front.y() + rise, center.x(), 0.006 * s),
             rear = midline(f.levels, back.y() + rise, center.x(), 0.008 * s);
  const auto& sides = f.levels.trunk_at(center.y() + side_rise);
  if (!fore || !rear || !sides)
    return 0;
  double left = -1e300, right = 1e300;
  for (const auto& seg : sides->segments)
    if (const auto piece = clipped(seg, 1, center.z() - 0.009 * s, center.z() + 0.015 * s))
      for (const Vec2& q : *piece) {
        left = std::max(left, q.x());
        right = std::min(right, q.x());
      }
  if (left <= right)
    return 0;
  // the slope of the shoulders makes this breadth uncertain; the narrowest breadth of the neck is
  // not
  double narrowest = 1e300;
  for (double y = 0.84 * s; y < 0.90 * s; y += 0.004 * s)
    if (const auto& loop = f.levels.trunk_at(y))
      narrowest = std::min(narrowest, loop->size().x());
  const double middle = 0.5 * (left + right),
               half = 0.5 * f.number("neck.breadth_to_narrowest") * narrowest;
  const double measured = std::min(0.5 * (left - right), 1.12 * half);
  left = middle + 0.5 * (measured + half);
  right = middle - 0.5 * (measured + half);
  const double y = center.y() + side_rise, z = center.z() + 0.003 * s;
  return f.number("neck.ring_factor") *
         ring_length({Vec3(center.x(), front.y() + rise, fore->front), Vec3(left, y, z),
                      Vec3(center.x(), back.y() + rise, rear->back), Vec3(right, y, z)});
}

/// Puts the girths of the neck and of its base. The neck's is the mean of two independent methods:
/// the ring, which a bent head lengthens, and the least section, which it does not. Of 44 fresh
/// bodies in natural stances the ring is off by 14.8 mm on average and by 33 mm in 19 of 20, the
/// mean of both by 9.6 and 22. Where they disagree, half of that is the spread.
void find_neck_girths(const Finder& f) {
  /// m, root mean square errors on these bodies: of the mean, of one method alone, of the base
  constexpr double NECK_ERROR = 0.012, ALONE_ERROR = 0.018, BASE_ERROR = 0.020;
  /// Of the section: a ring longer than this has run over the chin of a bent head, and does not
  /// count; it counts half from LONG_RING down.
  constexpr double LONG_RING = 1.2, CHIN = 1.3;
  if (!f.has("neck_back") || !f.has("neck_front") || !f.has("neck_center"))
    return;
  const Vec3 back = f.at("neck_back"), front = f.at("neck_front"), center = f.at("neck_center");
  const bool has_sides = f.has("neck_side_l") && f.has("neck_side_r");
  const Vec3 left = has_sides ? f.at("neck_side_l") : Vec3(center + Vec3::UnitX());
  const Vec3 right = has_sides ? f.at("neck_side_r") : center;
  const double ring = neck_ring(f, front, back, center);
  const auto narrowest =
      narrowest_neck(f.levels.skin(), center, (front - back).cross(left - right).normalized(), f.s);
  const double section = narrowest ? f.number("neck.of_narrowest") * narrowest->girth_m : ring;
  const bool has_both = ring > 0 && narrowest;
  const double of_ring =
      has_both ? std::clamp((CHIN - ring / section) / (CHIN - LONG_RING), 0.0, 1.0) : 1;
  const double girth =
      has_both ? section + 0.5 * of_ring * (ring - section) : std::max(ring, section);
  if (girth > 0)
    f.body.girths["neck"] = {girth, has_both && of_ring > 0
                                        ? std::max(NECK_ERROR, std::abs(girth - section))
                                        : ALONE_ERROR};
  char text[120];
  std::snprintf(text, sizeof text, "neck: %.3f m by its ring, %.3f m by its narrowest section",
                ring, section);
  f.explain(text);
  if (has_sides)
    f.body.girths["neck_base"] = {
        f.number("neck_base.ring_factor") * ring_length({front, left, back, right}), BASE_ERROR};
}

} // namespace

void find_girths(const Finder& f) {
  if (const double length = crotch_length(f); length > 0)
    f.body.girths["crotch_length"] = {length, 0.005};
  for (int side = 0; side < 2; ++side) {
    const std::string suffix = side_suffix(side);
    auto put = [&](const char* name, double value) {
      if (value > 0)
        f.body.girths[name + suffix] = {value, 0.003};
    };
    auto leg_girth = [&](double y) {
      const auto loop = f.levels.leg_at(y, side);
      return loop ? taut_girth(*loop) : 0.0;
    };
    if (f.has("crotch"))
      put("thigh", leg_girth(f.at("crotch").y() - 0.010));
    if (f.has("knee" + suffix) && f.has("ankle" + suffix)) {
      const double knee = f.at("knee" + suffix).y(), ankle = f.at("ankle" + suffix).y();
      put("knee", leg_girth(knee));
      double calf = 0, calf_y = 0, least = 1e300;
      for (double y = ankle; y < knee; y += 0.004)
        if (const double g = leg_girth(y); g > calf && y > ankle + 0.3 * (knee - ankle)) {
          calf = g;
          calf_y = y;
        }
      for (double y = ankle; y < calf_y; y += 0.004)
        if (const double g = leg_girth(y); g > 0)
          least = std::min(least, g);
      put("calf", calf);
      if (least < 1e299)
        put("ankle_min", least);
    }
    const ArmTrace& arm = f.arms[side];
    if (arm.sections.empty() || !f.has("elbow" + suffix) || !f.has("shoulder_joint" + suffix) ||
        !f.has("wrist" + suffix))
      continue;
    const Vec3 &shoulder = f.at("shoulder_joint" + suffix), &elbow = f.at("elbow" + suffix),
               &wrist = f.at("wrist" + suffix);
    const ArmGirth upper =
        arm_girth(f, arm, 0.5 * (shoulder + elbow), shoulder - elbow, arm.sections.back().girth);
    put("upper_arm", upper.value);
    if (upper.touches && upper.value > 0)
      f.body.girths["upper_arm" + suffix].spread_m = TOUCHING_ERROR;
    if (upper.touches)
      f.body.scan.findings.push_back(
          {"scan.arm-touches-trunk"_id, "warning",
           upper.value > 0
               ? "the upper arm touches the trunk: its girth is estimated from its free side"
               : "the upper arm touches the trunk: its girth cannot be measured",
           "upper_arm" + suffix});
    put("wrist", arm_girth(f, arm, wrist, elbow - wrist, 1e300).value);
  }
  find_neck_girths(f);
}

} // namespace sloper::body
