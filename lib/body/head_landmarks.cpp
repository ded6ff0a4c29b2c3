#include <body/landmark_finder.hpp>

#include <algorithm>
#include <cmath>
#include <optional>

namespace sloper::body {

std::optional<Profile> midline(const LevelStack& levels, double y, double x, double half_width) {
  const auto loop = levels.trunk_at(y);
  if (!loop) return std::nullopt;
  Profile profile{-1e300, 1e300};
  const Vec2 up = Vec2::UnitY();
  for (const auto& segment : loop->segments)
    for (const Vec2& q : segment)
      if (std::abs(q.x() - x) <= half_width) {
        profile.front = std::max(profile.front, up.dot(q));
        profile.back = std::min(profile.back, up.dot(q));
      }
  if (profile.front < profile.back) return std::nullopt;
  return profile;
}

namespace {

/// The hollow of the throat: where the neck's front lies deepest between chin and chest.
std::optional<double> hollow_of_throat(const Finder& f, double x) {
  std::optional<double> best;
  double deepest = 1e300;
  const double low = f.number("neck_front.search_low") * f.s, high = f.number("neck_front.search_high") * f.s;
  for (double y = low; y <= high; y += 0.002 * f.s)
    if (const auto m = midline(f.levels, y, x, 0.006 * f.s); m && m->front < deepest) deepest = m->front, best = y;
  if (best && (*best < low + 0.003 * f.s || *best > high - 0.003 * f.s)) return std::nullopt;
  return best;
}

/// Where the neck turns into the shoulders: coming down, the outline widens faster than it falls.
std::optional<double> shoulder_turn(const Finder& f) {
  const double s = f.s, step = 0.002 * s;
  for (double y = 0.885 * s; y > 0.80 * s; y -= step) {
    const auto above = f.levels.trunk_at(y + 1.5 * step), below = f.levels.trunk_at(y - 1.5 * step);
    if (!above || !below) continue;
    const double widening = 0.5 * (below->size().x() - above->size().x()) / (3 * step);
    if (widening > f.number("neck_side.widening") && below->size().x() > 0.07 * s) return y;
  }
  return std::nullopt;
}

/// x of the middle of the neck.
double neck_middle(const Finder& f) {
  double sum = 0;
  int n = 0;
  for (double y = 0.855 * f.s; y < 0.875 * f.s; y += 0.005 * f.s)
    if (const auto loop = f.levels.trunk_at(y); loop && loop->size().x() < 0.12 * f.s) sum += loop->center().x(), ++n;
  return n ? sum / n : 0.0;
}

} // namespace

void find_head_landmarks(const Finder& f) {
  const double s = f.s;
  const TriangleMesh& skin = f.levels.skin();
  int top = -1;
  for (std::size_t v = 0; v < skin.positions.size(); ++v)
    if (top < 0 || skin.positions[v].y() > skin.positions[top].y()) top = static_cast<int>(v);
  if (top >= 0) f.put("head_tip", skin.positions[top], 1, "highest_point", 0.95, 0.002);
  // heights: the population's ratio, drawn towards what this neck shows
  const double x = neck_middle(f);
  double front_y = f.number("neck_front.height") * s;
  std::string front_rule = "height_ratio", back_rule = "height_ratio";
  const auto hollow = hollow_of_throat(f, x);
  if (hollow) {
    const double w = f.number("neck_front.hollow_weight");
    front_y = (1 - w) * front_y + w * (*hollow - f.number("neck_front.below_hollow") * s);
    front_rule = "hollow_of_throat";
  }
  double cues = f.number("neck_back.height") * s, n_cues = 1;
  if (hollow) cues += front_y + f.number("neck_back.above_front") * s, ++n_cues, back_rule = "above_throat";
  const auto turn = shoulder_turn(f);
  if (turn) cues += *turn - f.number("neck_side.above_back") * s, ++n_cues, back_rule = "neck_meets_shoulders";
  const double back_y = cues / n_cues;
  double side_y = back_y + f.number("neck_side.above_back") * s;
  if (turn) side_y = 0.5 * (side_y + *turn);
  const auto back = midline(f.levels, back_y, x, 0.008 * s), front = midline(f.levels, front_y, x, 0.006 * s);
  if (!back || !front) {
    f.explain("neck: no section at the neck's height");
    return;
  }
  const double confidence = 0.4 + 0.1 * n_cues;
  f.put("neck_back", Vec3(x, back_y, back->back), 2, back_rule, confidence, 0.010);
  f.put("neck_front", Vec3(x, front_y, front->front), 2, front_rule, confidence, 0.010);
  auto also = [&](const char* name, double y, bool in_front) {
    if (const auto m = midline(f.levels, y, x, 0.008 * s)) f.also(name, Vec3(x, y, in_front ? m->front : m->back));
  };
  also("neck_front", f.number("neck_front.height") * s, true);
  if (hollow) also("neck_front", *hollow - f.number("neck_front.below_hollow") * s, true);
  also("neck_back", f.number("neck_back.height") * s, false);
  if (hollow) also("neck_back", front_y + f.number("neck_back.above_front") * s, false);
  if (turn) also("neck_back", *turn - f.number("neck_side.above_back") * s, false);
  const double depth = back->back + f.number("neck_side.from_back") * (front->front - back->back);
  auto outer_at = [&](double y, int side, double near) {
    const double sign = side == 0 ? 1 : -1;
    std::optional<Vec2> outer;
    if (const auto loop = f.levels.trunk_at(y))
      for (const auto& seg : loop->segments)
        if (std::abs(seg[0].y() - depth) < near * s && sign * (seg[0].x() - x) > 0 && (!outer || sign * seg[0].x() > sign * outer->x())) outer = seg[0];
    return outer;
  };
  // where the shoulders are nearly level a millimetre of height is a centimetre of breadth: too broad is too low
  const double broadest = f.number("neck_side.broadest") * s, limit = side_y + 0.012 * s;
  for (; side_y < limit; side_y += 0.001 * s) {
    const auto l = outer_at(side_y, 0, 0.01), r = outer_at(side_y, 1, 0.01);
    if (l && r && 0.5 * (l->x() - r->x()) < broadest) break;
  }
  for (int side = 0; side < 2; ++side)
    if (const auto close = outer_at(side_y, side, 0.01), outer = close ? close : outer_at(side_y, side, 0.03); outer)
      f.put(std::string("neck_side") + side_suffix(side), Vec3(outer->x(), side_y, depth), 2, turn ? "neck_meets_shoulders" : "above_neck_back", 0.5, 0.012);
  f.put("neck_center", Vec3(x, 0.5 * (back_y + front_y), 0.5 * (back->back + front->front)), 2, "middle_of_neck_ring", 0.6, 0.010);
}

} // namespace sloper::body
