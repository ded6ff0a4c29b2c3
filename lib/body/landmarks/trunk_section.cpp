#include <body/landmarks/trunk_section.hpp>

#include <algorithm>
#include <cmath>

namespace sloper::body {

namespace {

constexpr double PIT_MARGIN_M = 0.002; // below an arm pit the arm is part of the outline
constexpr double HIDDEN_PIT = 0.62;    // of stature: arms touch the trunk from here up
constexpr double BELOW_PIT = 0.02;     // of stature: near its pit every arm meets the trunk
constexpr double ARM_LEVEL = 0.004;    // of stature: an arm's section counts for levels so near

} // namespace

double arm_joins(const ArmTrace& arm, double stature) {
  if (arm.pit_hidden)
    return HIDDEN_PIT * stature;
  const double merge = arm.merge ? arm.merge->y() : arm.axilla->y();
  return std::min(arm.axilla->y(), merge) - PIT_MARGIN_M;
}

std::optional<Level> measure_level(const Finder& f, double y) {
  const auto& loop = f.levels.trunk_at(y);
  if (!loop)
    return std::nullopt;
  double limit[2] = {1e300, 1e300}; // x of the left and (negated) of the right arm pit
  for (int side = 0; side < 2; ++side)
    if (f.arms[side].axilla && y > arm_joins(f.arms[side], f.s))
      limit[side] = std::abs(f.arms[side].axilla->x());
  std::vector<Vec2> points;
  Vec2 low = Vec2::Constant(1e300), high = Vec2::Constant(-1e300);
  for (const auto& segment : loop->segments) {
    const Vec2& q = segment[0];
    if (q.x() > limit[0] || -q.x() > limit[1])
      continue;
    points.push_back(q);
    low = low.cwiseMin(q);
    high = high.cwiseMax(q);
  }
  if (points.size() < 3)
    return std::nullopt;
  Level level;
  level.y = y;
  level.girth_m = closed_length(convex_hull(std::move(points)));
  level.width_m = high.x() - low.x();
  level.depth_m = high.y() - low.y();
  return level;
}

bool arm_hangs_on(const Finder& f, double y) {
  const auto& loop = f.levels.trunk_at(y);
  if (!loop)
    return false;
  for (const ArmTrace& arm : f.arms) {
    if (arm.sections.empty() ||
        (!arm.pit_hidden && arm.axilla && y > arm.axilla->y() - BELOW_PIT * f.s))
      continue;
    for (const LimbSection& section : arm.sections)
      if (std::abs(section.center.y() - y) < ARM_LEVEL * f.s &&
          encloses(*loop, Vec2(section.center.x(), section.center.z())))
        return true;
  }
  return false;
}

void put_level(const Finder& f, const std::string& name, double y, const std::string& rule) {
  if (auto level = measure_level(f, y)) {
    level->rule = rule;
    f.body.levels[name] = *level;
  }
}

void find_level(const Finder& f, const std::string& name,
                std::initializer_list<LandmarkRule<Level>> rules) {
  const auto chosen = f.choose<Level>(name, name, rules);
  if (!chosen)
    return;
  f.body.levels[name] = chosen->value;
  f.body.levels[name].rule = chosen->rule->name;
}

std::optional<Vec3> front_at(const Finder& f, double x, double y, double half_width) {
  const auto m = midline(f.levels, y, x, half_width);
  if (!m)
    return std::nullopt;
  return Vec3(x, y, m->front);
}

std::optional<Vec3> place_of(const std::optional<Foremost>& foremost) {
  return foremost ? std::optional(foremost->p) : std::nullopt;
}

} // namespace sloper::body
