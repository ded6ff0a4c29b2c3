#include <base/units.hpp>
#include <body/landmark_finder.hpp>

#include <algorithm>
#include <cmath>

namespace sloper::body {

namespace {

constexpr double FLAT = 0.001; ///< m

/// The skin straight above (x, z), below the head.
std::optional<Vec3> top_of_shoulder(const TriangleMesh& skin, double stature, double x, double z) {
  std::optional<Vec3> top;
  for (const Triangle& t : skin.triangles) {
    const Vec3 &a = skin.positions[t[0]], &b = skin.positions[t[1]], &c = skin.positions[t[2]];
    if (std::min({a.x(), b.x(), c.x()}) > x || std::max({a.x(), b.x(), c.x()}) < x || std::min({a.z(), b.z(), c.z()}) > z ||
        std::max({a.z(), b.z(), c.z()}) < z)
      continue;
    if (a.y() > 0.9 * stature) continue;
    const double area = (b.x() - a.x()) * (c.z() - a.z()) - (c.x() - a.x()) * (b.z() - a.z());
    if (std::abs(area) < 1e-14) continue;
    const double u = ((x - a.x()) * (c.z() - a.z()) - (c.x() - a.x()) * (z - a.z())) / area,
                 v = ((b.x() - a.x()) * (z - a.z()) - (x - a.x()) * (b.z() - a.z())) / area;
    if (u < 0 || v < 0 || u + v > 1) continue;
    const double y = a.y() + u * (b.y() - a.y()) + v * (c.y() - a.y());
    if (!top || y > top->y()) top = Vec3(x, y, z);
  }
  return top;
}

/// Where the wrist is: behind the widest of the hand the girth falls to its least. Empty when it does not. The search
/// starts at the palm, so that a fist, whose hand is short, has a wrist too.
std::optional<double> wrist_by_girth(const ArmTrace& arm, double s) {
  const auto& sections = arm.sections;
  std::size_t palm = 0;
  for (std::size_t k = 0; k < sections.size() && sections[k].along < 0.11 * s; ++k)
    if (sections[k].girth > sections[palm].girth) palm = k;
  if (sections.empty() || sections[palm].along > 0.105 * s) return std::nullopt; // still rising: no palm
  std::size_t least = palm;
  for (std::size_t k = palm + 1; k + 1 < sections.size() && sections[k].along < sections[palm].along + 0.085 * s; ++k)
    if (sections[k].girth < 0.995 * sections[least].girth) least = k;
  if (sections[least].girth > 0.92 * sections[palm].girth) return std::nullopt;
  double sum = 0, weight = 0; // the middle of where it is as thin as makes no difference
  for (std::size_t k = palm + 1; k + 1 < sections.size() && sections[k].along < sections[palm].along + 0.085 * s; ++k) {
    const double w = std::max(0.0, 1.015 * sections[least].girth - sections[k].girth);
    if (std::abs(sections[k].along - sections[least].along) < 0.02 * s) sum += w * sections[k].along, weight += w;
  }
  return sum / weight;
}

/// Where the upper arm starts to swell above the elbow: the steepest rise of girth past the forearm's belly.
std::optional<double> elbow_by_girth(const ArmTrace& arm, double s, double wrist) {
  const auto& sections = arm.sections;
  std::optional<double> best;
  double steepest = 0;
  for (std::size_t k = 3; k + 3 < sections.size(); ++k) {
    const double along = sections[k].along;
    if (along < wrist + 0.10 * s || along > wrist + 0.185 * s) continue;
    double rise = 0;
    for (std::size_t j = 1; j <= 3; ++j) rise += (sections[k + j].girth - sections[k - j].girth) / (sections[k + j].along - sections[k - j].along) / 3;
    if (rise > steepest) steepest = rise, best = along;
  }
  return best;
}

} // namespace

void find_arm_landmarks(const Finder& f) {
  const double s = f.s;
  const TriangleMesh& skin = f.levels.skin();
  for (int side = 0; side < 2; ++side) {
    const ArmTrace& arm = f.arms[side];
    const std::string suffix = side_suffix(side);
    if (arm.sections.empty()) continue;
    const double outward = arm.left ? 1 : -1;
    const double raised = units::degrees(std::acos(std::clamp(-arm.out.y(), -1.0, 1.0))); // 0 hanging, 90 level
    f.put("hand_tip" + suffix, arm.tip, 1, "farthest_over_the_skin", 0.9, 0.004);
    // shoulder
    Vec3 joint = arm.at(arm.length() + 0.02 * s);
    joint.z() += f.number("shoulder_joint.before_axis") * s;
    const Vec3 joint_by_axis = joint;
    const char* joint_rule = "end_of_arm_axis";
    if (arm.axilla) {
      f.put("axilla" + suffix, *arm.axilla, 1, arm.pit_hidden ? "proportion" : "gap_closes", arm.pit_hidden ? 0.2 : 0.7, arm.pit_hidden ? 0.03 : 0.008);
      if (arm.merge) f.put("axilla_merge" + suffix, *arm.merge, 1, "level_sections_merge", 0.8, 0.005);
      if (arm.pit_hidden) f.body.scan.findings.push_back({"warning", "the arm pit is hidden, its place is estimated", "axilla" + suffix});
      if (arm.axilla_front) f.put("axilla_front" + suffix, *arm.axilla_front, 2, "beside_arm_pit", 0.5, 0.010);
      if (arm.axilla_back) f.put("axilla_back" + suffix, *arm.axilla_back, 2, "beside_arm_pit", 0.5, 0.010);
      // a raised arm draws the pit outward from under the joint
      const double slide = f.number("shoulder_joint.pit_slide") * std::clamp((raised - 45) / 45, 0.0, 1.0) - f.number("shoulder_joint.pit_inside");
      joint.x() = arm.axilla->x() - outward * slide * s;
      if (const auto top = top_of_shoulder(skin, s, joint.x(), joint.z() - 0.01 * s)) {
        const double w = f.number("shoulder_joint.of_girdle");
        joint.y() = (1 - w) * arm.axilla->y() + w * top->y();
        joint_rule = "between_arm_pit_and_shoulder";
      }
    }
    f.put("shoulder_joint" + suffix, joint, 2, joint_rule, 0.6, 0.012);
    f.also("shoulder_joint" + suffix, joint_by_axis);
    const double lateral = f.number("acromion.outward") - f.number("acromion.outward_per_degree") * raised;
    if (const auto top = top_of_shoulder(skin, s, joint.x() + outward * lateral * s, joint.z() - f.number("acromion.behind_joint") * s))
      f.put("acromion" + suffix, *top, 2, "above_shoulder_joint", 0.5, 0.012);
    // wrist and elbow
    const double hand_ratio = 0.5 * (f.number("hand.of_stature") * s + f.number("hand.of_arm") * (joint - arm.tip).norm());
    double hand = hand_ratio;
    const char* wrist_rule = "arm_ratio";
    if (const auto least = wrist_by_girth(arm, s)) {
      hand = *least - f.number("wrist.before_least_girth") * s;
      wrist_rule = "least_girth_after_hand";
    }
    const Vec3 wrist = arm.at(hand);
    f.put("wrist" + suffix, wrist, 2, wrist_rule, 0.7, 0.008);
    f.also("wrist" + suffix, arm.at(hand_ratio));
    const double to_elbow = (joint - wrist).norm() * (1 - f.number("elbow.of_arm"));
    double elbow_along = hand + to_elbow;
    const char* elbow_rule = "arm_ratio";
    std::optional<double> elbow_by_swell;
    if (const auto rise = elbow_by_girth(arm, s, hand)) {
      const double by_girth = *rise - f.number("elbow.before_swell") * s;
      elbow_by_swell = by_girth;
      if (std::abs(by_girth - elbow_along) < 0.024 * s) {
        elbow_along += f.number("elbow.girth_weight") * (by_girth - elbow_along);
        elbow_rule = "upper_arm_swells";
      }
    }
    const Vec3 elbow = arm.at(elbow_along) - Vec3(0, 0, f.number("elbow.behind_axis") * s);
    f.put("elbow" + suffix, elbow, 2, elbow_rule, 0.6, 0.012);
    const Vec3 behind(0, 0, f.number("elbow.behind_axis") * s);
    f.also("elbow" + suffix, arm.at(hand + to_elbow) - behind);
    if (elbow_by_swell) f.also("elbow" + suffix, arm.at(*elbow_by_swell) - behind);
    // a fist's farthest point is not the finger tip
    Vec3 extreme = arm.tip;
    for (const int t : arm.triangles)
      for (const int v : skin.triangles[t])
        if ((skin.positions[v] - joint).squaredNorm() > (extreme - joint).squaredNorm()) extreme = skin.positions[v];
    f.put("hand_extreme" + suffix, extreme, 1, "farthest_from_shoulder", 0.9, 0.004);
    // the elbow's point: rearmost skin of the section through the joint
    const double point_along = elbow_along + f.number("olecranon.above_joint") * s;
    const LimbSection* section = &arm.sections.front();
    for (const LimbSection& candidate : arm.sections)
      if (std::abs(candidate.along - point_along) < std::abs(section->along - point_along)) section = &candidate;
    double rear = 1e300, weight = 0;
    for (const auto& seg : section->loop.segments) rear = std::min(rear, section->plane.point(seg[0]).z());
    Vec3 back = Vec3::Zero(); // the middle of what is as far back as makes no difference
    for (const auto& seg : section->loop.segments) {
      const Vec3 p = section->plane.point(0.5 * (seg[0] + seg[1]));
      const double w = std::max(0.0, rear + FLAT - p.z()) * (seg[1] - seg[0]).norm();
      back += w * p, weight += w;
    }
    if (weight > 0) back /= weight;
    else back = section->center;
    back.z() = std::min(back.z(), rear + 0.5 * FLAT);
    f.put("olecranon" + suffix, back, 2, "rearmost_at_elbow", 0.5, 0.015);
  }
}

} // namespace sloper::body
