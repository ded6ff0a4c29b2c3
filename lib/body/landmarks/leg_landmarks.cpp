#include <body/landmarks/landmark_finder.hpp>
#include <body/measure/plateau.hpp>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <optional>

namespace sloper::body {

namespace {

constexpr double HOLLOW_BELOW = 0.05,
                 HOLLOW_ABOVE = 0.065; ///< of stature about the knee by the leg's length: of 40
                                       ///< bodies its error is 12 mm (sd), at most 65
constexpr double EITHER = 0.6;         ///< of the confidence: a second place is as low
constexpr double LEG_FLAT = 0.001;     ///< m: as far out as makes no difference
/// Of the depth of the leg above it: of 428 feet of 214 bodies, 60 of them as scanners deliver
/// them, the shortest is 2.54; of a leg cut off 6 cm above the floor it is 1.95, from 10 cm on 1.0
/// to 1.1.
constexpr double LEAST_FOOT = 2.2;

/// Height of the hollow behind the knee: where the back of the leg comes furthest forward.
std::optional<double> hollow_of_knee(const Finder& f, int side, double around) {
  std::vector<Vec2> backs; // height, depth from the front
  for (double y = around - HOLLOW_BELOW * f.s; y <= around + HOLLOW_ABOVE * f.s; y += 0.0025 * f.s)
    if (const auto loop = f.levels.leg_at(y, side))
      backs.emplace_back(y, -loop->low.y());
  if (backs.empty())
    return std::nullopt;
  const Lowest deepest = lowest_of(backs, LEG_FLAT);
  if (deepest.least < around - (HOLLOW_BELOW - 0.003) * f.s ||
      deepest.least > around + (HOLLOW_ABOVE - 0.003) * f.s)
    return std::nullopt; // at the end of the search there is no hollow
  return deepest.middle;
}

/// The end of the foot in front (direction 1) or behind (-1): the mean of its `n` outermost points.
/// Of toes as long as makes no difference it is the great toe's; a heel is flat, and the middle of
/// its end is taken, at the depth of the outermost point.
std::optional<Vec3> foot_end(const Finder& f, int side, double ankle_y, double direction,
                             std::size_t n) {
  constexpr double AS_LONG = 0.0015, TOE = 0.006, FLAT_HEEL = 0.0015; // of stature
  const double sign = side == 0 ? 1 : -1;
  const std::vector<Vec3>& points = f.rebuilt ? f.scan_points : f.levels.skin().positions;
  std::vector<int> foot;
  for (std::size_t v = 0; v < points.size(); ++v)
    if (points[v].y() <= ankle_y && points[v].y() > -0.01 * f.s && sign * points[v].x() > 0)
      foot.push_back(static_cast<int>(v));
  if (foot.size() < 10)
    return std::nullopt;
  auto farther = [&](int a, int b) {
    const double za = direction * points[a].z(), zb = direction * points[b].z();
    return za != zb ? za > zb : a < b;
  };
  if (direction > 0) {
    const double end =
        points[*std::min_element(foot.begin(), foot.end(), farther)].z() - AS_LONG * f.s;
    double inner = 1e300;
    for (const int v : foot)
      if (points[v].z() > end)
        inner = std::min(inner, sign * points[v].x());
    std::erase_if(foot, [&](int v) {
      return points[v].z() > end && sign * points[v].x() > inner + TOE * f.s;
    });
  }
  n = std::min(n, foot.size());
  std::partial_sort(foot.begin(), foot.begin() + static_cast<std::ptrdiff_t>(n), foot.end(),
                    farther);
  Vec3 mean = Vec3::Zero();
  for (std::size_t k = 0; k < n; ++k)
    mean += points[foot[k]] / static_cast<double>(n);
  if (direction > 0)
    return mean;
  Vec3 sum = Vec3::Zero();
  double weight = 0;
  for (const int v : foot)
    if (const double w = FLAT_HEEL * f.s - (points[v].z() - mean.z()); w > 0) {
      sum += w * points[v];
      weight += w;
    }
  return weight > 0 ? Vec3(sum.x() / weight, sum.y() / weight, mean.z()) : mean;
}

/// How often the depth of the leg above the ankle, where it is least, goes into the length of the
/// foot; empty where the leg has no section there.
std::optional<double> foot_to_leg(const Finder& f, int side) {
  constexpr double LOW = 0.03, HIGH = 0.14; // of stature
  const std::string suffix = side_suffix(side);
  if (!f.has("foot_tip" + suffix) || !f.has("heel" + suffix))
    return std::nullopt;
  double least = 1e300;
  for (const Slice& slice : f.levels.slices())
    if (slice.y > LOW * f.s && slice.y < HIGH * f.s && slice.leg[side] >= 0)
      least = std::min(least, slice.loops[slice.leg[side]].size().y());
  if (least > f.s)
    return std::nullopt;
  const Vec3 foot = f.at("foot_tip" + suffix) - f.at("heel" + suffix);
  return std::hypot(foot.x(), foot.z()) / least;
}

/// A leg that ends in a stump, as of a scan that is cut off above the feet: what lies above is
/// measured from there, and the stature with it.
void tell_missing_foot(const Finder& f, int side) {
  const auto ratio = foot_to_leg(f, side);
  if (!ratio)
    return;
  const std::string foot = std::string("foot_tip") + side_suffix(side);
  char text[160];
  std::snprintf(text, sizeof text, "the foot is %.2f times as long as the leg is deep above it",
                *ratio);
  f.explain(foot + ": " + text);
  if (*ratio < LEAST_FOOT)
    f.body.scan.findings.push_back(
        {"scan.foot-missing"_id, "error",
         "the leg ends without a foot: stature and all heights are measured from there", foot});
}

void find_knee(const Finder& f, int side, double ankle_y, double hip_y) {
  const std::string suffix = side_suffix(side);
  const double by_ratio = ankle_y + f.number("knee.of_leg") * (hip_y - ankle_y);
  std::optional<double> by_hollow;
  if (const auto hollow = hollow_of_knee(f, side, by_ratio))
    by_hollow = *hollow - f.number("knee.below_hollow") * f.s;
  const auto height = f.choose<double>("knee", "knee" + suffix,
                                       {{"leg_ratio_and_hollow",
                                         [&]() -> std::optional<double> {
                                           if (!by_hollow)
                                             return std::nullopt;
                                           return 0.5 * (by_ratio + *by_hollow);
                                         }},
                                        {"leg_ratio", [&] { return std::optional(by_ratio); }}});
  if (!height)
    return;
  const Vec3 learned = f.correction("knee", suffix);
  const double knee_y = height->value + learned.y();
  const auto section = f.levels.leg_at(knee_y, side);
  if (!section)
    return;
  const Vec2 cap = outermost(*section, Vec2::UnitY(), LEG_FLAT);
  f.find("patella", suffix, 2,
         {{"foremost_at_knee", [&] { return std::optional(Vec3(cap.x(), knee_y, cap.y())); }}});
  const Vec3 joint(section->center().x() + learned.x(), knee_y,
                   cap.y() - f.number("knee.behind_patella") * f.s + learned.z());
  f.put("knee" + suffix, joint, 2, *height->rule);
  f.also("knee" + suffix, Vec3(joint.x(), by_ratio, joint.z()));
  if (by_hollow)
    f.also("knee" + suffix, Vec3(joint.x(), *by_hollow, joint.z()));
}

/// Hip joint, knee and ankle of one leg, below a crotch that was found.
void find_leg(const Finder& f, int side) {
  const double s = f.s, sign = side == 0 ? 1 : -1, crotch_y = f.at("crotch").y();
  const std::string suffix = side_suffix(side);
  const double ankle_y = f.number("ankle.height") * s;
  auto find_end = [&](const char* place, const char* rule, double direction) {
    f.find(
        place, suffix, 1,
        {{rule, [&] { return foot_end(f, side, ankle_y, direction, 1); }},
         {"middle_of_three_outermost", [&] { return foot_end(f, side, ankle_y, direction, 3); }}});
  };
  find_end("foot_tip", "foremost_of_foot", 1);
  find_end("heel", "rearmost_of_foot", -1);
  tell_missing_foot(f, side);
  const auto top = f.levels.leg_at(crotch_y - 0.010, side);
  if (!top)
    return;
  f.find("leg_top", suffix, 2,
         {{"section_under_crotch", [&] {
             return std::optional(Vec3(top->centroid.x(), crotch_y - 0.010, top->centroid.y()));
           }}});
  // the leg's middle leans out with fat and in with muscle: half of it, half the usual breadth
  // between the joints
  const double hip_x =
      0.5 * (top->centroid.x() +
             sign * (f.number("hip_joint.from_leg_top") + f.number("hip_joint.aside")) * s);
  const Vec3 hip(hip_x, crotch_y + f.number("hip_joint.above_crotch") * s,
                 top->centroid.y() - f.number("hip_joint.behind_leg_top") * s);
  f.find("hip_joint", suffix, 2, {{"above_leg_top", [&] { return std::optional(hip); }}});
  f.also("hip_joint" + suffix,
         Vec3(top->centroid.x() + sign * f.number("hip_joint.from_leg_top") * s, hip.y(), hip.z()));
  f.also("hip_joint" + suffix, Vec3(sign * f.number("hip_joint.aside") * s, hip.y(), hip.z()));
  const auto ankle = f.levels.leg_at(ankle_y, side);
  if (!ankle)
    return;
  // the section at this height holds the heel's upper rim: its middle in x, the joint lies nearer
  // to the heel
  const Vec3 joint(ankle->center().x() - sign * 0.0015 * s, ankle_y,
                   ankle->low.y() + f.number("ankle.from_behind") * ankle->size().y());
  f.find("ankle", suffix, 2, {{"height_ratio", [&] { return std::optional(joint); }}});
  const Vec2 outer = outermost(*ankle, Vec2(sign, 0), LEG_FLAT);
  f.find("malleolus", suffix, 2, {{"outermost_at_ankle", [&] {
                                     return std::optional(Vec3(outer.x(), ankle_y, outer.y()));
                                   }}});
  find_knee(f, side, ankle_y, hip.y());
}

} // namespace

void find_leg_landmarks(const Finder& f) {
  if (!f.levels.crotch())
    return;
  const Vec3 crotch(f.levels.crotch_point().x(), *f.levels.crotch(), f.levels.crotch_point().y());
  auto when = [&](CrotchSource source) {
    return source == f.crotch_source ? std::optional(crotch) : std::nullopt;
  };
  if (!f.find("crotch", "", 1,
              {{"leg_sections_merge", [&] { return when(CrotchSource::SKIN); }},
               {"by_rest_of_body", [&] { return when(CrotchSource::REST_OF_BODY); }},
               {"below_buttocks", [&] { return when(CrotchSource::BUTTOCKS); }}}))
    return;
  if (const auto& other = f.levels.other_crotch(); other && f.crotch_source == CrotchSource::SKIN) {
    f.also("crotch", *other);
    f.body.landmarks["crotch"].confidence *= EITHER;
    char text[160];
    std::snprintf(text, sizeof text,
                  "the skin between the legs is as low %.0f mm farther %s: the crotch may be there",
                  1000 * std::abs(other->z() - crotch.z()),
                  other->z() < crotch.z() ? "back" : "forward");
    f.body.scan.findings.push_back({"scan.crotch-estimated"_id, "warning", text, "crotch"});
  }
  for (int side = 0; side < 2; ++side)
    find_leg(f, side);
  if (f.has("hip_joint_l") && f.has("hip_joint_r"))
    f.find("hip_center", "", 2,
           {{"middle_of_hip_joints", [&] {
               return std::optional(Vec3(0.5 * (f.at("hip_joint_l") + f.at("hip_joint_r"))));
             }}});
}

} // namespace sloper::body
