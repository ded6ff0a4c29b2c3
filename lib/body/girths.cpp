#include <body/landmark_finder.hpp>

#include <algorithm>
#include <cmath>

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
      const double a = 0.5 * 3.14159265358979323846 * i / STEPS;
      const Vec3 p = middle + std::cos(a) * (corner[k] - middle) + std::sin(a) * (corner[(k + 1) % 4] - middle);
      length += (p - last).norm();
      last = p;
    }
  return length;
}

} // namespace

void find_girths(const Finder& f) {
  const double s = f.s;
  for (int side = 0; side < 2; ++side) {
    const std::string suffix = side_suffix(side);
    auto put = [&](const char* name, double value) {
      if (value > 0) f.body.girths[name + suffix] = {value, 0.003};
    };
    auto leg_girth = [&](double y) {
      const auto loop = f.levels.leg_at(y, side);
      return loop ? taut_girth(*loop) : 0.0;
    };
    if (f.has("crotch")) put("thigh", leg_girth(f.at("crotch").y() - 0.010));
    if (f.has("knee" + suffix) && f.has("ankle" + suffix)) {
      const double knee = f.at("knee" + suffix).y(), ankle = f.at("ankle" + suffix).y();
      put("knee", leg_girth(knee));
      double calf = 0, calf_y = 0, least = 1e300;
      for (double y = ankle; y < knee; y += 0.004)
        if (const double g = leg_girth(y); g > calf && y > ankle + 0.3 * (knee - ankle)) calf = g, calf_y = y;
      for (double y = ankle; y < calf_y; y += 0.004)
        if (const double g = leg_girth(y); g > 0) least = std::min(least, g);
      put("calf", calf);
      if (least < 1e299) put("ankle_min", least);
    }
    const ArmTrace& arm = f.arms[side];
    if (!f.has("elbow" + suffix) || arm.sections.empty()) continue;
    auto arm_girth = [&](const Vec3& center, const Vec3& axis) {
      double girth = 0, nearest = 0.05 * s;
      for (const Loop& loop : cut(f.levels.skin(), cross_plane(center, axis), &arm.triangles))
        if (loop.area > 0 && loop.centroid.norm() < nearest) nearest = loop.centroid.norm(), girth = taut_girth(loop);
      return girth;
    };
    const Vec3 &shoulder = f.at("shoulder_joint" + suffix), &elbow = f.at("elbow" + suffix), &wrist = f.at("wrist" + suffix);
    put("upper_arm", arm_girth(0.5 * (shoulder + elbow), shoulder - elbow));
    put("wrist", arm_girth(wrist, elbow - wrist));
  }
  // neck rings run higher at the sides than in front: quarter ellipses through four points of the skin
  if (!f.has("neck_back") || !f.has("neck_front") || !f.has("neck_center")) return;
  const Vec3 back = f.at("neck_back"), front = f.at("neck_front"), center = f.at("neck_center");
  const double rise = f.number("neck.girth_up") * s, side_rise = f.number("neck.girth_up_side") * s;
  const auto fore = midline(f.levels, front.y() + rise, center.x(), 0.006 * s), rear = midline(f.levels, back.y() + rise, center.x(), 0.008 * s);
  const auto sides = f.levels.trunk_at(center.y() + side_rise);
  if (fore && rear && sides) {
    double left = -1e300, right = 1e300;
    for (const auto& seg : sides->segments)
      if (std::abs(seg[0].y() - center.z() - 0.003 * s) < 0.012 * s) left = std::max(left, seg[0].x()), right = std::min(right, seg[0].x());
    if (left > right) {
      // the slope of the shoulders makes this breadth uncertain; the narrowest breadth of the neck is not
      double narrowest = 1e300;
      for (double y = 0.84 * s; y < 0.90 * s; y += 0.004 * s)
        if (const auto loop = f.levels.trunk_at(y)) narrowest = std::min(narrowest, loop->size().x());
      const double middle = 0.5 * (left + right), half = 0.5 * f.number("neck.breadth_to_narrowest") * narrowest;
      const double measured = std::min(0.5 * (left - right), 1.12 * half);
      left = middle + 0.5 * (measured + half), right = middle - 0.5 * (measured + half);
      const double y = center.y() + side_rise, z = center.z() + 0.003 * s;
      const double ring =
          ring_length({Vec3(center.x(), front.y() + rise, fore->front), Vec3(left, y, z), Vec3(center.x(), back.y() + rise, rear->back), Vec3(right, y, z)});
      f.body.girths["neck"] = {f.number("neck.ring_factor") * ring, 0.008};
    }
  }
  if (f.has("neck_side_l") && f.has("neck_side_r"))
    f.body.girths["neck_base"] = {f.number("neck_base.ring_factor") * ring_length({front, f.at("neck_side_l"), back, f.at("neck_side_r")}), 0.012};
}

} // namespace sloper::body
