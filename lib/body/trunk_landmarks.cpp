#include <body/landmark_finder.hpp>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <optional>

namespace sloper::body {

namespace {

/// The trunk's outline without arms that hang on it: clipped at the arm pits.
std::optional<Level> measure_level(const Finder& f, double y) {
  const auto loop = f.levels.trunk_at(y);
  if (!loop) return std::nullopt;
  double limit[2] = {1e300, 1e300}; // x of the left and (negated) of the right arm pit
  for (int side = 0; side < 2; ++side)
    if (f.arms[side].axilla &&
        y > (f.arms[side].pit_hidden ? 0.62 * f.s : f.arms[side].axilla->y() - 0.002)) // an arm that touches hangs on it below the pit too
      limit[side] = std::abs(f.arms[side].axilla->x());
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

/// Foremost (or rearmost) point of the trunk between two heights. Where the trunk only runs out towards an end of the range,
/// the belly under a chest or the chest over a belly, the foremost place inside of it is the better answer, if there is one
/// and it stands out by no more than INSIDE less.
std::optional<Vec3> extreme_depth(const Finder& f, double y0, double y1, double sign, double x_low, double x_high) {
  constexpr double INSIDE = 0.006, FLAT = 0.0015, UPRIGHT = 0.00008; // m
  std::vector<Vec3> outline;                                         // one point per level
  for (double y = y0; y <= y1; y += 0.002) {
    const auto loop = f.levels.trunk_at(y);
    if (!loop) continue;
    std::optional<Vec3> outer;
    for (const auto& segment : loop->segments) {
      const Vec2& q = segment[0];
      if (q.x() < x_low || q.x() > x_high) continue;
      if (!outer || sign * q.y() > sign * outer->z()) outer = Vec3(q.x(), y, q.y());
    }
    if (!outer) continue;
    // on a flat front the middle of what is as far out as its vertices can tell
    double sum = 0, weight = 0;
    for (const auto& segment : loop->segments) {
      const Vec2 middle = 0.5 * (segment[0] + segment[1]);
      const double less = sign * (outer->z() - middle.y());
      if (middle.x() < x_low || middle.x() > x_high || less > FLAT) continue;
      const double w = (FLAT - less) * (segment[1] - segment[0]).norm();
      sum += w * middle.x(), weight += w;
    }
    if (weight > 0) outer->x() = sum / weight;
    outline.push_back(*outer);
  }
  if (outline.empty()) return std::nullopt;
  auto outwards = [&](const Vec3& a, const Vec3& b) { return sign * a.z() < sign * b.z(); };
  const auto most = std::max_element(outline.begin(), outline.end(), outwards);
  const std::ptrdiff_t n = static_cast<std::ptrdiff_t>(outline.size()), margin = 4;
  const std::ptrdiff_t at = most - outline.begin();
  if (at >= margin && at < n - margin) { // on an upright front the middle height of what is as far out
    Vec3 sum = Vec3::Zero();
    double weight = 0;
    for (const std::ptrdiff_t step : {std::ptrdiff_t{-1}, std::ptrdiff_t{1}})
      for (std::ptrdiff_t k = step < 0 ? at : at + 1; k >= 0 && k < n; k += step) {
        const Vec3& p = outline[static_cast<std::size_t>(k)];
        const double w = UPRIGHT - sign * (most->z() - p.z());
        if (w <= 0) break;
        sum += w * p, weight += w;
      }
    return Vec3(sum.x() / weight, sum.y() / weight, most->z());
  }
  if (n < 4 * margin) return *most;
  std::optional<Vec3> inner;
  for (std::ptrdiff_t k = margin; k < n - margin; ++k) { // a place that is the foremost within 16 mm to both sides
    const auto top =
        std::max_element(outline.begin() + std::max<std::ptrdiff_t>(0, k - 2 * margin), outline.begin() + std::min(n, k + 2 * margin + 1), outwards);
    if (top - outline.begin() == k && (!inner || outwards(*inner, outline[static_cast<std::size_t>(k)]))) inner = outline[static_cast<std::size_t>(k)];
  }
  return inner && std::abs(inner->z() - most->z()) < INSIDE ? *inner : *most;
}

} // namespace

namespace {

/// Foremost skin of the trunk at (x, y).
std::optional<Vec3> front_at(const Finder& f, double x, double y, double half_width) {
  const auto m = midline(f.levels, y, x, half_width);
  if (!m) return std::nullopt;
  return Vec3(x, y, m->front);
}

/// A bump of the chest is a nipple when it is high, both sides agree and it lies where one can be.
bool is_nipple_pair(const Finder& f) {
  const auto &l = f.figure.nipple[0], &r = f.figure.nipple[1];
  if (!l || !r || f.figure.female < 0.5) return false;
  const double low = std::min(l->height, r->height);
  return low > 0.0024 && std::abs(l->p.y() - r->p.y()) < 0.015 * f.s && std::abs(l->p.x() + r->p.x()) < 0.03 * f.s;
}

void find_bust(const Finder& f, double pit) {
  const double s = f.s, crotch = f.at("crotch").y(), trunk = f.at("neck_back").y() - crotch;
  const double by_trunk = crotch + f.number("bust.of_trunk") * trunk, by_pit = pit - f.number("bust.below_pit") * s;
  const double expected = pit > 0 ? 0.5 * (by_trunk + by_pit) : by_trunk;
  const bool relief = is_nipple_pair(f);
  f.explain(relief ? "bust: both sides have a bump, taken as the bust points" : "bust: no clear bumps, taken by proportion and the foremost skin");
  std::optional<double> by_bumps; // the chest muscles' lower corners
  if (const auto& l = f.figure.nipple[0], &r = f.figure.nipple[1]; !relief && l && r && std::abs(l->p.y() - r->p.y()) < 0.012 * s) {
    const double y = 0.5 * (l->p.y() + r->p.y()) + f.number("bust.above_muscle") * s;
    if (std::abs(y - expected) < 0.03 * s) by_bumps = y;
  }
  double sum = 0;
  int n = 0;
  for (int side = 0; side < 2; ++side) {
    const double sign = side == 0 ? 1 : -1;
    const std::string suffix = side_suffix(side);
    std::optional<Vec3> point;
    if (relief) {
      const Vec3& p = f.figure.nipple[side]->p;
      point = front_at(f, p.x(), p.y() + 0.002 * s, 0.004 * s);
    } else {
      double y = by_bumps ? 0.5 * (expected + *by_bumps) : expected;
      if (f.figure.female > 0.5) { // the foremost skin near the expected height
        const double a = 0.02 * s, b = 0.10 * s;
        if (const auto p = extreme_depth(f, expected - 0.035 * s, expected + 0.035 * s, 1, side == 0 ? a : -b, side == 0 ? b : -a))
          if (p->y() > expected - 0.033 * s && p->y() < expected + 0.033 * s) y = 0.5 * (y + p->y());
      }
      point = front_at(f, sign * f.number("bust.beside") * s, y, 0.006 * s);
    }
    if (!point) continue;
    f.put("bust_point" + suffix, *point, 2,
          relief     ? "bump_of_chest"
          : by_bumps ? "above_chest_muscle"
                     : "proportion",
          relief ? 0.85 : 0.5, relief ? 0.004 : 0.015);
    if (const auto p = extreme_depth(f, point->y() - 0.024 * s, point->y() + 0.06 * s, 1, side == 0 ? 0.002 : -0.14 * s, side == 0 ? 0.14 * s : -0.002))
      f.put("bust_prominent" + suffix, *p, 2, "foremost_of_chest", 0.8, 0.006);
    if (const auto p = front_at(f, sign * f.number("bust.beside") * s, expected, 0.006 * s)) f.also("bust_point" + suffix, *p);
    sum += point->y(), ++n;
  }
  if (n == 2) put_level(f, "bust", sum / 2, relief ? "bump_of_chest" : "proportion");
}

/// Height of the fold under the breast: below the bust point, where the front turns from falling back to falling straight.
double breast_fold(const Finder& f, double bust_y) {
  const double s = f.s, step = 0.003 * s;
  const double expected = bust_y - f.number("underbust.below_bust") * s;
  if (f.figure.female < 0.5 || !f.has("bust_point_l") || !f.has("bust_point_r")) return expected;
  double sum = 0;
  int n = 0;
  for (const char* name : {"bust_point_l", "bust_point_r"}) {
    const double x = f.at(name).x();
    double sharpest = 0.06, at = 0; // rad of turn that a fold must have
    for (double y = bust_y - 0.012 * s; y > bust_y - 0.065 * s; y -= 0.0015 * s) {
      const auto a = front_at(f, x, y + 2 * step, 0.005 * s), b = front_at(f, x, y, 0.005 * s), c = front_at(f, x, y - 2 * step, 0.005 * s);
      if (!a || !b || !c) continue;
      const double turn = (c->z() - b->z()) / (2 * step) - (b->z() - a->z()) / (2 * step);
      if (turn > sharpest) sharpest = turn, at = y;
    }
    if (at > 0) sum += at, ++n;
  }
  return n ? (sum + (2 - n) * expected) / 2 : expected;
}

/// One side of a curve is higher than `least` by so much before it falls below it again: the smaller of both sides.
double prominence(const std::vector<double>& curve, std::size_t least) {
  double before = 0, after = 0;
  for (std::size_t i = 0; i < least; ++i) before = std::max(before, curve[i] - curve[least]);
  for (std::size_t i = least + 1; i < curve.size(); ++i) after = std::max(after, curve[i] - curve[least]);
  return std::min(before, after);
}

void find_waist_minima(const Finder& f, double top, double bottom) {
  std::vector<Level> curve;
  for (double y = top; y > bottom; y -= 0.002)
    if (const auto level = measure_level(f, y)) curve.push_back(*level);
  if (curve.size() < 5) return;
  auto take = [&](const char* name, const char* rule, double Level::*measure) {
    std::vector<double> values;
    for (const Level& level : curve) values.push_back(level.*measure);
    const std::size_t least = static_cast<std::size_t>(std::min_element(values.begin(), values.end()) - values.begin());
    const double rise = prominence(values, least);
    char text[160];
    std::snprintf(text, sizeof text, "%s: least %.3f m at y %.3f, %.1f mm below its surroundings%s", name, values[least], curve[least].y, 1000 * rise,
                  rise < f.number("waist.prominence") ? ": no minimum" : "");
    f.explain(text);
    if (rise < f.number("waist.prominence")) return;
    Level level = curve[least];
    level.rule = rule;
    f.body.levels[name] = level;
  };
  take("waist_girth_min", "smallest_girth", &Level::girth_m);
  take("waist_width_min", "smallest_width", &Level::width_m);
}

/// Navel: a dimple near the middle, or the proportion. @return its height
double find_navel(const Finder& f) {
  const double s = f.s, crotch = f.at("crotch").y(), trunk = f.at("neck_back").y() - crotch;
  const double expected = crotch + f.number("omphalion.of_trunk") * trunk;
  const auto& dimple = f.figure.navel;
  const bool seen = dimple && -dimple->height > f.number("omphalion.dimple") && std::abs(dimple->p.y() - expected) < 0.06 * s;
  const double y = seen ? dimple->p.y() + f.number("omphalion.above_dimple") * s : expected, x = seen ? dimple->p.x() : 0.0;
  f.explain(seen ? "navel: a dimple near the middle" : "navel: no dimple, taken by proportion");
  // the tape and the truth lie on the belly's surface beside the dimple, not at its bottom
  if (const auto p = front_at(f, x, y, 0.006 * s)) f.put("omphalion", *p, 2, seen ? "dimple" : "trunk_ratio", seen ? 0.85 : 0.4, seen ? 0.006 : 0.02);
  if (const auto p = front_at(f, 0, expected, 0.006 * s)) f.also("omphalion", *p);
  put_level(f, "omphalion", y, seen ? "dimple" : "trunk_ratio");
  return y;
}

double find_waist(const Finder& f, double navel, double pit) {
  const double s = f.s, crotch = f.at("crotch").y();
  const double top = pit > 0 ? pit : 0.757 * s;
  double waist = crotch + f.number("waist.of_trunk") * (top - crotch);
  std::string rule = "trunk_ratio";
  if (f.has("omphalion") && f.body.landmarks["omphalion"].rule == "dimple") {
    const double above = std::clamp(navel + f.number("waist.above_navel") * s, waist - 0.02 * s, waist + 0.02 * s);
    waist += (0.25 + 0.25 * f.figure.female) * (above - waist);
    rule = "trunk_ratio_and_navel";
  }
  put_level(f, "waist_semantic", waist, rule);
  const auto loop = f.levels.trunk_at(waist);
  if (!loop) return waist;
  const double depth = f.has("hip_center") ? f.at("hip_center").z() + f.number("waist.side_depth") * s : loop->centroid.y();
  for (int side = 0; side < 2; ++side) {
    const double sign = side == 0 ? 1 : -1;
    std::optional<Vec2> outer;
    for (const auto& seg : loop->segments)
      if (std::abs(seg[0].y() - depth) < 0.01 * s && (!outer || sign * seg[0].x() > sign * outer->x())) outer = seg[0];
    if (outer) f.put(std::string("waist_side") + side_suffix(side), Vec3(outer->x(), waist, depth), 2, rule, 0.5, 0.015);
  }
  return waist;
}

} // namespace

void find_trunk_landmarks(const Finder& f) {
  const double s = f.s;
  if (!f.has("crotch") || !f.has("neck_back")) return;
  const double crotch = f.at("crotch").y();
  double pit = 0, fold = 0;
  int n_pit = 0, n_fold = 0;
  for (int side = 0; side < 2; ++side) {
    const std::string suffix = side_suffix(side);
    if (f.has("axilla" + suffix)) pit += f.at("axilla" + suffix).y(), ++n_pit;
    for (const char* name : {"axilla_front", "axilla_back"})
      if (f.has(name + suffix)) fold += f.at(name + suffix).y(), ++n_fold;
  }
  if (n_pit) pit /= n_pit;
  if (n_fold) put_level(f, "chest_axilla", fold / n_fold, "axilla_folds");
  find_bust(f, pit);
  const double navel = find_navel(f);
  const double waist = find_waist(f, navel, pit);
  if (const auto p = extreme_depth(f, crotch + 0.004, waist, 1, -0.1 * s, 0.1 * s)) {
    f.put("abdomen_front", *p, 2, "foremost_below_waist", 0.8, 0.008);
    put_level(f, "abdomen", p->y(), "abdomen_front");
  }
  // both sides of the seat are nearly level: the left one is taken unless the right one stands out clearly
  auto rear = extreme_depth(f, crotch + 0.004, waist, -1, 0, 0.12 * s);
  if (const auto right = extreme_depth(f, crotch + 0.004, waist, -1, -0.12 * s, 0); right && (!rear || right->z() < rear->z() - 0.0025)) rear = right;
  if (const auto p = rear) {
    f.put("buttock_back", *p, 2, "rearmost_below_waist", 0.9, 0.005);
    put_level(f, "hip", p->y(), "buttock_back");
    if (const auto loop = f.levels.trunk_at(p->y()))
      f.put("hip_section_center", Vec3(loop->centroid.x(), p->y(), loop->centroid.y()), 2, "section_at_hip", 0.9, 0.005);
  }
  // the first level above the crotch that has one loop
  for (double y = crotch + 0.004; y < crotch + 0.02 && !f.body.levels.count("crotch"); y += 0.002) put_level(f, "crotch", y, "crotch");
  if (f.body.levels.count("crotch")) f.body.levels["crotch"].y = crotch;
  double under = waist + 0.055 * s;
  if (f.body.levels.count("bust")) {
    under = breast_fold(f, f.body.levels["bust"].y);
    put_level(f, "underbust", under, f.figure.female > 0.5 ? "fold_under_bust" : "proportion");
  }
  find_waist_minima(f, under - 0.005, 0.5 * (navel + crotch));
  std::optional<Level> most;
  for (double y = crotch + 0.004; y < waist; y += 0.002)
    if (const auto level = measure_level(f, y))
      if (!most || level->girth_m > most->girth_m) most = level;
  if (most) {
    most->rule = "largest_girth";
    f.body.levels["hip_girth_max"] = *most;
  }
}

} // namespace sloper::body
