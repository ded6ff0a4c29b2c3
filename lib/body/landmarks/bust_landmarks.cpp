#include <body/landmarks/bust_landmarks.hpp>
#include <body/landmarks/trunk_section.hpp>

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace sloper::body {

namespace {

constexpr double FOLD_HALF_WIDTH = 0.005;   // of stature, over which the fold's profile is read
constexpr double FOLD_STEP = 0.003;         // of stature, over which its slope is taken
constexpr double FOLD_SEARCH_STEP = 0.0015; // of stature
constexpr double BESIDE_MIDDLE_M = 0.002;   // a side begins here
constexpr double MUSCLE_HALF_WIDTH = 0.004; // of stature, over which a nipple's front is read
constexpr double MUSCLE_ABOVE = 0.002;      // of stature: the skin beside a nipple, not its tip

/// Of stature, standard deviation of the lower end of the chest's front: the error of the bust
/// point and how far the fold under it is from where most bodies have it, on 614 bodies.
constexpr double CHEST_END_SD = 0.005;
/// Of stature, standard deviation of a chest's foremost place from which it is warned of. Of 616
/// sides of fresh bodies 42 are, 18 of them right within 15 mm; six are off by more than 40 mm.
constexpr double PROMINENCE_UNSURE = 0.009;
/// From `inner` to `outer` beside the mid-plane on one side.
Span half_front(int side, double inner, double outer) {
  return side == 0 ? Span{inner, outer} : Span{-outer, -inner};
}

/// The front of the chest on one side.
Span chest_half(const Finder& f, int side) {
  return half_front(side, BESIDE_MIDDLE_M, f.number("bust.chest_end") * f.s);
}

using BumpPair = std::array<ReliefPoint, 2>; ///< of the left and the right side

/// A bump of the chest is a nipple when it is high, both sides agree and it lies where one can be:
/// near the foremost skin of its side, and about the height that the rest of the body lets expect.
bool is_nipple_pair(const Finder& f, const BumpPair& pair, double expected) {
  const auto& [l, r] = pair;
  if (std::min(l.height, r.height) <= f.number("bust.bump"))
    return false;
  if (std::abs(l.p.y() - r.p.y()) >= f.number("bust.bumps_aslant") * f.s)
    return false;
  if (std::abs(l.p.x() + r.p.x()) >= f.number("bust.bumps_off_middle") * f.s)
    return false;
  if (std::abs(0.5 * (l.p.y() + r.p.y()) - expected) > f.number("bust.bump_far") * f.s)
    return false;
  const double near = f.number("bust.bump_near") * f.s;
  for (int side = 0; side < 2; ++side) {
    const Vec3& p = pair[side].p;
    const auto foremost =
        foremost_place(f, {p.y() - near, p.y() + near}, chest_half(f, side), 1, PEAKED);
    // a clear bump is believed farther back: a stout trunk leans, and its belly or the middle of
    // its chest is foremost
    const double clear =
        std::clamp(std::min(l.height, r.height) / f.number("bust.bump") - 1, 0.0, 1.0);
    if (foremost && p.z() < foremost->p.z() - (1 + 2 * clear) * f.number("bust.bump_behind") * f.s)
      return false;
  }
  return true;
}

/// Where a nipple can be on one side.
Box3 chest_box(const Finder& f, int side) {
  const double inner = f.number("figure.chest_inner") * f.s;
  const double outer = f.number("figure.chest_outer") * f.s;
  Box3 box;
  box.low = Vec3(side == 0 ? inner : -outer, f.number("figure.chest_low") * f.s, -1);
  box.high = Vec3(side == 0 ? outer : -inner, f.number("figure.chest_high") * f.s, 1);
  return box;
}

/// The strongest relief near a place of the front, its height as of a person of usual stature.
std::optional<ReliefPoint> relief_near(const Finder& f, const Vec3& p, double reach,
                                       double radius) {
  Box3 box;
  box.low = Vec3(p.x() - reach, p.y() - reach, -1);
  box.high = Vec3(p.x() + reach, p.y() + reach, 1);
  auto relief = strongest_relief(f.levels.skin(), box, radius, 1);
  if (relief)
    relief->height *= f.number("figure.usual_stature") / f.s;
  return relief;
}

struct NipplePairs {
  std::optional<BumpPair> taken;
  std::optional<BumpPair> rival; ///< nearly as sharp, elsewhere
};

/// The sharpest pair of bumps that may be nipples, where the strongest one within a wider ring may
/// be too: there a breast's or a belly's curve may stand out farther.
NipplePairs nipple_pairs(const Finder& f, double expected) {
  constexpr std::size_t MOST = 4;    // bumps a side
  constexpr double APART = 0.013;    // of stature, between bumps of a side
  constexpr double ELSEWHERE = 0.02; // of stature
  const double to_usual = f.number("figure.usual_stature") / f.s;
  const double radius = f.number("bust.sharp_radius") * f.s,
               wide = f.number("figure.relief_radius") * f.s, least = f.number("bust.sharp");
  const auto &l = f.figure.nipple[0], &r = f.figure.nipple[1];
  NipplePairs pairs;
  if (!l || !r || !is_nipple_pair(f, {*l, *r}, expected))
    return pairs;
  pairs.taken = {*l, *r};
  std::array<std::vector<ReliefPoint>, 2> bumps;
  for (int side = 0; side < 2; ++side)
    bumps[side] = tallest_reliefs(f.levels.skin(), chest_box(f, side), radius, 1, APART * f.s,
                                  f.number("bust.rival") * least / to_usual, MOST);
  struct Candidate {
    double sharp;
    BumpPair pair;
  };
  std::vector<Candidate> candidates;
  for (const ReliefPoint& left : bumps[0])
    for (const ReliefPoint& right : bumps[1])
      candidates.push_back({to_usual * std::min(left.height, right.height), {left, right}});
  std::stable_sort(candidates.begin(), candidates.end(),
                   [](const Candidate& a, const Candidate& b) { return a.sharp > b.sharp; });
  auto away = [&](const BumpPair& a, const BumpPair& b) {
    return Vec3(a[0].p - b[0].p).head<2>().norm() > ELSEWHERE * f.s;
  };
  std::optional<Candidate> sharpest;
  for (const Candidate& candidate : candidates) {
    if (pairs.rival)
      break;
    if (sharpest && (candidate.sharp < f.number("bust.rival") * sharpest->sharp ||
                     !away(candidate.pair, sharpest->pair)))
      continue;
    if (!sharpest && candidate.sharp < least)
      break;
    BumpPair wider;
    bool is_there = true;
    for (int side = 0; side < 2 && is_there; ++side) {
      const auto relief = relief_near(f, candidate.pair[side].p, wide, wide);
      is_there = relief.has_value();
      if (is_there)
        wider[side] = *relief;
    }
    if (!is_there || !is_nipple_pair(f, wider, expected))
      continue;
    if (sharpest) {
      if (away(wider, *pairs.taken))
        pairs.rival = wider;
      continue;
    }
    sharpest = candidate;
    if (away(wider, *pairs.taken))
      pairs.taken = wider;
  }
  // a skin too coarse for the smaller ring cannot tell
  if (!sharpest && relief_near(f, (*pairs.taken)[0].p, wide, radius) &&
      relief_near(f, (*pairs.taken)[1].p, wide, radius))
    pairs.taken.reset();
  return pairs;
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

/// Puts the chest's foremost place of one side. A belly that runs out before the chest competes
/// with it, and a few millimetres of the chest's lower end decide: the mean over where that may be.
void find_prominence(const Finder& f, int side, const Vec3& bust_point) {
  constexpr double DOUBT = 0.5; // of the confidence
  const Span heights{bust_point.y() - f.number("bust.prominent_below") * f.s,
                     bust_point.y() + f.number("bust.prominent_above") * f.s};
  const auto likely =
      likely_foremost(f, heights, chest_half(f, side), 1, PEAKED, {CHEST_END_SD * f.s, 0, 0});
  const std::string suffix = side_suffix(side), name = "bust_prominent" + suffix;
  if (!f.find("bust_prominent", suffix, 2,
              {{"foremost_of_chest", [&] { return place_of(likely); }}}))
    return;
  Landmark& landmark = f.body.landmarks[name];
  landmark.spread_m = std::max(landmark.spread_m, likely->spread_m);
  char text[160];
  std::snprintf(text, sizeof text, "%s: between %.3f and %.3f m, %.0f mm (standard deviation)",
                name.c_str(), likely->low, likely->high, 1000 * likely->spread_m);
  f.explain(text);
  if (likely->spread_m < PROMINENCE_UNSURE * f.s)
    return;
  for (const double y : {likely->low, likely->high})
    if (const auto p = front_at(f, landmark.p.x(), y, FRONT_HALF_WIDTH * f.s))
      f.also(name, *p);
  landmark.confidence *= DOUBT;
  f.body.scan.findings.push_back(
      {"scan.landmark-unlikely"_id, "warning",
       "belly and chest stand out as far: the chest's foremost place is unsure", name});
}

/// Warns of a bust that hangs below where its rules look: below the bust point the chest stands out
/// clearly farther, and falls back again. Of 137 women among 268 fresh bodies it was one, whose
/// bust was 83 mm lower; bellies stand out at the end of the heights.
void doubt_hanging_bust(const Finder& f, int side) {
  constexpr double DEEPEST = 0.09, BELLY = 0.078, LOWER = 0.02, BEFORE = 0.015; // of stature
  constexpr double DOUBT = 0.5;                                                 // of the confidence
  const std::string name = std::string("bust_point") + side_suffix(side);
  const Vec3 point = f.at(name);
  const Span across = half_front(side, f.number("bust.inner") * f.s, f.number("bust.outer") * f.s);
  const auto hanging =
      foremost_place(f, {point.y() - DEEPEST * f.s, point.y()}, across, 1, PEAKED, 0);
  if (!hanging)
    return;
  const Vec3 off = (hanging->p - point) / f.s;
  if (off.y() < -BELLY || off.y() > -LOWER || off.z() < BEFORE)
    return;
  f.also(name, hanging->p);
  f.body.landmarks[name].confidence *= DOUBT;
  char text[120];
  std::snprintf(text, sizeof text, "the bust may hang: the chest is foremost %.0f mm lower",
                -1000 * f.s * off.y());
  f.body.scan.findings.push_back({"scan.landmark-unlikely"_id, "warning", text, name});
}

/// Warns of another bump that may be the nipple.
void doubt_nipple(const Finder& f, int side, const Vec3& rival) {
  constexpr double DOUBT = 0.5; // of the confidence
  const std::string name = std::string("bust_point") + side_suffix(side);
  f.also(name, rival);
  f.body.landmarks[name].confidence *= DOUBT;
  char text[120];
  std::snprintf(text, sizeof text, "a bump %.0f mm from it stands out as sharply: look at it",
                1000 * Vec3(rival - f.at(name)).head<2>().norm());
  f.body.scan.findings.push_back({"scan.landmark-unlikely"_id, "warning", text, name});
}

} // namespace

void find_bust(const Finder& f, double pit) {
  const double s = f.s, crotch = f.at("crotch").y(), trunk = f.at("neck_back").y() - crotch;
  const double by_trunk = crotch + f.number("bust.of_trunk") * trunk,
               by_pit = pit - f.number("bust.below_pit") * s;
  const double expected =
      f.by_population("bust_point", pit > 0 ? 0.5 * (by_trunk + by_pit) : by_trunk);
  using Found = std::optional<BothSides>;
  NipplePairs nipples;
  const auto points = f.choose<BothSides>(
      "bust_point", "bust_point",
      {{"bump_of_chest",
        [&]() -> Found {
          nipples = nipple_pairs(f, expected);
          if (!nipples.taken)
            return std::nullopt;
          BothSides both;
          for (int side = 0; side < 2; ++side) {
            const Vec3& p = (*nipples.taken)[side].p;
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
    find_prominence(f, side, *point);
    if (const auto p = front_at(f, (side == 0 ? 1 : -1) * f.number("bust.beside") * s, expected,
                                FRONT_HALF_WIDTH * s))
      f.also("bust_point" + suffix, *p);
    if (is_seen && nipples.rival)
      doubt_nipple(f, side, (*nipples.rival)[side].p);
    sum += point->y();
    ++n;
  }
  for (int side = 0; side < 2; ++side)
    if (points->value[side] && f.figure.female > 0.5 && points->rule->name != "bump_of_chest")
      doubt_hanging_bust(f, side);
  if (n == 2)
    put_level(f, "bust", sum / 2, points->rule->name);
}

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

} // namespace sloper::body
