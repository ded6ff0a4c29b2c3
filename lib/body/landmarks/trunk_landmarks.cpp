#include <body/landmarks/belly_landmarks.hpp>
#include <body/landmarks/bust_landmarks.hpp>
#include <body/landmarks/trunk_section.hpp>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <optional>

namespace sloper::body {

namespace {

constexpr double LEGS_BELOW_CROTCH_M = 0.010; // where both legs are apart
constexpr double CROTCH_SEARCH_M = 0.02;      // above the crotch, in which legs become one
constexpr double SIDE_HALF_DEPTH = 0.01;      // of stature, in which the waist's side is outermost
constexpr double UNDERBUST_MARGIN_M = 0.005;  // the waist's curve begins below the bust's band
constexpr std::size_t LEAST_CURVE = 5;        // levels of a curve that can have a minimum

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

/// How surely a shallow dimple is more than roughness, 0 to 1: another place as deep makes it a
/// chance one.
double is_single(const Finder& f, const ReliefPoint& dimple) {
  constexpr double APART = 0.013; // of stature, between dimples
  const double radius = f.number("figure.relief_radius") * f.s;
  const double deepest = -dimple.height * f.s / f.number("figure.usual_stature");
  const auto dimples =
      tallest_reliefs(f.levels.skin(), navel_box(f.rules, f.s), radius, -1, APART * f.s, 0, 2);
  const double rival = dimples.size() < 2 ? 0 : -dimples[1].height / deepest;
  char text[120];
  std::snprintf(text, sizeof text, "navel: another dimple is %.2f as deep", rival);
  f.explain(text);
  const double least = f.number("omphalion.rival"), range = 1 - least;
  return std::clamp((1 - rival) / range, 0.0, 1.0);
}

/// Navel: a dimple near the middle, or the proportion. @return its height
std::optional<double> find_navel(const Finder& f) {
  const double s = f.s, crotch = f.at("crotch").y(), trunk = f.at("neck_back").y() - crotch;
  // The mean of two estimates: the one from the population moves by 6 mm with a lean of the scan,
  // the share of the trunk does not.
  const double by_trunk = crotch + f.number("omphalion.of_trunk") * trunk,
               expected = 0.5 * (by_trunk + f.by_population("omphalion", by_trunk)),
               likely = expected + f.correction("omphalion").y();
  const auto& dimple = f.figure.navel;
  const auto place = f.choose<Vec2>(
      "omphalion", "omphalion",
      {{"dimple",
        [&]() -> std::optional<Vec2> {
          if (!dimple)
            return std::nullopt;
          // by how deep it is and how near to the proportion it counts, so that nothing jumps
          const double deep = -dimple->height / f.number("omphalion.dimple"),
                       off = std::abs(dimple->p.y() - expected) /
                             (f.number("omphalion.dimple_near") * s);
          const double share = std::clamp((deep - f.number("omphalion.dimple_counts")) /
                                              f.number("omphalion.dimple_range"),
                                          0.0, 1.0) *
                               std::clamp(3 * (1 - off), 0.0, 1.0);
          const double single = deep < 1 ? is_single(f, *dimple) : 1;
          if (share * single <= 0)
            return std::nullopt;
          const Vec2 seen(dimple->p.x(), dimple->p.y() + f.number("omphalion.above_dimple") * s);
          return Vec2(Vec2(0, likely) + share * single * (seen - Vec2(0, likely)));
        }},
       {"trunk_ratio", [&] { return std::optional(Vec2(0, likely)); }}});
  if (!place)
    return std::nullopt;
  const double navel = place->value.y();
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
