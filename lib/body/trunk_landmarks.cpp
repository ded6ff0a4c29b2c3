#include <body/landmark_finder.hpp>

#include <algorithm>
#include <cmath>

namespace sloper::body {

namespace {

/// The trunk's outline without arms that hang on it: clipped at the arm pits.
std::optional<Level> measure_level(const Finder& f, double y) {
  const auto loop = f.levels.trunk_at(y);
  if (!loop) return std::nullopt;
  double limit[2] = {1e300, 1e300}; // x of the left and (negated) of the right arm pit
  for (int side = 0; side < 2; ++side)
    if (f.arms[side].axilla && y > f.arms[side].axilla->y() - 0.002) limit[side] = std::abs(f.arms[side].axilla->x());
  std::vector<Vec2> points;
  Vec2 low = Vec2::Constant(1e300), high = Vec2::Constant(-1e300);
  for (const auto& segment : loop->segments) {
    const Vec2& q = segment[0];
    if (q.x() > limit[0] || -q.x() > limit[1]) continue;
    points.push_back(q);
    low = low.cwiseMin(q);
    high = high.cwiseMax(q);
  }
  if (points.size() < 3) return std::nullopt;
  Level level;
  level.y = y;
  level.girth_m = closed_length(convex_hull(std::move(points)));
  level.width_m = high.x() - low.x();
  level.depth_m = high.y() - low.y();
  return level;
}

void put_level(const Finder& f, const std::string& name, double y, const std::string& rule) {
  if (auto level = measure_level(f, y)) {
    level->rule = rule;
    f.body.levels[name] = *level;
  }
}

/// Foremost (or rearmost) point of the trunk between two heights.
std::optional<Vec3> extreme_depth(const Finder& f, double y0, double y1, double sign, double x_low, double x_high) {
  std::optional<Vec3> best;
  for (double y = y0; y <= y1; y += 0.002) {
    const auto loop = f.levels.trunk_at(y);
    if (!loop) continue;
    for (const auto& segment : loop->segments) {
      const Vec2& q = segment[0];
      if (q.x() < x_low || q.x() > x_high) continue;
      if (!best || sign * q.y() > sign * best->z()) best = Vec3(q.x(), y, q.y());
    }
  }
  return best;
}

} // namespace

void find_trunk_landmarks(const Finder& f) {
  const double s = f.s;
  if (!f.has("crotch") || !f.has("neck_back")) return;
  const double crotch = f.at("crotch").y(), trunk = f.at("neck_back").y() - crotch;
  auto share = [&](const char* rule) { return crotch + f.number(rule) * trunk; };
  const double waist = share("waist.of_trunk"), navel = share("omphalion.of_trunk"), bust = share("bust.of_trunk");
  const double shoulder_width = f.arms[0].axilla ? std::abs(f.arms[0].axilla->x()) : 0.11 * s;
  // bust: the foremost point of each side around the expected height
  double bust_y = 0;
  int n_bust = 0;
  for (int side = 0; side < 2; ++side) {
    const double a = side == 0 ? 0.025 * s : -shoulder_width, b = side == 0 ? shoulder_width : -0.025 * s;
    if (const auto p = extreme_depth(f, bust - 0.045 * s, bust + 0.03 * s, 1, a, b)) {
      f.put(std::string("bust_prominent") + side_suffix(side), *p, 2, "foremost_of_chest", 0.8, 0.006);
      f.put(std::string("bust_point") + side_suffix(side), *p, 2, "foremost_of_chest", 0.5, 0.012);
      bust_y += p->y(), ++n_bust;
    }
  }
  if (n_bust == 2) put_level(f, "bust", bust_y / 2, "bust_points");
  if (const auto p = midline(f.levels, navel, 0, 0.006 * s)) f.put("omphalion", Vec3(0, navel, p->front), 2, "trunk_ratio", 0.4, 0.02);
  put_level(f, "omphalion", navel, "trunk_ratio");
  put_level(f, "waist_semantic", waist, "trunk_ratio");
  if (const auto loop = f.levels.trunk_at(waist))
    for (int side = 0; side < 2; ++side) {
      Vec2 outer = loop->segments.front()[0];
      for (const auto& seg : loop->segments)
        if ((side == 0 ? 1 : -1) * (seg[0].x() - outer.x()) > 0) outer = seg[0];
      f.put(std::string("waist_side") + side_suffix(side), Vec3(outer.x(), waist, outer.y()), 2, "outermost_at_waist", 0.5, 0.015);
    }
  if (const auto p = extreme_depth(f, crotch + 0.004, waist, 1, -0.1 * s, 0.1 * s)) {
    f.put("abdomen_front", *p, 2, "foremost_below_waist", 0.8, 0.008);
    put_level(f, "abdomen", p->y(), "abdomen_front");
  }
  if (const auto p = extreme_depth(f, crotch + 0.004, waist, -1, -0.12 * s, 0.12 * s)) {
    f.put("buttock_back", *p, 2, "rearmost_below_waist", 0.9, 0.005);
    put_level(f, "hip", p->y(), "buttock_back");
    if (const auto loop = f.levels.trunk_at(p->y()))
      f.put("hip_section_center", Vec3(loop->centroid.x(), p->y(), loop->centroid.y()), 2, "section_at_hip", 0.9, 0.005);
  }
  put_level(f, "crotch", crotch + 0.004, "crotch");
  if (f.body.levels.count("crotch")) f.body.levels["crotch"].y = crotch;
  double fold_y = 0;
  int n_fold = 0;
  for (int side = 0; side < 2; ++side)
    for (const char* name : {"axilla_front", "axilla_back"})
      if (f.has(name + std::string(side_suffix(side)))) fold_y += f.at(name + std::string(side_suffix(side))).y(), ++n_fold;
  if (n_fold) put_level(f, "chest_axilla", fold_y / n_fold, "axilla_folds");
  // girth curve: smallest between bust and hip, largest below the waist
  const double fold = n_bust == 2 ? bust_y / 2 - 0.03 * s : bust - 0.03 * s;
  put_level(f, "underbust", fold, "below_bust");
  std::optional<Level> least, narrow, most;
  for (double y = fold - 0.005; y > 0.5 * (navel + crotch); y -= 0.002)
    if (const auto level = measure_level(f, y)) {
      if (!least || level->girth_m < least->girth_m) least = level;
      if (!narrow || level->width_m < narrow->width_m) narrow = level;
    }
  for (double y = crotch + 0.004; y < waist; y += 0.002)
    if (const auto level = measure_level(f, y))
      if (!most || level->girth_m > most->girth_m) most = level;
  auto put_extremum = [&](const char* name, std::optional<Level> level, const char* rule) {
    if (!level) return;
    level->rule = rule;
    f.body.levels[name] = *level;
  };
  put_extremum("waist_girth_min", least, "smallest_girth");
  put_extremum("waist_width_min", narrow, "smallest_width");
  put_extremum("hip_girth_max", most, "largest_girth");
}

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
  // neck: rings through the neck landmarks
  auto ring = [&](const Vec3& back, const Vec3& front) {
    const Vec3 middle = 0.5 * (back + front), axis = Vec3::UnitX().cross(front - back);
    double girth = 0;
    for (const Loop& loop : cut(f.levels.skin(), cross_plane(middle, -axis)))
      if (encloses(loop, Vec2::Zero())) girth = std::max(girth, taut_girth(loop));
    return girth;
  };
  if (f.has("neck_back") && f.has("neck_front")) {
    const Vec3 back = f.at("neck_back"), front = f.at("neck_front"), up(0, 0.03 * s, 0);
    if (const double g = ring(back + up, front + up); g > 0 && g < 0.4 * s) f.body.girths["neck"] = {g, 0.006};
    if (const double g = ring(back, front); g > 0) f.body.girths["neck_base"] = {std::min(g, 0.3 * s), 0.01};
  }
}

} // namespace sloper::body
