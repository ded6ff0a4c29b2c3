#include <body/landmark_finder.hpp>

#include <algorithm>
#include <cmath>

namespace sloper::body {

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
  // neck: square to its axis a little above the base, and around the base itself
  if (!f.has("neck_back") || !f.has("neck_front")) return;
  const Vec3 back = f.at("neck_back"), front = f.at("neck_front");
  const double rise = f.number("neck.girth_up") * s;
  auto ring = [&](const Vec3& rear, const Vec3& fore) {
    const Vec3 middle = 0.5 * (rear + fore), axis = Vec3::UnitX().cross(fore - rear);
    double girth = 0;
    for (const Loop& loop : cut(f.levels.skin(), cross_plane(middle, -axis)))
      if (encloses(loop, Vec2::Zero())) girth = std::max(girth, taut_girth(loop));
    return girth;
  };
  if (const double g = ring(back + Vec3(0, rise, 0.4 * rise), front + Vec3(0, rise, 0)); g > 0 && g < 0.4 * s) f.body.girths["neck"] = {g, 0.008};
  // the base ring runs over the side neck points: two arcs of the ellipse through the four points
  if (f.has("neck_side_l") && f.has("neck_side_r")) {
    const Vec3 middle = 0.5 * (back + front);
    double length = 0;
    Vec3 last = front;
    const Vec3 corner[5] = {front, f.at("neck_side_l"), back, f.at("neck_side_r"), front};
    for (int k = 0; k < 4; ++k)
      for (int i = 1; i <= 16; ++i) {
        const double a = 1.5707963267948966 * i / 16;
        const Vec3 p = middle + std::cos(a) * (corner[k] - middle) + std::sin(a) * (corner[k + 1] - middle);
        length += (p - last).norm();
        last = p;
      }
    f.body.girths["neck_base"] = {length, 0.012};
  }
}

} // namespace sloper::body
