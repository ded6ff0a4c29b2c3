#include <body/landmarks/landmark_finder.hpp>
#include <body/landmarks/shoulder_slope.hpp>
#include <body/measure/arm_girths.hpp>
#include <body/measure/elbow_bend.hpp>
#include <sloper/base/units.hpp>

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace sloper::body {

namespace {

constexpr double REAR_FLAT = 0.002; ///< m
constexpr double NO_EVIDENCE = 0.1; ///< confidence of what is put where an arm ends

/// The gap of one arm closes lower than the other's: what rests on it is believed less.
void tell_lifted_pit(const Finder& f, const ArmTrace& arm, const std::string& suffix) {
  constexpr double TOLD = 0.005, DOUBTED = 0.6; // m, of the confidence
  /// m: of 704 bodies' pits that were lifted by less none was off by more than 15 mm, of six that
  /// were lifted by more three by up to 25 mm
  constexpr double WARNED = 0.03;
  f.also("axilla" + suffix, f.at("axilla" + suffix) - Vec3(0, arm.lifted_m, 0));
  char text[160];
  std::snprintf(text, sizeof text,
                "the gap to the trunk closes %.0f mm lower than the other arm's lets expect: the "
                "arm pit is put higher",
                1000 * arm.lifted_m);
  f.explain("axilla" + suffix + ": " + text);
  if (arm.lifted_m < TOLD)
    return;
  f.body.scan.findings.push_back({"scan.armpit-estimated"_id,
                                  arm.lifted_m < WARNED ? "info" : "warning", text,
                                  "axilla" + suffix});
  for (const char* name : {"axilla", "axilla_front", "axilla_back"})
    f.body.landmarks[name + suffix].confidence *= DOUBTED;
}

/// The gap ended far outside of where the level sections join, and the latter was taken.
void tell_moved_pit(const Finder& f, const ArmTrace& arm, const std::string& suffix) {
  constexpr double DOUBTED = 0.6; // of the confidence
  char text[160];
  std::snprintf(text, sizeof text,
                "the gap to the trunk closes %.0f mm away from where level sections of arm and "
                "trunk join: the arm pit is put there",
                1000 * arm.moved_to_merge_m);
  f.body.scan.findings.push_back({"scan.armpit-estimated"_id, "warning", text, "axilla" + suffix});
  for (const char* name : {"axilla", "axilla_front", "axilla_back"})
    f.body.landmarks[name + suffix].confidence *= DOUBTED;
}

/// Of stature: a pit that would be put higher by less stays.
constexpr double TOLD_LIFT = 0.001;
/// Of stature, at most, for what lets expect it may be made up too: by trunk and legs as well, a
/// scan whose crotch was 54 mm too high had its pits put 40 mm higher, from 10 mm too low.
constexpr double MOST_LIFT = 0.02;

/// Where skin has grown together, or was closed where the scan shows none, the gap between arm and
/// trunk ends too low, and all that is measured along the arm with it. Head and shoulders let
/// expect the pit as well: of 102 fresh bodies it is off by 12 mm by them (standard deviation), and
/// on four of 23 scans whose pits had closed by 18 to 48 mm by 1 to 15.
/// On a rebuilt skin only a pit beside made-up skin may have closed: of mannequins given as points
/// right pits were put 15 to 27 mm higher. Own skin that has grown together has points everywhere;
/// its crotch tells.
/// @return how much higher the pit belongs, m
double closed_pit(const Finder& f, int side) {
  const auto expected = f.corrections.extrapolated("axilla_by_shoulders", f.shape, side);
  const Vec3& axilla = f.at(std::string("axilla") + side_suffix(side));
  const bool may_be_closed =
      f.rebuilt ? f.made_up.is_beside(axilla, f.s) : f.crotch_source != CrotchSource::SKIN;
  if (!expected || !may_be_closed)
    return 0;
  const double pit = axilla.y() / f.s;
  const double higher = std::max(0.0, expected->height - pit);
  return f.s * std::min(MOST_LIFT, expected->weight(pit) * higher);
}

/// Puts a pit that has closed higher, and its folds with it; the merge lies about as high as the
/// pit.
void lift_closed_pit(const Finder& f, int side) {
  const std::string suffix = side_suffix(side);
  const double lift = closed_pit(f, side);
  if (lift < TOLD_LIFT * f.s)
    return;
  for (const char* name : {"axilla", "axilla_front", "axilla_back", "axilla_merge"})
    if (f.has(name + suffix))
      f.body.landmarks[name + suffix].p.y() += lift;
  const double pit = f.at("axilla" + suffix).y();
  if (f.has("axilla_merge" + suffix))
    f.body.landmarks["axilla_merge" + suffix].p.y() =
        std::max(pit, f.at("axilla_merge" + suffix).y());
  char text[120];
  std::snprintf(text, sizeof text, "put %.0f mm higher, where head and shoulders let expect it",
                1000 * lift);
  f.explain("axilla" + suffix + ": " + text);
}

/// Of an arm that hangs, the merge lies beside its pit: of 173 arms of fresh bodies it was at most
/// 32 mm farther outside. Farther out, the gap has closed along the arm.
void keep_merge_at_pit(const Finder& f, const ArmTrace& arm, const std::string& suffix) {
  constexpr double HANGS = -0.42;   // height of the unit vector to the hand
  constexpr double OUTSIDE = 0.025; // of stature
  const auto merge = f.body.landmarks.find("axilla_merge" + suffix);
  if (merge == f.body.landmarks.end() || arm.out.y() > HANGS)
    return;
  const double out = arm.left ? 1 : -1, limit = OUTSIDE * f.s;
  const double pit = f.at("axilla" + suffix).x();
  merge->second.p.x() = pit + out * std::min(limit, out * (merge->second.p.x() - pit));
}

/// A point, what it may be off by along each axis, m, and the share to which bodies like this one
/// taught it.
struct ExpectedPoint {
  Vec3 p, sd;
  double share = 1;
};

/// Where pit, arm direction and the shape of shoulder and arm let expect the merge: of 403 arms of
/// 226 bodies, cross validated, off by 5.8 mm aside, 3.7 in height and 10.5 in depth (standard
/// deviation).
ExpectedPoint expected_merge(const Finder& f, int side) {
  constexpr const char* BEYOND[] = {"axilla_merge_outside", "axilla_merge_above",
                                    "axilla_merge_before"};
  const ArmTrace& arm = f.arms[side];
  const Vec3& pit = f.at(std::string("axilla") + side_suffix(side));
  ExpectedPoint expected{merge_by_pit(pit, arm, f.rules, f.s), Vec3::Ones()};
  for (int axis = 0; axis < 3; ++axis) {
    const auto beyond = f.corrections.extrapolated(BEYOND[axis], f.shape, side);
    expected.share = std::min(expected.share, f.corrections.membership(BEYOND[axis], f.shape));
    if (!beyond || expected.share <= 0)
      continue;
    const double sign = axis == 0 && !arm.left ? -1 : 1;
    expected.p[axis] += expected.share * sign * beyond->height * f.s;
    expected.sd[axis] = beyond->sd * f.s;
  }
  return expected;
}

/// The mean of what the skin shows and of what is expected, the latter the heavier the farther they
/// are apart, for each axis; of bodies unlike those that taught it only what is far off is drawn.
Vec3 likelier_merge(const Finder& f, int side, const Vec3& found) {
  const ExpectedPoint expected = expected_merge(f, side);
  const Eigen::Array3d off = (expected.p - found).array();
  const Eigen::Array3d squared = (off / expected.sd.array()).square();
  const Vec3 mean = found + (squared / (squared + 1) * off).matrix();
  const Vec3 drawn = drawn_to_pit(found, f.at(std::string("axilla") + side_suffix(side)),
                                  f.arms[side], f.rules, f.s);
  return expected.share * mean + (1 - expected.share) * drawn;
}

/// Of skin that may span the gap the merge is drawn to where it is expected: of 30 arms of 36 fresh
/// scans off by 18.3 mm on average as the skin shows it, 50 at most, and by 13.3 and 38 so. Skin
/// that is the scan's own shows the merge: of 34 arms it is 6.2 mm off, and would be 8.6.
void draw_merge_to_pit(const Finder& f, int side) {
  constexpr double TOLD = 0.012;  // of stature: 20 mm
  constexpr double DOUBTED = 0.6; // of the confidence
  const auto merge = f.body.landmarks.find(std::string("axilla_merge") + side_suffix(side));
  if (merge == f.body.landmarks.end())
    return;
  const Vec3 found = merge->second.p;
  merge->second.p = likelier_merge(f, side, found);
  const double moved = (merge->second.p - found).norm();
  if (moved < TOLD * f.s)
    return;
  f.also(merge->first, found);
  merge->second.confidence *= DOUBTED;
  char text[160];
  std::snprintf(text, sizeof text,
                "level sections of arm and trunk join %.0f mm from there: they touch, it is put "
                "beside the arm pit",
                1000 * moved);
  f.body.scan.findings.push_back({"scan.armpit-estimated"_id, "warning", text, merge->first});
}

/// The merge that no level section of the arm shows, as of a level arm on rebuilt skin.
std::optional<Vec3> merge_beside_pit(const Finder& f, int side) {
  if (f.arms[side].pit_hidden)
    return std::nullopt;
  f.body.scan.findings.push_back(
      {"scan.armpit-estimated"_id, "warning",
       "no level sections of arm and trunk join: it is put where the arm pit lets expect it",
       std::string("axilla_merge") + side_suffix(side)});
  return expected_merge(f, side).p;
}

struct Aside {
  double middle, half; ///< m
};

/// How far the acromia are from the middle by the trunk alone, which no stance of the arms changes:
/// a + b female + c breadth of the waist + d breadth of the chest, all shares of stature.
std::optional<Aside> acromion_by_trunk(const Finder& f) {
  constexpr double TOP = 0.755; // of stature, about the arm pits
  const double s = f.s;
  if (!f.levels.crotch())
    return std::nullopt;
  double breadth[2], middle = 0;
  for (int k = 0; k < 2; ++k) { // both below the arm pits; where an arm touches neither tells
    const double y = *f.levels.crotch() + (k == 0 ? 0.625 : 0.75) * (TOP * s - *f.levels.crotch());
    const auto& loop = f.levels.trunk_at(y);
    if (!loop)
      return std::nullopt;
    breadth[k] = loop->size().x() / s;
    middle += 0.5 * loop->center().x();
  }
  const double half = f.number("acromion.aside") +
                      f.number("acromion.aside_of_waist") * breadth[0] +
                      f.number("acromion.aside_of_chest") * breadth[1];
  if (half < f.number("acromion.least_aside") || half > f.number("acromion.most_aside"))
    return std::nullopt; // arms that hang on the trunk are in its outline
  return Aside{middle, half * s};
}

/// Axilla and its folds, shoulder joint and acromion. @return the joint, which the rest of the arm
/// is measured from
Vec3 find_shoulder(const Finder& f, int side) {
  const double s = f.s;
  const TriangleMesh& skin = f.levels.skin();
  const ArmTrace& arm = f.arms[side];
  const std::string suffix = side_suffix(side);
  const double outward = arm.left ? 1 : -1;
  const double raised =
      units::degrees(std::acos(std::clamp(-arm.out.y(), -1.0, 1.0))); // 0 hanging, 90 level
  auto pit_if = [&](bool hidden) -> std::optional<Vec3> {
    if (!arm.axilla || hidden != arm.pit_hidden)
      return std::nullopt;
    if (hidden)
      return arm.axilla;
    const auto& belly = f.levels.trunk_at(0.60 * s);
    const double stout = belly ? std::clamp(belly->size().y() / s - 0.165, 0.0, 0.1) : 0;
    return Vec3(*arm.axilla + s * Vec3(0, f.number("axilla.above_roof"),
                                       f.number("axilla.before_stout") * stout));
  };
  if (f.find("axilla", suffix, 1,
             {{"gap_closes", [&] { return pit_if(false); }},
              {"as_other_arm",
               [&] { return arm.pit_mirrored ? pit_if(true) : std::optional<Vec3>(); }},
              {"proportion", [&] { return pit_if(true); }}})) {
    f.find("axilla_merge", suffix, 1,
           {{"level_sections_merge", [&] { return arm.merge; }},
            {"beside_arm_pit", [&] { return merge_beside_pit(f, side); }}});
    if (arm.pit_hidden)
      f.body.scan.findings.push_back({"scan.armpit-estimated"_id, "warning",
                                      arm.pit_mirrored
                                          ? "the arm pit is hidden, its place is the other's"
                                          : "the arm pit is hidden, its place is estimated",
                                      "axilla" + suffix});
    f.find("axilla_front", suffix, 2, {{"beside_arm_pit", [&] { return arm.axilla_front; }}});
    f.find("axilla_back", suffix, 2, {{"beside_arm_pit", [&] { return arm.axilla_back; }}});
    keep_merge_at_pit(f, arm, suffix);
    lift_closed_pit(f, side);
    if (f.rebuilt || f.crotch_source != CrotchSource::SKIN)
      draw_merge_to_pit(f, side);
    if (arm.moved_to_merge_m > 0)
      tell_moved_pit(f, arm, suffix);
    if (arm.lifted_m > 0)
      tell_lifted_pit(f, arm, suffix);
  } else
    f.body.scan.findings.push_back(
        {"scan.armpit-estimated"_id, "warning",
         "the arm touches the trunk or the scan has a hole there: the arm pit is not found",
         "axilla" + suffix});
  Vec3 by_axis = arm.at(arm.length() + 0.02 * s);
  by_axis.z() += f.number("shoulder_joint.before_axis") * s;
  auto by_pit = [&]() -> std::optional<Vec3> {
    if (!arm.axilla)
      return std::nullopt;
    // a raised arm draws the pit outward from under the joint
    const double slide = f.number("shoulder_joint.pit_slide_per_degree") * raised -
                         f.number("shoulder_joint.pit_inside");
    Vec3 joint(arm.axilla->x() - outward * slide * s, 0, by_axis.z());
    const auto top = top_of_shoulder(skin, s, joint.x(), joint.z() - 0.01 * s);
    if (!top || top->y() < arm.axilla->y()) // beside the shoulder lies a hip, or a hand
      return std::nullopt;
    const double w = f.number("shoulder_joint.of_girdle");
    joint.y() = (1 - w) * arm.axilla->y() + w * top->y();
    return joint;
  };
  const bool found =
      f.find("shoulder_joint", suffix, 2, {{"between_arm_pit_and_shoulder", by_pit}});
  if (found && arm.pit_hidden)
    f.body.landmarks["shoulder_joint" + suffix].confidence *=
        0.5; // it rests on where pits usually are
  f.also("shoulder_joint" + suffix, by_axis);
  const Vec3 joint = found ? f.at("shoulder_joint" + suffix) : by_axis;
  const double depth = joint.z() - f.number("acromion.behind_joint") * s,
               by_joint = joint.x() + outward * f.number("acromion.outward") * s;
  f.find("acromion", suffix, 2,
         {{"beside_trunk_and_joint",
           [&]() -> std::optional<Vec3> {
             const auto aside = acromion_by_trunk(f);
             if (!aside)
               return std::nullopt;
             const double w = f.number("acromion.joint_weight");
             return top_of_shoulder(
                 skin, s, w * by_joint + (1 - w) * (aside->middle + outward * aside->half), depth);
           }},
          {"above_shoulder_joint", [&] { return top_of_shoulder(skin, s, by_joint, depth); }}});
  if (const auto p = top_of_shoulder(skin, s, by_joint, depth))
    f.also("acromion" + suffix, *p);
  weigh_acromion_by_slope(f, side, raised);
  // of a scan with many closed holes the offset learned for the joint changes: the rest of the arm
  // is measured from where the rule found it
  return by_pit().value_or(by_axis);
}

/// The elbow's point: the middle of what is as far out along `out` as makes no difference, in the
/// arm's section at `along`.
Vec3 rear_of_section(const ArmTrace& arm, const TriangleMesh& skin, double along, const Vec3& out) {
  const LimbSection* near = &arm.sections.front();
  for (const LimbSection& candidate : arm.sections)
    if (std::abs(candidate.along - along) < std::abs(near->along - along))
      near = &candidate;
  const Plane plane = cross_plane(arm.at(along), near->axis);
  const std::vector<Loop> loops = cut(skin, plane, &arm.triangles);
  const Loop* loop = nullptr;
  for (const Loop& candidate : loops)
    if (candidate.area > 0 && candidate.centroid.norm() < (loop ? loop->centroid.norm() : 0.05))
      loop = &candidate;
  if (!loop)
    return arm.at(along);
  double rear = -1e300, weight = 0;
  for (const auto& seg : loop->segments)
    rear = std::max(rear, plane.point(seg[0]).dot(out));
  Vec3 back = Vec3::Zero();
  for (const auto& seg : loop->segments)
    for (const double t : {0.1, 0.3, 0.5, 0.7, 0.9}) {
      const Vec3 p = plane.point((1 - t) * seg[0] + t * seg[1]);
      const double w = std::max(0.0, p.dot(out) - rear + REAR_FLAT) * (seg[1] - seg[0]).norm();
      back += w * p;
      weight += w;
    }
  if (weight > 0)
    back /= weight;
  else
    back = plane.point(loop->centroid);
  return back + std::max(0.0, rear - 0.25 * REAR_FLAT - back.dot(out)) * out;
}

void find_elbow(const Finder& f, int side, double hand, double to_elbow) {
  const ArmTrace& arm = f.arms[side];
  const std::string suffix = side_suffix(side);
  const double by_ratio = hand + to_elbow;
  std::optional<double> by_swell;
  if (const auto rise = elbow_by_girth(arm, f.s, hand))
    by_swell = *rise - f.number("elbow.before_swell") * f.s;
  auto with_swell = [&]() -> std::optional<double> {
    const double most = f.number("elbow.swell_near_ratio") * f.s;
    if (!by_swell || std::abs(*by_swell - by_ratio) >= most)
      return std::nullopt;
    const double off = *by_swell - by_ratio; // fades towards the limit, so that nothing jumps there
    return by_ratio +
           f.number("elbow.girth_weight") * std::min(1.0, 3 * (1 - std::abs(off) / most)) * off;
  };
  const auto bend = elbow_by_bend(arm, f.s, by_ratio);
  const auto along =
      f.choose<double>("elbow", "elbow" + suffix,
                       {{"arm_bends",
                         [&]() -> std::optional<double> {
                           if (!bend)
                             return std::nullopt;
                           const double share = std::clamp((bend->y() - STRAIGHT_ELBOW) / 0.35, 0.0,
                                                           f.number("elbow.bend_weight"));
                           return with_swell().value_or(by_ratio) * (1 - share) + share * bend->x();
                         }},
                        {"upper_arm_swells", with_swell},
                        {"arm_ratio", [&] { return std::optional(by_ratio); }}});
  if (!along)
    return;
  const Vec3 behind(0, 0, f.number("elbow.behind_axis") * f.s);
  f.put("elbow" + suffix, f.corrected("elbow", suffix, arm.at(along->value) - behind, false), 2,
        *along->rule);
  f.also("elbow" + suffix, arm.at(by_ratio) - behind);
  if (by_swell)
    f.also("elbow" + suffix, arm.at(*by_swell) - behind);
  f.find("olecranon", suffix, 2,
         {{"rearmost_at_elbow", [&] {
             const double point = along->value + f.number("olecranon.above_joint") * f.s;
             return std::optional(
                 rear_of_section(arm, f.levels.skin(), point, elbow_faces(arm, along->value, f.s)));
           }}});
}

/// Warns of what is measured along an arm that ends before its wrist.
void tell_stump(const Finder& f, const std::string& suffix, bool has_elbow) {
  for (const std::string place : {"wrist", "elbow", "olecranon"}) {
    const auto it = f.body.landmarks.find(place + suffix);
    if (it == f.body.landmarks.end())
      continue;
    const bool is_seen = has_elbow && place != "wrist";
    if (!is_seen)
      it->second.confidence = NO_EVIDENCE;
    f.body.scan.findings.push_back({"scan.hand-missing"_id, "warning",
                                    is_seen ? "the arm ends before the wrist: it is put as far "
                                              "from the shoulder as people's are"
                                            : "the arm ends before it: it is put where the arm "
                                              "ends",
                                    it->first});
  }
}

/// No hand: the wrist is where the arm ends, or as far from the shoulder as people's is if that is
/// nearer. @param reach of the arm's end from the shoulder joint, m
void find_ends_without_hand(const Finder& f, int side, double reach, const RuleChoice& rule) {
  const ArmTrace& arm = f.arms[side];
  const std::string suffix = side_suffix(side);
  const double usual = f.number("hand.arm_of_stature") * f.s;
  const double arm_length = std::min(reach, usual);
  f.body.scan.findings.push_back(
      {"scan.hand-missing"_id, "warning",
       "the hand is missing or hidden: hand and wrist are put where the arm ends",
       "hand_tip" + suffix});
  f.explain("hand_tip" + suffix + ": the arm is too short for a hand and has no wrist");
  f.put("wrist" + suffix, arm_length < reach ? arm.at(reach - arm_length) : arm.tip, 2, rule);
  // the skin within an arm's length of a stump is that of head and trunk too
  if (f.has("hand_extreme" + suffix))
    f.body.landmarks["hand_extreme" + suffix].p = arm.tip;
  for (const char* name : {"hand_tip", "hand_extreme", "wrist"})
    if (const auto it = f.body.landmarks.find(name + suffix); it != f.body.landmarks.end())
      it->second.confidence = NO_EVIDENCE;
  const double upper_arm = upper_arm_without_hand(reach, usual, f.number("elbow.of_arm"));
  find_elbow(f, side, reach - arm_length, arm_length - std::min(upper_arm, reach));
  for (const char* name : {"elbow", "olecranon"})
    if (const auto it = f.body.landmarks.find(name + suffix); it != f.body.landmarks.end())
      it->second.confidence *= 0.5;
  if (reach < SHORT_ARM * usual)
    tell_stump(f, suffix, upper_arm < reach);
}

} // namespace

void find_arm_landmarks(const Finder& f) {
  const double s = f.s;
  const TriangleMesh& skin = f.levels.skin();
  for (int side = 0; side < 2; ++side) {
    const ArmTrace& arm = f.arms[side];
    const std::string suffix = side_suffix(side);
    if (arm.sections.empty())
      continue;
    f.find("hand_tip", suffix, 1,
           {{"farthest_over_the_skin", [&] { return std::optional(arm.tip); }}});
    const Vec3 joint = find_shoulder(f, side);
    // a fist's farthest point is not the finger tip
    f.find("hand_extreme", suffix, 1,
           {{"farthest_from_shoulder", [&] {
               Vec3 extreme = arm.tip;
               for (const int t : arm.triangles)
                 for (const int v : skin.triangles[t])
                   if ((skin.positions[v] - joint).squaredNorm() > (extreme - joint).squaredNorm())
                     extreme = skin.positions[v];
               return std::optional(extreme);
             }}});
    const double by_ratio = 0.5 * (f.number("hand.of_stature") * s +
                                   f.number("hand.of_arm") * (joint - arm.tip).norm());
    const auto hand = f.choose<double>(
        "wrist", "wrist" + suffix,
        {{"least_girth_after_hand",
          [&]() -> std::optional<double> {
            const auto least = wrist_by_girth(arm, f.number("wrist.least_to_palm"), s);
            if (!least || arm.is_stump || *least > by_ratio + f.number("wrist.longest_hand") * s)
              return std::nullopt;
            return *least - f.number("wrist.before_least_girth") * s;
          }},
         {"arm_ratio", [&] { return std::optional(by_ratio); }}});
    if (!hand)
      continue;
    const double reach = (joint - arm.tip).norm();
    if (hand->rule->name != "arm_ratio" || reach >= f.number("hand.least_arm") * s) {
      const Vec3 wrist = arm.at(hand->value);
      f.put("wrist" + suffix, f.corrected("wrist", suffix, wrist, false), 2, *hand->rule);
      f.also("wrist" + suffix, arm.at(by_ratio));
      // along a bent arm, which is longer than straight from shoulder to wrist
      const double path = arm.length() + (joint - arm.at(arm.length())).norm() - hand->value;
      find_elbow(f, side, hand->value,
                 std::max(path, (joint - wrist).norm()) * (1 - f.number("elbow.of_arm")));
      continue;
    }
    find_ends_without_hand(f, side, reach, *hand->rule);
  }
}

} // namespace sloper::body
