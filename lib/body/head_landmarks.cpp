#include <body/landmark_finder.hpp>

#include <algorithm>
#include <cmath>

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

void find_head_landmarks(const Finder& f) {
  const double s = f.s;
  const TriangleMesh& skin = f.levels.skin();
  int top = -1;
  for (std::size_t v = 0; v < skin.positions.size(); ++v)
    if (top < 0 || skin.positions[v].y() > skin.positions[top].y()) top = static_cast<int>(v);
  if (top >= 0) f.put("head_tip", skin.positions[top], 1, "highest_point", 0.95, 0.002);
  const double back_y = f.number("neck_back.height") * s, front_y = f.number("neck_front.height") * s;
  const auto back = midline(f.levels, back_y, 0, 0.015 * s), front = midline(f.levels, front_y, 0, 0.01 * s);
  if (!back || !front) return;
  f.put("neck_back", Vec3(0, back_y, back->back), 2, "height_ratio", 0.5, 0.012);
  f.put("neck_front", Vec3(0, front_y, front->front), 2, "height_ratio", 0.5, 0.012);
  // neck side: on the skin, in the plane through neck_back and neck_front, where the shoulder line starts
  const double neck_y = 0.5 * (back_y + front_y);
  for (int side = 0; side < 2; ++side) {
    const auto loop = f.levels.trunk_at(back_y + 0.004 * s);
    if (!loop) continue;
    Vec2 outer = loop->segments.front()[0];
    const double sign = side == 0 ? 1 : -1, depth = back->back + 0.35 * (front->front - back->back);
    double best = -1e300;
    for (const auto& seg : loop->segments)
      if (std::abs(seg[0].y() - depth) < 0.01 * s && sign * seg[0].x() > best) best = sign * seg[0].x(), outer = seg[0];
    f.put(std::string("neck_side") + side_suffix(side), Vec3(outer.x(), back_y + 0.004 * s, outer.y()), 2, "neck_outline", 0.5, 0.012);
  }
  f.put("neck_center", Vec3(0, neck_y, 0.5 * (back->back + front->front)), 2, "middle_of_neck_ring", 0.6, 0.01);
}

} // namespace sloper::body
