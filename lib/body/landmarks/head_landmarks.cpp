#include <body/landmarks/landmark_finder.hpp>
#include <body/measure/plateau.hpp>

#include <algorithm>
#include <cmath>
#include <optional>

namespace sloper::body {

std::optional<Profile> midline(const LevelStack& levels, double y, double x, double half_width) {
  const auto& loop = levels.trunk_at(y);
  if (!loop)
    return std::nullopt;
  Profile profile{-1e300, 1e300};
  for (const auto& segment : loop->segments)
    if (const auto piece = clipped(segment, 0, x - half_width, x + half_width))
      for (const Vec2& q : *piece) {
        profile.front = std::max(profile.front, q.y());
        profile.back = std::min(profile.back, q.y());
      }
  if (profile.front < profile.back)
    return std::nullopt;
  return profile;
}

namespace {

// Levels and windows in which the skin is read, of stature where the name says no unit.
constexpr double THROAT_HALF_WIDTH = 0.006; // over which the throat is read
constexpr double NAPE_HALF_WIDTH = 0.008;   // over which the nape is read
constexpr double THROAT_STEP = 0.001;       // between levels of the throat
constexpr double THROAT_MARGIN = 0.003;     // a hollow nearer to the end of its search is a slope
constexpr double TURN_STEP = 0.002;         // between levels in which the neck widens
constexpr double TURN_REACH = 1.5;          // steps to both sides over which widening is read
constexpr double NECK_STEP = 0.005;         // between levels of the neck's middle
constexpr double SIDE_STEP = 0.001;         // by which a side neck point goes up
constexpr double SIDE_DEPTH_NEAR = 0.01;    // in which the neck's side is outermost
constexpr double SIDE_DEPTH_FAR = 0.03;     // the same where that slice has no skin

/// The hollow of the throat: where the neck's front lies deepest between chin and chest.
std::optional<double> hollow_of_throat(const Finder& f, double x) {
  constexpr double AS_DEEP = 0.0008; // m
  const double low = f.number("neck_front.search_low") * f.s,
               high = f.number("neck_front.search_high") * f.s;
  std::vector<Vec2> fronts; // height, depth
  for (double y = low; y <= high; y += THROAT_STEP * f.s)
    if (const auto m = midline(f.levels, y, x, THROAT_HALF_WIDTH * f.s))
      fronts.emplace_back(y, m->front);
  if (fronts.empty())
    return std::nullopt;
  const Lowest deepest = lowest_of(fronts, AS_DEEP);
  if (deepest.least < low + THROAT_MARGIN * f.s || deepest.least > high - THROAT_MARGIN * f.s)
    return std::nullopt;
  return deepest.middle;
}

/// Where the neck turns into the shoulders: coming down, the outline widens faster than it falls.
std::optional<double> shoulder_turn(const Finder& f) {
  const double s = f.s, step = TURN_STEP * s;
  const double low = f.number("neck_side.turn_low") * s;
  const double least_breadth = f.number("neck_side.turn_breadth") * s;
  for (double y = f.number("neck_side.turn_high") * s; y > low; y -= step) {
    const auto &above = f.levels.trunk_at(y + TURN_REACH * step),
               &below = f.levels.trunk_at(y - TURN_REACH * step);
    if (!above || !below)
      continue;
    const double widening = 0.5 * (below->size().x() - above->size().x()) / (3 * step);
    if (widening > f.number("neck_side.widening") && below->size().x() > least_breadth)
      return y;
  }
  return std::nullopt;
}

/// x of the middle of the neck: where necks usually are, and of raised shoulders where they first
/// leave the neck free above that.
double neck_middle(const Finder& f) {
  double sum = 0;
  int n = 0;
  const double usual = f.number("neck.middle_high"), highest = f.number("neck.middle_highest");
  const double broadest = f.number("neck.middle_breadth") * f.s;
  for (double y = f.number("neck.middle_low") * f.s; y < (n ? usual : highest) * f.s;
       y += NECK_STEP * f.s)
    if (const auto& loop = f.levels.trunk_at(y); loop && loop->size().x() < broadest) {
      sum += loop->center().x();
      ++n;
    }
  return n ? sum / n : 0.0;
}

/// The highest skin: of a flat crown the middle of what is as high as makes no difference, at the
/// height of the highest point.
std::optional<Vec3> top_of_head(const TriangleMesh& skin) {
  constexpr double AS_HIGH = 0.0015; // m
  constexpr int PIECES = 6;          // a face of a coarse mesh is larger than the flat part
  double top = -1e300;
  for (const Vec3& p : skin.positions)
    top = std::max(top, p.y());
  if (top < -1e299)
    return std::nullopt;
  Vec3 sum = Vec3::Zero();
  double weight = 0;
  for (const Triangle& t : skin.triangles) {
    const Vec3 &a = skin.positions[t[0]], &b = skin.positions[t[1]], &c = skin.positions[t[2]];
    if (std::max({a.y(), b.y(), c.y()}) < top - AS_HIGH)
      continue;
    const double area = area_normal(a, b, c).norm();
    for (int i = 0; i < PIECES; ++i)
      for (int j = 0; j + i < PIECES; ++j) {
        const double u = (i + 1.0 / 3) / PIECES, v = (j + 1.0 / 3) / PIECES;
        const Vec3 p = a + u * (b - a) + v * (c - a);
        if (const double w = (p.y() - top + AS_HIGH) * area; w > 0) {
          sum += w * p;
          weight += w;
        }
      }
  }
  if (weight <= 0)
    return *std::max_element(skin.positions.begin(), skin.positions.end(),
                             [](const Vec3& a, const Vec3& b) { return a.y() < b.y(); });
  return Vec3(sum.x() / weight, top, sum.z() / weight);
}

/// Both side neck points: skin at that depth, at the height where neck and shoulder meet.
void find_neck_sides(const Finder& f, double x, double back_y, const std::optional<double>& turn,
                     double depth) {
  const double s = f.s, above_back = back_y + f.number("neck_side.above_back") * s;
  const auto height =
      f.choose<double>("neck_side", "neck_side",
                       {{"neck_meets_shoulders",
                         [&]() -> std::optional<double> {
                           if (!turn)
                             return std::nullopt;
                           return 0.5 * (above_back + *turn);
                         }},
                        {"above_neck_back", [&] { return std::optional(above_back); }}});
  if (!height)
    return;
  double side_y = height->value;
  auto outer_at = [&](double y, int side, double near) {
    const double sign = side == 0 ? 1 : -1;
    std::optional<Vec2> outer;
    if (const auto& loop = f.levels.trunk_at(y))
      for (const auto& seg : loop->segments)
        if (const auto piece = clipped(seg, 1, depth - near * s, depth + near * s))
          for (const Vec2& q : *piece)
            if (sign * (q.x() - x) > 0 && (!outer || sign * q.x() > sign * outer->x()))
              outer = q;
    return outer;
  };
  // where the shoulders are nearly level a millimetre of height is a centimetre of breadth: too
  // broad is too low
  const double broadest = f.number("neck_side.broadest") * s,
               limit = side_y + f.number("neck_side.most_up") * s;
  for (; side_y < limit; side_y += SIDE_STEP * s) {
    const auto l = outer_at(side_y, 0, SIDE_DEPTH_NEAR), r = outer_at(side_y, 1, SIDE_DEPTH_NEAR);
    if (l && r && 0.5 * (l->x() - r->x()) < broadest)
      break;
  }
  for (int side = 0; side < 2; ++side)
    if (const auto close = outer_at(side_y, side, SIDE_DEPTH_NEAR),
        outer = close ? close : outer_at(side_y, side, SIDE_DEPTH_FAR);
        outer)
      f.put(std::string("neck_side") + side_suffix(side),
            f.corrected("neck_side", side_suffix(side), Vec3(outer->x(), side_y, depth), true), 2,
            *height->rule);
}

} // namespace

void find_head_landmarks(const Finder& f) {
  const double s = f.s;
  const TriangleMesh& skin = f.levels.skin();
  f.find("head_tip", "", 1,
         {{"highest_point", [&]() -> std::optional<Vec3> { return top_of_head(skin); }}});
  // heights: the population's ratio, drawn towards what this neck shows
  using Height = std::optional<double>;
  const double x = neck_middle(f);
  const auto hollow = hollow_of_throat(f, x), turn = shoulder_turn(f);
  const double front_ratio = f.number("neck_front.height") * s,
               back_ratio = f.number("neck_back.height") * s;
  const auto front_y = f.choose<double>(
      "neck_front", "neck_front",
      {{"hollow_of_throat",
        [&]() -> Height {
          if (!hollow)
            return std::nullopt;
          const double w = f.number("neck_front.hollow_weight");
          return (1 - w) * front_ratio + w * (*hollow - f.number("neck_front.below_hollow") * s);
        }},
       {"height_ratio", [&] { return Height(front_ratio); }}});
  if (!front_y)
    return;
  const double front_at =
      f.more_likely("neck_front", front_y->value + f.correction("neck_front").y());
  const Height by_throat =
      hollow ? Height(front_y->value + f.number("neck_back.above_front") * s) : std::nullopt;
  const Height by_turn = turn ? Height(*turn - f.number("neck_side.above_back") * s) : std::nullopt;
  const auto back_y = f.choose<double>("neck_back", "neck_back",
                                       {{"neck_meets_shoulders",
                                         [&]() -> Height {
                                           if (!by_turn)
                                             return std::nullopt;
                                           return by_throat
                                                      ? (back_ratio + *by_throat + *by_turn) / 3
                                                      : 0.5 * (back_ratio + *by_turn);
                                         }},
                                        {"above_throat",
                                         [&]() -> Height {
                                           if (!by_throat)
                                             return std::nullopt;
                                           return 0.5 * (back_ratio + *by_throat);
                                         }},
                                        {"height_ratio", [&] { return Height(back_ratio); }}});
  if (!back_y)
    return;
  const double back_by_rule = back_y->value + f.correction("neck_back").y();
  const double back_at = f.more_likely("neck_back", back_by_rule);
  const auto back = midline(f.levels, back_at, x, NAPE_HALF_WIDTH * s),
             front = midline(f.levels, front_at, x, THROAT_HALF_WIDTH * s);
  if (!back || !front) {
    f.explain("neck: no section at the neck's height");
    return;
  }
  f.put("neck_back", Vec3(x, back_at, back->back), 2, *back_y->rule);
  f.put("neck_front", Vec3(x, front_at, front->front), 2, *front_y->rule);
  auto also = [&](const char* name, double y, bool in_front) {
    if (const auto m = midline(f.levels, y, x, NAPE_HALF_WIDTH * s))
      f.also(name, Vec3(x, y, in_front ? m->front : m->back));
  };
  also("neck_front", front_ratio, true);
  if (hollow)
    also("neck_front", *hollow - f.number("neck_front.below_hollow") * s, true);
  also("neck_back", back_ratio, false);
  if (by_throat)
    also("neck_back", *by_throat, false);
  if (by_turn)
    also("neck_back", *by_turn, false);
  find_neck_sides(f, x, back_by_rule, turn,
                  back->back + f.number("neck_side.from_back") * (front->front - back->back));
  const Vec3 center(x, 0.5 * (back_at + front_at), 0.5 * (back->back + front->front));
  f.find("neck_center", "", 2, {{"middle_of_neck_ring", [&] { return std::optional(center); }}});
}

} // namespace sloper::body
