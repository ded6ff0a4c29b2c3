#include <pattern/surfaces/leg_tube.hpp>
#include <sloper/base/error.hpp>
#include <sloper/base/units.hpp>

#include <algorithm>
#include <cmath>

namespace sloper::pattern {
namespace {

using body::Part;

constexpr double BIN = 0.01;           // m of height
constexpr double MIDDLE_CLEAR = 0.006; // m from the plane between the legs
constexpr double SKIN_CLEAR = 0.006;   // m: least distance from the skin
constexpr double INTO_LEGS =
    0.15; // m below the crotch over which the hips' curve turns into the leg's

} // namespace

LegTube::LegTube(const BodySpace& space, bool left) : m_left(left) {
  const body::Body& body = space.body();
  m_crotch = body.has_landmark("crotch") ? body.landmark("crotch").y() : 0.47 * space.stature();
  m_low = -0.02;
  const std::size_t n = static_cast<std::size_t>(std::ceil((space.stature() - m_low) / BIN)) + 2;
  m_skin.assign(n, empty_ring());
  m_trunk = m_skin;
  m_arms.resize(n);
  std::vector<std::array<double, 2>> inner(
      n, {1e300, 1e300}); // of the left and the right leg, each outwards
  bool any = false;
  for (std::size_t v = 0; v < body.skin.positions.size(); ++v) {
    const Part part = space.parts()[v];
    const Vec3& p = body.skin.positions[v];
    const Vec2 q(left ? p.x() : -p.x(), p.z());
    if (p.y() < m_low)
      continue;
    const std::size_t k = bin(p.y());
    const bool own = part == (left ? Part::LEG_L : Part::LEG_R),
               leg = own || part == Part::LEG_L || part == Part::LEG_R;
    if (part == Part::ARM_L || part == Part::ARM_R)
      m_arms[k].push_back(q);
    if (!leg && part != Part::TORSO)
      continue;
    for (int d = 0; d < RING_ANGLES; ++d) {
      const double h = q.dot(direction(d));
      m_trunk[k][d] = std::max(m_trunk[k][d], h);
      if (own)
        m_skin[k][d] = std::max(m_skin[k][d], h);
    }
    if (leg) {
      any = any || own;
      inner[k][own ? 0 : 1] = std::min(inner[k][own ? 0 : 1], own ? q.x() : -q.x());
    }
  }
  if (!any)
    throw input_error("placement.limb-not-scanned"_id, "", "body",
                      std::string("the ") + (left ? "left" : "right") + " leg has no skin",
                      "scan the legs, or leave the trousers out");
  // The plane between the legs: the mean over heights where both are there, below the crotch.
  double sum = 0;
  int count = 0;
  for (std::size_t k = 0; k < n; ++k)
    if (inner[k][0] < 1e299 && inner[k][1] < 1e299 &&
        m_low + BIN * static_cast<double>(k) < m_crotch - 0.02) {
      sum += 0.5 * (inner[k][0] - inner[k][1]);
      ++count;
    }
  m_middle = count ? sum / count : 0;

  m_skin = joined(filled(m_skin), 2);
  m_trunk = smooth(joined(filled(m_trunk), 2), 2);
  m_leg = smooth(m_skin, 2);
  for (std::size_t k = 0; k < n; ++k) {
    const double y = m_low + BIN * static_cast<double>(k),
                 t = std::clamp((y - (m_crotch - INTO_LEGS)) / INTO_LEGS, 0.0, 1.0),
                 w = t * t * (3 - 2 * t);
    for (std::size_t d = 0; d < RING_ANGLES; ++d)
      m_leg[k][d] += w * std::max(m_trunk[k][d] - m_leg[k][d], 0.0);
    const auto extent = [&](const Ring& h, int d) { return h[d]; };
    const double high = extent(m_leg[k], RING_ANGLES / 4),
                 low = std::max(-extent(m_leg[k], 3 * RING_ANGLES / 4), m_middle);
    m_center.push_back(
        Vec2(0.5 * (low + high), 0.5 * (extent(m_leg[k], 0) - extent(m_leg[k], RING_ANGLES / 2))));
  }
  m_center = averaged(m_center, 4);
}

std::size_t LegTube::bin(double y) const {
  return static_cast<std::size_t>(
      std::clamp(std::lround((y - m_low) / BIN), 0L, static_cast<long>(m_skin.size()) - 1));
}

/// Radii of a row that is grown by so much, and the curve over what of it may be used: `from` and
/// `to` are directions, in steps.
void LegTube::outline(Curve& curve, double grown) const {
  // Between two bins, so that steps of height do not show.
  const double x =
      std::clamp((curve.y - m_low) / BIN, 0.0, static_cast<double>(m_leg.size()) - 1.001);
  const std::size_t k = static_cast<std::size_t>(x);
  const double f = x - static_cast<double>(k);
  Ring support;
  for (std::size_t d = 0; d < RING_ANGLES; ++d)
    support[d] = (1 - f) * m_leg[k][d] + f * m_leg[k + 1][d];
  curve.center = (1 - f) * m_center[k] + f * m_center[k + 1];
  curve.radius = radii(support, curve.center, grown);
  const Ring skin = radii(support, curve.center, SKIN_CLEAR);
  for (const std::size_t row : {k, k + 1}) // hands beside the hips are not to be passed through
    for (const Vec2& p : m_arms[row]) {
      const Vec2 q = p - curve.center;
      const int at =
          static_cast<int>(std::lround(std::atan2(q.x(), q.y()) / (2 * units::PI) * RING_ANGLES));
      for (int o = -3; o <= 3; ++o) {
        const std::size_t d = static_cast<std::size_t>((at + o + 2 * RING_ANGLES) % RING_ANGLES);
        curve.radius[d] = std::max(std::min(curve.radius[d], q.norm() - 0.01),
                                   std::min(skin[d], curve.radius[d]));
      }
    }
  const double side = curve.center.x() - m_middle - MIDDLE_CLEAR;
  for (int d = 0; d < RING_ANGLES; ++d) {
    const double across = -direction(d).x();
    if (across > 1e-6)
      curve.radius[d] = std::min(curve.radius[d], side / across);
  }
}

void LegTube::shape(const std::vector<double>& heights, const std::vector<LegRow>& rows,
                    double gap) {
  const std::size_t n = heights.size();
  m_curves.assign(n, Curve{});
  std::vector<double> front_reach(n), back_reach(n), grown(n, gap);
  for (std::size_t j = 0; j < n; ++j) {
    Curve& c = m_curves[j];
    c.y = heights[j];
    c.cloth = rows[j];
    outline(c, gap);
    // How far the row may go around inwards: to the plane between the legs where there is no room
    // between them, else up to a skin that is too near that plane.
    const Ring skin = radii(m_skin[bin(c.y)], c.center, SKIN_CLEAR);
    for (const bool back : {false, true}) {
      int reach = 0;
      for (; reach < RING_ANGLES / 4; ++reach) {
        const std::size_t d = static_cast<std::size_t>(
            ((back ? RING_ANGLES / 2 + reach + 1 : -reach - 1) + RING_ANGLES) % RING_ANGLES);
        const bool clipped = c.radius[d] * -direction(static_cast<int>(d)).x() >
                             c.center.x() - m_middle - MIDDLE_CLEAR - 1e-9;
        if (clipped && (c.y > m_crotch - 0.01 || c.radius[d] < skin[d]))
          break;
      }
      (back ? back_reach : front_reach)[j] = std::max(reach - 0.5, 0.0);
    }
  }
  front_reach = averaged(least(front_reach, 3), 8);
  back_reach = averaged(least(back_reach, 3), 8);
  const auto trace = [&](std::size_t j) {
    Curve& c = m_curves[j];
    outline(c, grown[j]);
    c.points.clear();
    c.s.clear();
    const double from = -front_reach[j], to = 0.5 * RING_ANGLES + back_reach[j];
    const int steps = 160;
    for (int k = 0; k <= steps; ++k) {
      const double x = from + (to - from) * k / steps, whole = std::floor(x), f = x - whole;
      const std::size_t a = static_cast<std::size_t>((static_cast<int>(whole) + RING_ANGLES) %
                                                     RING_ANGLES),
                        b = (a + 1) % RING_ANGLES;
      const double angle = 2 * units::PI * x / RING_ANGLES;
      c.points.push_back(c.center + ((1 - f) * c.radius[a] + f * c.radius[b]) *
                                        Vec2(std::sin(angle), std::cos(angle)));
      c.s.push_back(
          k ? c.s.back() + (c.points[k] - c.points[static_cast<std::size_t>(k) - 1]).norm() : 0);
    }
  };
  const auto wanted = [&](std::size_t j) {
    return std::max(rows[j].front.width() + rows[j].back.width(), rows[j].ring.width()) + PANEL_GAP;
  };
  for (std::size_t j = 0; j < n; ++j)
    for (int round = 0; round < 6; ++round) {
      trace(j);
      const double missing = wanted(j) - m_curves[j].s.back();
      if (missing < 1e-3)
        break;
      grown[j] = std::min(grown[j] + missing / units::PI, 0.5);
    }
  std::vector<double> most = grown;
  for (double& g : most)
    g = -g;
  most = least(most, 4);
  for (double& g : most)
    g = -g;
  grown = averaged(most, 8);
  for (std::size_t j = 0; j < n; ++j) {
    trace(j);
    Curve& c = m_curves[j];
    const double length = c.s.back(), cloth = wanted(j) - PANEL_GAP;
    c.scale = cloth > 0 ? std::min(1.0, (length - PANEL_GAP) / cloth) : 1;
    const double open = std::max(length - PANEL_GAP - c.scale * cloth, 0.0);
    const double share = 0.25 * std::clamp((m_crotch - c.y) / INTO_LEGS, 0.0,
                                           1.0); // the middle seams of the hips stay in the middle
    c.inner_gap = share * open;
    c.outer_gap = PANEL_GAP + (1 - 2 * share) * open;
    c.seam = c.inner_gap + c.scale * rows[j].front.width() + 0.5 * c.outer_gap;
  }
}

Vec3 LegTube::on(const Curve& c, Side side, double t, double out) const {
  double s = 0;
  if (side == Side::FRONT)
    s = c.seam - 0.5 * c.outer_gap - c.scale * (c.cloth.front.out - t);
  else if (side == Side::BACK)
    s = c.seam + 0.5 * c.outer_gap + c.scale * (c.cloth.back.out - t);
  else
    s = 0.5 * (c.s.back() - c.scale * c.cloth.ring.width()) + c.scale * (t - c.cloth.ring.in);
  Vec2 p;
  if (s <= 0)
    p = c.points.front() + s * (c.points[1] - c.points[0]).normalized();
  else if (s >= c.s.back())
    p = c.points.back() +
        (s - c.s.back()) * (c.points.back() - c.points[c.points.size() - 2]).normalized();
  else {
    const std::size_t k =
        static_cast<std::size_t>(std::upper_bound(c.s.begin(), c.s.end(), s) - c.s.begin());
    const double span = c.s[k] - c.s[k - 1];
    p = c.points[k - 1] +
        (span > 0 ? (s - c.s[k - 1]) / span : 0.0) * (c.points[k] - c.points[k - 1]);
  }
  if (out != 0)
    p += out * (p - c.center).normalized();
  return {m_left ? p.x() : -p.x(), c.y, p.y()};
}

Vec3 LegTube::at(Side side, double t, double row, double out) const {
  const double last = static_cast<double>(m_curves.size()) - 1, x = std::clamp(row, 0.0, last);
  const std::size_t k =
      std::min(static_cast<std::size_t>(x), m_curves.size() - (m_curves.size() > 1 ? 2 : 1));
  const double f = x - static_cast<double>(k);
  const Vec3 a = on(m_curves[k], side, t, out);
  return f > 0 ? Vec3((1 - f) * a + f * on(m_curves[k + 1], side, t, out)) : a;
}

} // namespace sloper::pattern
