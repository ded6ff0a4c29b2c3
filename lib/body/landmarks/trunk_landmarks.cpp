#include <body/landmarks/landmark_finder.hpp>
#include <body/measure/foremost.hpp>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <optional>

namespace sloper::body {

namespace {

// Levels and windows in which the skin is read; what says where a body's places are stands in
// rules/standard.json.
constexpr double PIT_MARGIN_M = 0.002;     // below an arm pit the arm is part of the outline
constexpr double HIDDEN_PIT = 0.62;        // of stature: arms touch the trunk from here up
constexpr double BELOW_PIT = 0.02;         // of stature: near its pit every arm meets the trunk
constexpr double ARM_LEVEL = 0.004;        // of stature: an arm's section counts for levels so near
constexpr double FRONT_HALF_WIDTH = 0.006; // of stature, over which the front is read
constexpr double FOLD_HALF_WIDTH = 0.005;  // of stature, over which the fold's profile is read
constexpr double FOLD_STEP = 0.003;        // of stature, over which its slope is taken
constexpr double FOLD_SEARCH_STEP = 0.0015;   // of stature
constexpr double LEVEL_STEP_M = 0.002;        // between levels of a girth's curve
constexpr double ABOVE_CROTCH_M = 0.004;      // the first level that is the trunk's
constexpr double LEGS_BELOW_CROTCH_M = 0.010; // where both legs are apart
constexpr double CROTCH_SEARCH_M = 0.02;      // above the crotch, in which legs become one
constexpr double BESIDE_MIDDLE_M = 0.002;     // a side begins here
constexpr double MUSCLE_HALF_WIDTH = 0.004;   // of stature, over which a nipple's front is read
constexpr double MUSCLE_ABOVE = 0.002;        // of stature: the skin beside a nipple, not its tip
constexpr double SEAT_DIFFERENCE_M = 0.005;   // people's sides of the seat differ by less
constexpr double SIDE_HALF_DEPTH = 0.01;      // of stature, in which the waist's side is outermost
constexpr double UNDERBUST_MARGIN_M = 0.005;  // the waist's curve begins below the bust's band
constexpr std::size_t LEAST_CURVE = 5;        // levels of a curve that can have a minimum

/// The trunk's outline without arms that hang on it: clipped at the arm pits.
std::optional<Level> measure_level(const Finder& f, double y) {
  const auto& loop = f.levels.trunk_at(y);
  if (!loop)
    return std::nullopt;
  double limit[2] = {1e300, 1e300}; // x of the left and (negated) of the right arm pit
  for (int side = 0; side < 2; ++side)
    if (f.arms[side].axilla &&
        y > (f.arms[side].pit_hidden
                 ? HIDDEN_PIT * f.s
                 : f.arms[side].axilla->y() -
                       PIT_MARGIN_M)) // an arm that touches hangs on it below the pit too
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

/// An arm that touches the trunk below the pit is part of this level's outline, which tells no
/// breadth of the trunk then.
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

/// Of stature: a belly's upper end may stand out before the chest by this much; of 24 men by 0.002
/// or by more than 0.005, which is another place.
constexpr double BELLY_BEFORE = 0.0035;
constexpr double PEAKED = 0.00018; // of stature: as far out as the top of what has one

std::optional<Vec3> place_of(const std::optional<Foremost>& foremost) {
  return foremost ? std::optional(foremost->p) : std::nullopt;
}

/// From `inner` to `outer` beside the mid-plane on one side.
Span half_front(int side, double inner, double outer) {
  return side == 0 ? Span{inner, outer} : Span{-outer, -inner};
}

/// The front of the chest on one side.
Span chest_half(const Finder& f, int side) {
  return half_front(side, BESIDE_MIDDLE_M, f.number("bust.chest_end") * f.s);
}

/// Foremost skin of the trunk at (x, y).
std::optional<Vec3> front_at(const Finder& f, double x, double y, double half_width) {
  const auto m = midline(f.levels, y, x, half_width);
  if (!m)
    return std::nullopt;
  return Vec3(x, y, m->front);
}

/// A bump of the chest is a nipple when it is high, both sides agree and it lies where one can be:
/// near the foremost skin of its side.
bool is_nipple_pair(const Finder& f) {
  const auto &l = f.figure.nipple[0], &r = f.figure.nipple[1];
  if (!l || !r || std::min(l->height, r->height) <= f.number("bust.bump"))
    return false;
  if (std::abs(l->p.y() - r->p.y()) >= f.number("bust.bumps_aslant") * f.s)
    return false;
  if (std::abs(l->p.x() + r->p.x()) >= f.number("bust.bumps_off_middle") * f.s)
    return false;
  const double near = f.number("bust.bump_near") * f.s;
  for (int side = 0; side < 2; ++side) {
    const Vec3& p = f.figure.nipple[side]->p;
    const auto foremost =
        foremost_place(f, {p.y() - near, p.y() + near}, chest_half(f, side), 1, PEAKED);
    // a clear bump is believed farther back: a stout trunk leans, and its belly or the middle of
    // its chest is foremost
    const double clear =
        std::clamp(std::min(l->height, r->height) / f.number("bust.bump") - 1, 0.0, 1.0);
    if (foremost && p.z() < foremost->p.z() - (1 + 2 * clear) * f.number("bust.bump_behind") * f.s)
      return false;
  }
  return true;
}

using BothSides = std::array<std::optional<Vec3>, 2>;

/// Bust points beside the mid-plane at the given height. On a bust the foremost skin near the
/// expected height draws them half way, sideways as far as it stands out clearly from the skin
/// between both sides.
/// @return whether it did on either side
bool bust_at(const Finder& f, double expected, double y, BothSides& points) {
  const double s = f.s;
  const Span inner_outer{f.number("bust.inner") * s, f.number("bust.outer") * s};
  const double search = f.number("bust.search") * s;
  const double believed = f.number("bust.believed") * s;
  bool drawn = false;
  for (int side = 0; side < 2; ++side) {
    double height = y, x = (side == 0 ? 1 : -1) * f.number("bust.beside") * s;
    if (f.situation.female)
      if (const auto place =
              foremost_place(f, {expected - search, expected + search},
                             half_front(side, inner_outer.low, inner_outer.high), 1, PEAKED))
        if (const Vec3* p = &place->p;
            p->y() > expected - believed && p->y() < expected + believed) {
          height = 0.5 * (y + p->y());
          drawn = true;
          if (const auto between = front_at(f, 0, p->y(), FRONT_HALF_WIDTH * s))
            x += 0.5 *
                 std::clamp((p->z() - between->z()) / (f.number("bust.clear_of_middle") * s), 0.0,
                            1.0) *
                 (p->x() - x);
        }
    points[side] = front_at(f, x, height, FRONT_HALF_WIDTH * s);
  }
  return drawn;
}

/// Where a belly runs out before the chest, the foremost place of the chest is said to be unsure:
/// with the place, if there is one, that stands out between both ends of the heights.
void doubt_prominence(const Finder& f, int side, const Vec3& bust_point) {
  constexpr double AT_END = 0.004, DOUBT = 0.5; // of stature, of the confidence
  constexpr double FAR_APART = 0.02; // of stature: of 64 fresh bodies on one such place was wrong
  const std::string name = std::string("bust_prominent") + side_suffix(side);
  if (!f.has(name))
    return;
  const Span heights{bust_point.y() - f.number("bust.prominent_below") * f.s,
                     bust_point.y() + f.number("bust.prominent_above") * f.s};
  Landmark& landmark = f.body.landmarks[name];
  if (landmark.p.y() > heights.low + AT_END * f.s)
    return;
  const auto inside = place_of(foremost_place(f, heights, chest_half(f, side), 1, PEAKED, f.s));
  const Vec3 other = inside ? *inside : bust_point;
  if ((other - landmark.p).norm() < FAR_APART * f.s)
    return;
  f.also(name, other);
  landmark.confidence *= DOUBT;
  f.body.scan.findings.push_back(
      {"scan.landmark-unlikely"_id, "warning",
       "the belly runs out before the chest: its foremost place is unsure", name});
}

void find_bust(const Finder& f, double pit) {
  const double s = f.s, crotch = f.at("crotch").y(), trunk = f.at("neck_back").y() - crotch;
  const double by_trunk = crotch + f.number("bust.of_trunk") * trunk,
               by_pit = pit - f.number("bust.below_pit") * s;
  const double expected =
      f.by_population("bust_point", pit > 0 ? 0.5 * (by_trunk + by_pit) : by_trunk);
  using Found = std::optional<BothSides>;
  const auto points = f.choose<BothSides>(
      "bust_point", "bust_point",
      {{"bump_of_chest",
        [&]() -> Found {
          if (!is_nipple_pair(f))
            return std::nullopt;
          BothSides both;
          for (int side = 0; side < 2; ++side) {
            const Vec3& p = f.figure.nipple[side]->p;
            both[side] = front_at(f, p.x(), p.y() + MUSCLE_ABOVE * s, MUSCLE_HALF_WIDTH * s);
          }
          return both;
        }},
       {"above_chest_muscle",
        [&]() -> Found { // the chest muscles' lower corners
          const auto &l = f.figure.nipple[0], &r = f.figure.nipple[1];
          if (!l || !r)
            return std::nullopt;
          const double y = 0.5 * (l->p.y() + r->p.y()) + f.number("bust.above_muscle") * s;
          const double off = std::abs(y - expected) / (f.number("bust.muscle_near_ratio") * s);
          const double aslant =
              std::abs(l->p.y() - r->p.y()) / (f.number("bust.muscle_aslant") * s);
          if (off >= 1 || aslant >= 1)
            return std::nullopt; // it fades towards both, and where it is low, so that nothing
                                 // jumps
          const double clear =
              std::clamp(std::min(l->height, r->height) / f.number("bust.bump") - 0.5, 0.0, 1.0);
          const double share =
              0.5 * clear * std::min(1.0, 2 * (1 - off)) * std::min(1.0, 2 * (1 - aslant));
          BothSides both;
          bust_at(f, expected, expected + share * (y - expected), both);
          return both;
        }},
       {"foremost_near_ratio",
        [&]() -> Found {
          BothSides both;
          return bust_at(f, expected, expected, both) ? Found(both) : std::nullopt;
        }},
       {"trunk_ratio", [&]() -> Found {
          BothSides both;
          for (int side = 0; side < 2; ++side)
            both[side] = front_at(f, (side == 0 ? 1 : -1) * f.number("bust.beside") * s, expected,
                                  FRONT_HALF_WIDTH * s);
          return both;
        }}});
  if (!points)
    return;
  double sum = 0;
  int n = 0;
  for (int side = 0; side < 2; ++side) {
    if (!points->value[side])
      continue;
    const std::string suffix = side_suffix(side);
    const bool is_seen = points->rule->name == "bump_of_chest"; // what is seen is not corrected
    const std::optional<Vec3> point =
        is_seen ? points->value[side]
                : f.corrected("bust_point", suffix, *points->value[side], true);
    f.put("bust_point" + suffix, *point, 2, *points->rule);
    f.find("bust_prominent", suffix, 2,
           {{"foremost_of_chest", [&] {
               return place_of(foremost_place(f,
                                              {point->y() - f.number("bust.prominent_below") * s,
                                               point->y() + f.number("bust.prominent_above") * s},
                                              chest_half(f, side), 1, PEAKED, BELLY_BEFORE));
             }}});
    doubt_prominence(f, side, *point);
    if (const auto p = front_at(f, (side == 0 ? 1 : -1) * f.number("bust.beside") * s, expected,
                                FRONT_HALF_WIDTH * s))
      f.also("bust_point" + suffix, *p);
    sum += point->y();
    ++n;
  }
  if (n == 2)
    put_level(f, "bust", sum / 2, points->rule->name);
}

/// Height of the fold under the breast: below the bust point, where the front turns from falling
/// back to falling straight.
std::optional<double> breast_fold(const Finder& f, double bust_y, double expected) {
  const double s = f.s, step = FOLD_STEP * s;
  const double begin = bust_y - f.number("underbust.fold_begin") * s;
  const double end = bust_y - f.number("underbust.fold_end") * s;
  if (!f.has("bust_point_l") || !f.has("bust_point_r"))
    return std::nullopt;
  double sum = 0;
  int n = 0;
  for (const char* name : {"bust_point_l", "bust_point_r"}) {
    const double x = f.at(name).x();
    double sharpest = f.number("underbust.fold_turn"), at = 0;
    for (double y = begin; y > end; y -= FOLD_SEARCH_STEP * s) {
      const auto a = front_at(f, x, y + 2 * step, FOLD_HALF_WIDTH * s),
                 b = front_at(f, x, y, FOLD_HALF_WIDTH * s),
                 c = front_at(f, x, y - 2 * step, FOLD_HALF_WIDTH * s);
      if (!a || !b || !c)
        continue;
      const double turn = (c->z() - b->z()) / (2 * step) - (b->z() - a->z()) / (2 * step);
      if (turn > sharpest) {
        sharpest = turn;
        at = y;
      }
    }
    if (at > 0) {
      sum += at;
      ++n;
    }
  }
  if (n == 0)
    return std::nullopt;
  return (sum + (2 - n) * expected) / 2;
}

/// One side of a curve is higher than `least` by so much before it falls below it again: the
/// smaller of both sides.
double prominence(const std::vector<double>& curve, std::size_t least) {
  double before = 0, after = 0;
  for (std::size_t i = 0; i < least; ++i)
    before = std::max(before, curve[i] - curve[least]);
  for (std::size_t i = least + 1; i < curve.size(); ++i)
    after = std::max(after, curve[i] - curve[least]);
  return std::min(before, after);
}

void find_waist_minima(const Finder& f, double top, double bottom) {
  std::vector<Level> curve;
  for (double y = top; y > bottom; y -= LEVEL_STEP_M) {
    if (arm_hangs_on(f, y)) {
      f.body.scan.findings.push_back(
          {"scan.arm-touches-trunk"_id, "warning",
           "an arm touches the trunk: its least girth and breadth are not found", "waist"});
      return;
    }
    if (const auto level = measure_level(f, y))
      curve.push_back(*level);
  }
  if (curve.size() < LEAST_CURVE)
    return;
  auto least_of = [&](const char* name, double Level::*measure) -> std::optional<Level> {
    std::vector<double> values;
    for (const Level& level : curve)
      values.push_back(level.*measure);
    const std::size_t least =
        static_cast<std::size_t>(std::min_element(values.begin(), values.end()) - values.begin());
    const double rise = prominence(values, least);
    char text[160];
    std::snprintf(text, sizeof text, "%s: least %.3f m at y %.3f, %.1f mm below its surroundings",
                  name, values[least], curve[least].y, 1000 * rise);
    f.explain(text);
    if (rise < f.number("waist.prominence"))
      return std::nullopt;
    return curve[least];
  };
  find_level(f, "waist_girth_min",
             {{"smallest_girth", [&] { return least_of("waist_girth_min", &Level::girth_m); }}});
  find_level(f, "waist_width_min",
             {{"smallest_width", [&] { return least_of("waist_width_min", &Level::width_m); }}});
}

/// Navel: a dimple near the middle, or the proportion. @return its height
std::optional<double> find_navel(const Finder& f) {
  const double s = f.s, crotch = f.at("crotch").y(), trunk = f.at("neck_back").y() - crotch;
  const double expected =
      f.by_population("omphalion", crotch + f.number("omphalion.of_trunk") * trunk);
  const auto& dimple = f.figure.navel;
  const auto place = f.choose<Vec2>(
      "omphalion", "omphalion",
      {{"dimple",
        [&]() -> std::optional<Vec2> {
          if (!dimple)
            return std::nullopt;
          // by how deep it is and how near to the proportion it counts, so that nothing jumps: half
          // for the depth that the rule names
          const double deep = -dimple->height / f.number("omphalion.dimple"),
                       off = std::abs(dimple->p.y() - expected) /
                             (f.number("omphalion.dimple_near") * s);
          const double share = std::clamp((deep - f.number("omphalion.dimple_counts")) /
                                              f.number("omphalion.dimple_range"),
                                          0.0, 1.0) *
                               std::clamp(3 * (1 - off), 0.0, 1.0);
          if (share <= 0)
            return std::nullopt;
          const Vec2 seen(dimple->p.x(), dimple->p.y() + f.number("omphalion.above_dimple") * s);
          return Vec2(share * seen + (1 - share) * Vec2(0, expected));
        }},
       {"trunk_ratio", [&] { return std::optional(Vec2(0, expected)); }}});
  if (!place)
    return std::nullopt;
  const double navel =
      place->value.y() + (place->rule->name == "dimple" ? 0.0 : f.correction("omphalion").y());
  // the tape and the truth lie on the belly's surface beside the dimple, not at its bottom
  if (const auto p = front_at(f, place->value.x(), navel, FRONT_HALF_WIDTH * s))
    f.put("omphalion", *p, 2, *place->rule);
  if (const auto p = front_at(f, 0, expected, FRONT_HALF_WIDTH * s))
    f.also("omphalion", *p);
  put_level(f, "omphalion", navel, place->rule->name);
  return navel;
}

double find_waist(const Finder& f, const std::optional<double>& navel, double pit) {
  const double s = f.s, crotch = f.at("crotch").y();
  const double top = pit > 0 ? pit : f.number("waist.usual_pit") * s;
  const double by_ratio = crotch + f.number("waist.of_trunk") * (top - crotch);
  const auto height = f.choose<double>(
      "waist_semantic", "waist_semantic",
      {{"trunk_ratio_and_navel",
        [&]() -> std::optional<double> {
          if (!navel || !f.has("omphalion") || f.body.landmarks["omphalion"].rule != "dimple")
            return std::nullopt;
          const double reach = f.number("waist.navel_reach") * s;
          const double above = std::clamp(*navel + f.number("waist.above_navel") * s,
                                          by_ratio - reach, by_ratio + reach);
          const double weight = f.number("waist.navel_weight") +
                                f.number("waist.navel_weight_female") * f.figure.female;
          return by_ratio + weight * (above - by_ratio);
        }},
       {"trunk_ratio", [&] { return std::optional(by_ratio); }}});
  if (!height)
    return by_ratio;
  const double waist =
      height->value + 0.5 * (f.correction("waist", "_l").y() + f.correction("waist", "_r").y());
  put_level(f, "waist_semantic", waist, height->rule->name);
  const auto& loop = f.levels.trunk_at(waist);
  if (!loop)
    return waist;
  const double depth = f.has("hip_center")
                           ? f.at("hip_center").z() + f.number("waist.side_depth") * s
                           : loop->centroid.y();
  for (int side = 0; side < 2; ++side)
    f.find("waist_side", side_suffix(side), 2,
           {{"outermost_at_waist", [&]() -> std::optional<Vec3> {
               const double sign = side == 0 ? 1 : -1;
               std::optional<Vec2> outer;
               for (const auto& seg : loop->segments)
                 if (const auto piece =
                         clipped(seg, 1, depth - SIDE_HALF_DEPTH * s, depth + SIDE_HALF_DEPTH * s))
                   for (const Vec2& q : *piece)
                     if (!outer || sign * q.x() > sign * outer->x())
                       outer = q;
               if (!outer)
                 return std::nullopt;
               return Vec3(outer->x(), waist, depth);
             }}});
  return waist;
}

void find_seat_and_belly(const Finder& f, double crotch, double waist) {
  constexpr double AT_WAIST = 0.006, LESS_FAR = 0.003; // of stature
  const double s = f.s;
  const double half_belly = f.number("abdomen.half_breadth") * s;
  const double half_seat = f.number("buttock.half_breadth") * s;
  std::optional<Foremost> belly;
  std::optional<Vec3> rival; // as far out, far from where bellies are foremost
  auto foremost = [&]() -> std::optional<Vec3> {
    belly = foremost_place(f, {crotch + f.number("abdomen.above_crotch") * s, waist},
                           {-half_belly, half_belly}, 1, f.number("abdomen.flat"), 0);
    if (!belly)
      return std::nullopt;
    const double usual = f.number("abdomen.usual") * (waist - crotch),
                 near = 0.5 * (waist - crotch), reach = f.number("abdomen.usual_reach");
    if (const auto other =
            foremost_place(f, {crotch + usual - reach * near, crotch + usual + reach * near},
                           {-half_belly, half_belly}, 1, f.number("abdomen.flat"), 0);
        other && std::abs(other->p.y() - belly->p.y()) > f.number("abdomen.apart") * s &&
        other->p.z() > belly->p.z() - f.number("abdomen.as_far") * s) {
      rival = belly->p;
      belly = other;
    }
    if (!rival && belly->p.y() > waist - AT_WAIST * s) { // it runs on into the chest
      const auto bulge =
          foremost_place(f, {crotch + f.number("abdomen.above_crotch") * s, waist},
                         {-half_belly, half_belly}, 1, f.number("abdomen.flat"), LESS_FAR);
      if (bulge && std::abs(bulge->p.y() - belly->p.y()) > f.number("abdomen.apart") * s)
        rival = bulge->p;
    }
    return place_of(belly);
  };
  if (f.find("abdomen_front", "", 2, {{"foremost_below_waist", foremost}})) {
    put_level(f, "abdomen", belly->p.y(), "abdomen_front");
    Landmark& landmark = f.body.landmarks["abdomen_front"];
    landmark.spread_m = std::max(landmark.spread_m, belly->spread_m);
    if (rival) {
      f.also("abdomen_front", *rival);
      landmark.confidence *= 0.5;
      char text[160];
      std::snprintf(text, sizeof text,
                    "the belly is flat: it is about as far out at %.3f m, %.0f mm %s", rival->y(),
                    1000 * std::abs(rival->y() - belly->p.y()),
                    rival->y() > belly->p.y() ? "higher" : "lower");
      f.body.scan.findings.push_back({"scan.belly-flat"_id, "info", text, "abdomen"});
    }
    if (!rival && belly->spread_m > f.number("abdomen.unsure") * s) {
      landmark.confidence *= 0.5;
      char text[160];
      std::snprintf(
          text, sizeof text,
          "the belly is flat: the level of its front is ambiguous, between %.3f and %.3f m",
          belly->low, belly->high);
      f.body.scan.findings.push_back({"scan.belly-flat"_id, "info", text, "abdomen"});
    }
  }
  auto rearmost = [&] { // both sides of the seat are nearly level: the left one is taken unless the
                        // right one stands out more than people's do
    const Span heights{crotch + ABOVE_CROTCH_M, waist};
    auto rear = foremost_place(f, heights, {0, half_seat}, -1, PEAKED);
    if (const auto right = foremost_place(f, heights, {-half_seat, 0}, -1, PEAKED);
        right && (!rear || right->p.z() < rear->p.z() - SEAT_DIFFERENCE_M))
      rear = right;
    return place_of(rear);
  };
  if (f.find("buttock_back", "", 2, {{"rearmost_below_waist", rearmost}})) {
    const double hip = f.at("buttock_back").y();
    put_level(f, "hip", hip, "buttock_back");
    f.find("hip_section_center", "", 2, {{"section_at_hip", [&]() -> std::optional<Vec3> {
                                            const auto& loop = f.levels.trunk_at(hip);
                                            if (!loop)
                                              return std::nullopt;
                                            return Vec3(loop->centroid.x(), hip,
                                                        loop->centroid.y());
                                          }}});
  }
  find_level(f, "hip_girth_max",
             {{"largest_girth", [&] {
                 std::optional<Level> most;
                 for (double y = crotch + ABOVE_CROTCH_M; y < waist; y += LEVEL_STEP_M)
                   if (const auto level = arm_hangs_on(f, y) ? std::nullopt : measure_level(f, y))
                     if (!most || level->girth_m > most->girth_m)
                       most = level;
                 return most;
               }}});
}

} // namespace

void find_trunk_landmarks(const Finder& f) {
  const double s = f.s;
  if (!f.has("crotch") || !f.has("neck_back"))
    return;
  const double crotch = f.at("crotch").y();
  double pit = 0, fold = 0;
  int n_pit = 0, n_fold = 0;
  for (int side = 0; side < 2; ++side) {
    const std::string suffix = side_suffix(side);
    if (f.has("axilla" + suffix)) {
      pit += f.at("axilla" + suffix).y();
      ++n_pit;
    }
    for (const char* name : {"axilla_front", "axilla_back"})
      if (f.has(name + suffix)) {
        fold += f.at(name + suffix).y();
        ++n_fold;
      }
  }
  if (n_pit)
    pit /= n_pit;
  find_level(f, "chest_axilla", {{"axilla_folds", [&] {
                                    return n_fold ? measure_level(f, fold / n_fold) : std::nullopt;
                                  }}});
  find_bust(f, pit);
  const auto navel = find_navel(f);
  const double waist = find_waist(f, navel, pit);
  find_seat_and_belly(f, crotch, waist);
  // the first level above the crotch whose outline goes around both legs: skin that hangs between
  // them is lower than where they join
  const auto left = f.levels.leg_at(crotch - LEGS_BELOW_CROTCH_M, 0);
  const auto right = f.levels.leg_at(crotch - LEGS_BELOW_CROTCH_M, 1);
  for (double y = crotch + ABOVE_CROTCH_M;
       y < crotch + CROTCH_SEARCH_M && !f.body.levels.count("crotch"); y += LEVEL_STEP_M) {
    const auto& loop = f.levels.trunk_at(y);
    if (loop && left && right &&
        (loop->high.x() < left->centroid.x() || loop->low.x() > right->centroid.x()))
      continue;
    put_level(f, "crotch", y, "crotch");
  }
  if (f.body.levels.count("crotch"))
    f.body.levels["crotch"].y = crotch;
  double under = waist + f.number("underbust.above_waist") * s;
  if (f.body.levels.count("bust")) {
    const double bust = f.body.levels["bust"].y,
                 expected = bust - f.number("underbust.below_bust") * s;
    const auto chosen =
        f.choose<double>("underbust", "underbust",
                         {{"fold_under_bust", [&] { return breast_fold(f, bust, expected); }},
                          {"below_bust", [&] { return std::optional(expected); }}});
    under = chosen ? chosen->value : expected;
    if (chosen)
      put_level(f, "underbust", under, chosen->rule->name);
  }
  find_waist_minima(f, under - UNDERBUST_MARGIN_M,
                    0.5 * (navel.value_or(crotch + f.number("omphalion.of_trunk") *
                                                       (f.at("neck_back").y() - crotch)) +
                           crotch));
}

} // namespace sloper::body
