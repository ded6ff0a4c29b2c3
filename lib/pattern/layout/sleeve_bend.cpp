#include <pattern/layout/sleeve_bend.hpp>
#include <sloper/base/units.hpp>

#include <algorithm>
#include <cmath>

namespace sloper::pattern {

namespace {

constexpr double SLEEVE_ROW = 0.01; // m between the heights at which the cloth's reach is looked at
constexpr double SLEEVE_LEAST = 0.1;     // m, beyond the trunk and beyond the shoulder
constexpr double SLEEVE_END = 0.04;      // m: of its length, to tell where it leads
constexpr double BELOW_SHOULDER = 0.45;  // m: lower than this no sleeve leaves the trunk
constexpr double FADE = 0.25;            // m below the crook, in which the trunk is left as it is
const double STIFF = units::radians(15); // about the sleeve's axis: turned as a whole
const double LOW_END = -units::radians(100),
             HIGH_END = units::radians(110); // from the axis: beyond, nothing turns
const double MOST_BEND = units::radians(75);

/// Largest sign * x of closed outlines at a height; -1 where they are not.
double reach_at(const std::vector<std::vector<Vec2>>& outlines, double sign, double height) {
  double most = -1;
  for (const auto& loop : outlines)
    for (std::size_t k = 0; k < loop.size(); ++k) {
      const Vec2 &a = loop[k], &b = loop[(k + 1) % loop.size()];
      if ((a.y() <= height) == (b.y() <= height))
        continue;
      most = std::max(most, sign * (a.x() + (height - a.y()) / (b.y() - a.y()) * (b.x() - a.x())));
    }
  return most;
}

} // namespace

std::optional<SleeveBend> SleeveBend::find(const std::vector<std::vector<Vec2>>& outlines,
                                           double sign, const Vec2& shoulder, double elevation) {
  double low = 1e300, high = -1e300, tip = -1e300;
  for (const auto& loop : outlines)
    for (const Vec2& p : loop) {
      low = std::min(low, p.y());
      high = std::max(high, p.y());
    }
  low = std::max(low, shoulder.y() - BELOW_SHOULDER);
  double trunk = 1e300, crook = low;
  for (double y = low + 0.5 * SLEEVE_ROW; y < high; y += SLEEVE_ROW) {
    const double reach = reach_at(outlines, sign, y);
    if (reach <= 0)
      continue;
    if (y < shoulder.y() && reach < trunk + SLEEVE_ROW) {
      trunk = std::min(trunk, reach);
      crook = y;
    }
  }
  for (double y = crook; y < high; y += SLEEVE_ROW)
    tip = std::max(tip, reach_at(outlines, sign, y)); // flares are below
  if (!(tip > std::max(trunk, sign * shoulder.x()) + SLEEVE_LEAST))
    return std::nullopt;
  Vec2 end = Vec2::Zero();
  double n = 0;
  for (const auto& loop : outlines)
    for (const Vec2& p : loop)
      if (sign * p.x() > tip - SLEEVE_END && p.y() > crook) {
        end += p;
        ++n;
      }
  if (n == 0)
    return std::nullopt;
  end /= n;
  SleeveBend bend;
  bend.m_sign = sign;
  bend.m_shoulder = shoulder;
  bend.m_crook = crook;
  bend.m_axis = std::atan2(end.y() - shoulder.y(), sign * (end.x() - shoulder.x()));
  bend.m_angle = std::clamp(elevation - bend.m_axis, -MOST_BEND, MOST_BEND);
  return bend;
}

Vec2 SleeveBend::at(const Vec2& p) const {
  const Vec2 q(m_sign * (p.x() - m_shoulder.x()), p.y() - m_shoulder.y());
  const double r = q.norm();
  if (r < 1e-9)
    return p;
  double from_axis = std::atan2(q.y(), q.x()) - m_axis;
  if (from_axis > units::PI)
    from_axis -= 2 * units::PI;
  if (from_axis < -units::PI)
    from_axis += 2 * units::PI;
  double share = 0; // of the angle: whole near the axis, falling to both ends, so that the order of
                    // angles is kept
  if (std::abs(from_axis) <= STIFF)
    share = 1;
  else if (from_axis < 0)
    share = std::max(0.0, (from_axis - LOW_END) / (-STIFF - LOW_END));
  else
    share = std::max(0.0, (HIGH_END - from_axis) / (HIGH_END - STIFF));
  const double below = std::clamp((m_crook - p.y()) / FADE, 0.0, 1.0);
  const double turn = m_angle * share * (1 - below * below * (3 - 2 * below));
  return {m_shoulder.x() + m_sign * (std::cos(turn) * q.x() - std::sin(turn) * q.y()),
          m_shoulder.y() + std::sin(turn) * q.x() + std::cos(turn) * q.y()};
}

} // namespace sloper::pattern
