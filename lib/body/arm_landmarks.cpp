#include <body/landmark_finder.hpp>

#include <algorithm>
#include <cmath>

namespace sloper::body {

namespace {

/// Highest skin point near (x, z), looked for among the triangles around the shoulder.
std::optional<Vec3> top_of_shoulder(const TriangleMesh& skin, const ArmTrace& arm, double x, double z, double radius) {
  std::optional<Vec3> top;
  for (const int t : arm.triangles)
    for (const int v : skin.triangles[t]) {
      const Vec3& p = skin.positions[v];
      if (std::hypot(p.x() - x, p.z() - z) > radius) continue;
      if (!top || p.y() > top->y()) top = p;
    }
  return top;
}

} // namespace

void find_arm_landmarks(const Finder& f) {
  const double s = f.s;
  const TriangleMesh& skin = f.levels.skin();
  for (int side = 0; side < 2; ++side) {
    const ArmTrace& arm = f.arms[side];
    const std::string suffix = side_suffix(side);
    if (arm.sections.empty()) continue;
    f.put("hand_tip" + suffix, arm.tip, 1, "farthest_over_the_skin", 0.9, 0.004);
    f.put("hand_extreme" + suffix, arm.tip, 1, "farthest_over_the_skin", 0.9, 0.004);
    Vec3 joint = arm.at(arm.length() + 0.02 * s);
    if (arm.axilla) {
      f.put("axilla" + suffix, *arm.axilla, 1, "gap_closes", 0.7, 0.008);
      f.put("axilla_front" + suffix, *arm.axilla_front, 1, "gap_closes_in_front", 0.5, 0.012);
      f.put("axilla_back" + suffix, *arm.axilla_back, 1, "gap_closes_behind", 0.5, 0.012);
      const Vec3 c = arm.at(arm.length());
      const auto top = top_of_shoulder(skin, arm, arm.axilla->x(), c.z(), 0.02 * s);
      if (top) {
        const double w = f.number("shoulder_joint.of_girdle");
        joint = Vec3(arm.axilla->x() - (arm.left ? 1 : -1) * 0.004 * s, (1 - w) * arm.axilla->y() + w * top->y(), c.z());
      }
    }
    f.put("shoulder_joint" + suffix, joint, 2, "between_arm_pit_and_shoulder", 0.6, 0.012);
    if (const auto top = top_of_shoulder(skin, arm, joint.x() + (arm.left ? 1 : -1) * 0.006 * s, joint.z() - 0.011 * s, 0.008 * s))
      f.put("acromion" + suffix, *top, 2, "above_shoulder_joint", 0.5, 0.012);
    const Vec3 along_tip = arm.tip;
    const double arm_length = (joint - along_tip).norm();
    const double hand = 0.5 * (f.number("hand.of_stature") * s + f.number("hand.of_arm") * arm_length);
    const Vec3 wrist = arm.at(hand);
    f.put("wrist" + suffix, wrist, 2, "arm_ratio", 0.6, 0.01);
    const double rest = (joint - wrist).norm() * (1 - f.number("elbow.of_arm"));
    const Vec3 elbow = arm.at(hand + rest);
    f.put("elbow" + suffix, elbow, 2, "arm_ratio", 0.5, 0.015);
    // the elbow's point: rearmost skin of the section through the joint
    const LimbSection* section = nullptr;
    for (const LimbSection& candidate : arm.sections)
      if (!section || std::abs(candidate.along - hand - rest) < std::abs(section->along - hand - rest)) section = &candidate;
    Vec3 back = elbow;
    for (const auto& seg : section->loop.segments) {
      const Vec3 p = section->plane.point(seg[0]);
      if (p.z() < back.z()) back = p;
    }
    f.put("olecranon" + suffix, back, 2, "rearmost_at_elbow", 0.5, 0.015);
  }
}

} // namespace sloper::body
