#include <sloper/body/landmarks/shape_features.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace sloper::body {

namespace {

constexpr double MERGE_HANGS = -0.12; ///< height of the unit vector to the hand: 83 degrees

constexpr double NONE = std::numeric_limits<double>::quiet_NaN();
constexpr int TRUNK_LEVELS = 8;     ///< between the crotch and TRUNK_TOP
constexpr double TRUNK_TOP = 0.755; ///< of stature: about the arm pits
constexpr double UPPER[] = {0.78, 0.80, 0.82, 0.84, 0.86, 0.88, 0.9}; ///< of stature
constexpr double LEG[] = {0.2, 0.35, 0.5, 0.65, 0.8, 0.95};           ///< of the crotch's height
constexpr double ARM[] = {0.35, 0.5, 0.65, 0.8, 0.95}; ///< of the traced arm from the hand
constexpr double MIDDLE = 0.008; ///< of stature: half breadth of the middle strip

/// Front and back of a loop near x = 0.
struct Depth {
  double front = NONE, back = NONE;
};

Depth depth_of(const std::optional<Loop>& loop, double half) {
  Depth depth;
  if (!loop)
    return depth;
  for (const auto& segment : loop->segments)
    if (const auto piece = clipped(segment, 0, -half, half))
      for (const Vec2& q : *piece) {
        if (!(q.y() <= depth.front))
          depth.front = q.y();
        if (!(q.y() >= depth.back))
          depth.back = q.y();
      }
  return depth;
}

/// Numbers and, the first time, their names.
class Row {
public:
  Row(std::vector<double>& values, std::vector<std::string>& names)
      : m_values(values), m_names(names) {}
  void add(const std::string& name, double value) {
    m_values.push_back(value);
    m_names.push_back(name);
  }

private:
  std::vector<double>& m_values;
  std::vector<std::string>& m_names;
};

std::string numbered(const char* name, double of) {
  return std::string(name) + "_" + std::to_string(static_cast<int>(std::lround(100 * of)));
}

void add_trunk(Row& row, const LevelStack& levels, double sign) {
  const double s = levels.stature(), crotch = *levels.crotch();
  for (int k = 1; k <= TRUNK_LEVELS; ++k) {
    const double part = static_cast<double>(k) / TRUNK_LEVELS;
    const auto& loop = levels.trunk_at(crotch + part * (TRUNK_TOP * s - crotch));
    const Depth depth = depth_of(loop, MIDDLE * s);
    // farther up arms may hang on it
    if (k < TRUNK_LEVELS - 1)
      row.add(numbered("trunk_breadth", part), loop ? std::min(loop->size().x() / s, 0.4) : NONE);
    row.add(numbered("trunk_front", part), depth.front / s);
    row.add(numbered("trunk_back", part), depth.back / s);
    if (k == 4 || k == 6)
      row.add(numbered("trunk_aside", part),
              loop ? std::clamp(sign * loop->center().x() / s, -0.1, 0.1) : NONE);
  }
  for (const double part : UPPER) {
    const Depth depth = depth_of(levels.trunk_at(part * s), MIDDLE * s);
    row.add(numbered("upper_front", part), depth.front / s);
    row.add(numbered("upper_back", part), depth.back / s);
  }
  for (const double part : {0.86, 0.88, 0.9, 0.94, 0.97}) {
    const auto& loop = levels.trunk_at(part * s);
    row.add(numbered("head_breadth", part), loop ? std::min(loop->size().x() / s, 0.2) : NONE);
    row.add(numbered("head_aside", part),
            loop ? std::clamp(sign * loop->center().x() / s, -0.1, 0.1) : NONE);
    if (part > 0.9)
      row.add(numbered("head_depth", part), loop ? loop->size().y() / s : NONE);
    if (part > 0.9)
      row.add(numbered("head_before", part), loop ? loop->center().y() / s : NONE);
  }
}

void add_leg(Row& row, const LevelStack& levels, int side) {
  const double s = levels.stature(), sign = side == 0 ? 1 : -1;
  for (const double part : LEG) {
    const auto loop = levels.leg_at(part * *levels.crotch(), side);
    row.add(numbered("leg_aside", part), loop ? sign * loop->center().x() / s : NONE);
    row.add(numbered("leg_breadth", part), loop ? loop->size().x() / s : NONE);
    row.add(numbered("leg_front", part), loop ? loop->high.y() / s : NONE);
    row.add(numbered("leg_back", part), loop ? loop->low.y() / s : NONE);
  }
}

void add_arm(Row& row, const LevelStack& levels, const ArmTrace& arm) {
  const double s = levels.stature(), sign = arm.left ? 1 : -1;
  const bool is_there = !arm.sections.empty();
  const bool is_whole = is_there && !arm.is_stump; // or its hand at least is what is missing
  auto add_point = [&](const std::string& name, const std::optional<Vec3>& p) {
    row.add(name + "_x", p ? sign * p->x() / s : NONE);
    row.add(name + "_y", p ? p->y() / s : NONE);
    row.add(name + "_z", p ? p->z() / s : NONE);
  };
  const double end = arm.length();
  add_point("arm_direction", is_there ? std::optional<Vec3>(s * arm.out) : std::nullopt);
  row.add("arm_raised", is_there ? std::acos(std::clamp(-arm.out.y(), -1.0, 1.0)) : NONE);
  add_point("arm_end", is_there ? std::optional<Vec3>(arm.at(end + 0.02 * s)) : std::nullopt);
  add_point("arm_pit", is_there && !arm.pit_hidden ? arm.axilla : std::nullopt);
  // the bodies learned from show it where the arm hangs; along a level arm it lies elsewhere
  add_point("arm_merge", is_there && arm.out.y() < MERGE_HANGS ? arm.merge : std::nullopt);
  row.add("arm_length", is_whole ? end / s : NONE);
  for (const double part : ARM) {
    if (!is_whole) {
      row.add(numbered("arm_girth", part), NONE);
      continue;
    }
    const auto at = std::lower_bound(arm.sections.begin(), arm.sections.end(), part * end,
                                     [](const LimbSection& a, double x) { return a.along < x; });
    row.add(numbered("arm_girth", part),
            (at == arm.sections.end() ? arm.sections.back() : *at).girth / s);
  }
  const Vec3 fore =
      is_whole ? Vec3((arm.at(0.35 * end) - arm.at(0.5 * end)).normalized()) : Vec3::Constant(NONE);
  row.add("forearm_x", sign * fore.x());
  row.add("forearm_y", fore.y());
  row.add("forearm_z", fore.z());
  row.add("forearm_bent", is_whole ? std::acos(std::clamp(fore.dot(arm.out), -1.0, 1.0)) : NONE);
}

/// Height of the highest skin in the strip at `x` to `x` + breadth on one side, below the head: the
/// slope of the shoulder.
void add_shoulder(Row& row, const LevelStack& levels, double sign) {
  const double s = levels.stature();
  constexpr double ACROSS[] = {0.045, 0.06, 0.08, 0.1, 0.12};
  double top[5] = {NONE, NONE, NONE, NONE, NONE}, depth[5] = {NONE, NONE, NONE, NONE, NONE};
  for (const Vec3& p : levels.skin().positions) {
    if (p.y() > 0.87 * s || p.y() < 0.7 * s)
      continue;
    for (int k = 0; k < 5; ++k)
      if (std::abs(sign * p.x() - ACROSS[k] * s) < 0.006 * s && !(p.y() <= top[k])) {
        top[k] = p.y();
        depth[k] = p.z();
      }
  }
  for (int k = 0; k < 5; ++k) {
    row.add(numbered("shoulder_top", 10 * ACROSS[k]), top[k] / s);
    row.add(numbered("shoulder_depth", 10 * ACROSS[k]), depth[k] / s);
  }
}

std::vector<double> row_of(const LevelStack& levels, const std::array<ArmTrace, 2>& arms,
                           double female, int side, std::vector<std::string>& names) {
  std::vector<double> values;
  Row row(values, names);
  const double s = levels.stature(), sign = side == 0 ? 1 : -1;
  row.add("female", female);
  row.add("crotch", *levels.crotch() / s);
  row.add("crotch_before", levels.crotch_point().y() / s);
  add_trunk(row, levels, sign);
  add_leg(row, levels, side);
  add_arm(row, levels, arms[side]);
  add_shoulder(row, levels, sign);
  return values;
}

} // namespace

const std::vector<std::string>& shape_feature_names() {
  static const std::vector<std::string> names = [] {
    std::vector<std::string> list;
    TriangleMesh none; // a body of nothing has all names
    LevelStack levels(none, 1, 0.01);
    levels.move_crotch(0.47, 0);
    std::array<ArmTrace, 2> arms;
    row_of(levels, arms, 0.5, 0, list);
    return list;
  }();
  return names;
}

ShapeFeatures shape_features(const LevelStack& levels, const std::array<ArmTrace, 2>& arms,
                             double female) {
  ShapeFeatures features;
  std::vector<std::string> unused;
  for (int side = 0; side < 2; ++side)
    features.side[side] = levels.crotch() ? row_of(levels, arms, female, side, unused)
                                          : std::vector<double>(shape_feature_names().size(), NONE);
  return features;
}

} // namespace sloper::body
