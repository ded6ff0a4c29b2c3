#include <body/landmark_finder.hpp>

#include <algorithm>
#include <cmath>
#include <optional>

namespace sloper::body {

namespace {

/// Height of the hollow behind the knee: where the back of the leg comes furthest forward.
std::optional<double> hollow_of_knee(const Finder& f, int side, double around) {
  std::optional<double> best;
  double foremost = -1e300;
  for (double y = around - 0.03 * f.s; y <= around + 0.06 * f.s; y += 0.0025 * f.s)
    if (const auto loop = f.levels.leg_at(y, side); loop && loop->low.y() > foremost) foremost = loop->low.y(), best = y;
  // at the end of the search there is no hollow
  if (best && (*best < around - 0.027 * f.s || *best > around + 0.057 * f.s)) return std::nullopt;
  return best;
}

/// Foremost and rearmost points of the foot. On a rough scan the mean of three, and only points with company.
void find_foot_ends(const Finder& f, int side, double ankle_y) {
  const double sign = side == 0 ? 1 : -1;
  const std::vector<Vec3>& points = f.rebuilt ? f.scan_points : f.levels.skin().positions;
  std::vector<int> foot;
  for (std::size_t v = 0; v < points.size(); ++v)
    if (points[v].y() <= ankle_y && points[v].y() > -0.01 * f.s && sign * points[v].x() > 0) foot.push_back(static_cast<int>(v));
  const std::size_t wanted = f.rebuilt ? 3 : 1;
  if (foot.size() < 10) return;
  for (const double direction : {1.0, -1.0}) {
    std::partial_sort(foot.begin(), foot.begin() + static_cast<std::ptrdiff_t>(wanted), foot.end(), [&](int a, int b) {
      const double za = direction * points[a].z(), zb = direction * points[b].z();
      return za != zb ? za > zb : a < b;
    });
    Vec3 mean = Vec3::Zero();
    for (std::size_t k = 0; k < wanted; ++k) mean += points[foot[k]] / static_cast<double>(wanted);
    f.put(std::string(direction > 0 ? "foot_tip" : "heel") + side_suffix(side), mean, 1, direction > 0 ? "foremost_of_foot" : "rearmost_of_foot", 0.95, 0.002);
  }
}

} // namespace

void find_leg_landmarks(const Finder& f) {
  const double s = f.s;
  if (!f.levels.crotch()) return;
  const double crotch_y = *f.levels.crotch();
  f.put("crotch", Vec3(f.levels.crotch_point().x(), crotch_y, f.levels.crotch_point().y()), 1, f.crotch_moved ? "below_buttocks" : "leg_sections_merge",
        f.crotch_moved ? 0.3 : 0.9, f.crotch_moved ? 0.02 : 0.003);
  for (int side = 0; side < 2; ++side) {
    const std::string suffix = side_suffix(side);
    const double sign = side == 0 ? 1 : -1;
    const double ankle_y = f.number("ankle.height") * s;
    find_foot_ends(f, side, ankle_y);
    const auto top = f.levels.leg_at(crotch_y - 0.010, side);
    if (!top) continue;
    f.put("leg_top" + suffix, Vec3(top->centroid.x(), crotch_y - 0.010, top->centroid.y()), 2, "section_under_crotch", 0.9, 0.003);
    // the leg's middle leans out with fat and in with muscle: half of it, half the usual breadth between the joints
    const double hip_x = 0.5 * (top->centroid.x() + sign * (f.number("hip_joint.from_leg_top") + f.number("hip_joint.aside")) * s);
    const Vec3 hip(hip_x, crotch_y + f.number("hip_joint.above_crotch") * s, top->centroid.y() - f.number("hip_joint.behind_leg_top") * s);
    f.put("hip_joint" + suffix, hip, 2, "above_leg_top", 0.6, 0.012);
    f.also("hip_joint" + suffix, Vec3(top->centroid.x() + sign * f.number("hip_joint.from_leg_top") * s, hip.y(), hip.z()));
    f.also("hip_joint" + suffix, Vec3(sign * f.number("hip_joint.aside") * s, hip.y(), hip.z()));
    if (const auto ankle = f.levels.leg_at(ankle_y, side)) {
      // the section at this height holds the heel's upper rim: its middle in x, the joint lies nearer to the heel
      const Vec3 joint(ankle->center().x() - sign * 0.0015 * s, ankle_y, ankle->low.y() + f.number("ankle.from_behind") * ankle->size().y());
      f.put("ankle" + suffix, joint, 2, "height_ratio", 0.7, 0.006);
      double best = -1e300;
      Vec2 outer = Vec2::Zero();
      for (const auto& seg : ankle->segments)
        if (sign * seg[0].x() > best) best = sign * seg[0].x(), outer = seg[0];
      f.put("malleolus" + suffix, Vec3(outer.x(), ankle_y, outer.y()), 2, "outermost_at_ankle", 0.6, 0.006);
      double knee_y = ankle_y + f.number("knee.of_leg") * (hip.y() - ankle_y);
      const double knee_by_ratio = knee_y;
      std::optional<double> knee_by_hollow;
      const char* knee_rule = "leg_ratio";
      if (const auto hollow = hollow_of_knee(f, side, knee_y)) {
        knee_by_hollow = *hollow - f.number("knee.below_hollow") * s;
        knee_y = 0.5 * (knee_y + *knee_by_hollow);
        knee_rule = "leg_ratio_and_hollow";
      }
      if (const auto knee = f.levels.leg_at(knee_y, side)) {
        Vec2 cap = knee->segments.front()[0];
        for (const auto& seg : knee->segments)
          if (seg[0].y() > cap.y()) cap = seg[0];
        f.put("patella" + suffix, Vec3(cap.x(), knee_y, cap.y()), 2, "foremost_at_knee", 0.7, 0.01);
        const Vec3 joint_of_knee(knee->center().x(), knee_y, cap.y() - f.number("knee.behind_patella") * s);
        f.put("knee" + suffix, joint_of_knee, 2, knee_rule, 0.6, 0.012);
        f.also("knee" + suffix, Vec3(joint_of_knee.x(), knee_by_ratio, joint_of_knee.z()));
        if (knee_by_hollow) f.also("knee" + suffix, Vec3(joint_of_knee.x(), *knee_by_hollow, joint_of_knee.z()));
      }
    }
  }
  if (f.has("hip_joint_l") && f.has("hip_joint_r"))
    f.put("hip_center", 0.5 * (f.at("hip_joint_l") + f.at("hip_joint_r")), 2, "middle_of_hip_joints", 0.6, 0.01);
}

} // namespace sloper::body
