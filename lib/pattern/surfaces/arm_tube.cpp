#include <pattern/roles/panel_role.hpp>
#include <pattern/surfaces/arm_tube.hpp>
#include <sloper/base/error.hpp>
#include <sloper/base/units.hpp>

#include <cmath>

namespace sloper::pattern {

using body::Part;

ArmTube::ArmTube(const BodySpace& space, const Axis& axis, bool left, double low, double high)
    : m_high(high) {
  const std::size_t n = static_cast<std::size_t>(std::ceil((high - low) / ROW)) + 2;
  std::vector<Ring> skin(n, empty_ring());
  bool any = false;
  for (std::size_t v = 0; v < space.parts().size(); ++v) {
    if (space.parts()[v] != (left ? Part::ARM_L : Part::ARM_R))
      continue;
    const Vec3& p = space.body().skin.positions[v];
    const long row = std::lround((high - axis.height(p)) / ROW);
    if (row < 0 || row >= static_cast<long>(n))
      continue;
    include(skin[row], axis.plane(p));
    any = true;
  }
  if (!any)
    throw input_error("placement.limb-not-scanned"_id, "", "body",
                      std::string("the ") + (left ? "left" : "right") +
                          " arm has no skin where the sleeve lies",
                      "scan the arms, or leave the sleeves out");
  m_section = smooth(joined(filled(std::move(skin)), 2), 2);
  for (const Ring& r : m_section)
    m_center.push_back(
        0.5 * Vec2(r[RING_ANGLES / 4] - r[3 * RING_ANGLES / 4], r[0] - r[RING_ANGLES / 2]));
  m_center = averaged(m_center, 4);
}

ArmTube::Curve ArmTube::trace(std::size_t row, double grown) const {
  const Ring radius = radii(m_section[row], m_center[row], grown);
  Curve c;
  for (int k = -RING_ANGLES / 2; k <= RING_ANGLES / 2; ++k) {
    c.points.push_back(m_center[row] + radius[(k + RING_ANGLES) % RING_ANGLES] * direction(k));
    c.s.push_back(
        c.s.empty() ? 0 : c.s.back() + (c.points.back() - c.points[c.points.size() - 2]).norm());
  }
  c.middle = c.s[RING_ANGLES / 2];
  return c;
}

void ArmTube::shape(const std::vector<double>& widths, double gap) {
  const std::size_t n = m_section.size();
  std::vector<double> less(n, -gap); // than the skin, so that the least is the most grown
  for (std::size_t j = 0; j < n; ++j)
    for (int round = 0; round < 6; ++round) {
      const double missing = widths[j] + PANEL_GAP - trace(j, -less[j]).s.back();
      if (missing < 1e-3)
        break;
      less[j] -= missing / (2 * units::PI);
    }
  less = averaged(least(less, 4), 8);
  m_curves.clear();
  for (std::size_t j = 0; j < n; ++j)
    m_curves.push_back(trace(j, -less[j]));
}

Vec2 ArmTube::on(const Curve& c, double u) {
  const double length = c.s.back(), s = c.middle + u - std::floor((c.middle + u) / length) * length;
  const std::size_t k = std::clamp<std::size_t>(
      static_cast<std::size_t>(std::upper_bound(c.s.begin(), c.s.end(), s) - c.s.begin()), 1,
      c.s.size() - 1);
  const double span = c.s[k] - c.s[k - 1];
  return c.points[k - 1] +
         (span > 0 ? (s - c.s[k - 1]) / span : 0.0) * (c.points[k] - c.points[k - 1]);
}

Vec2 ArmTube::at(double u, double v) const {
  const double x =
      std::clamp((m_high - v) / ROW, 0.0, static_cast<double>(m_curves.size()) - 1.001);
  const std::size_t k = static_cast<std::size_t>(x);
  const double f = x - static_cast<double>(k);
  return (1 - f) * on(m_curves[k], u) + f * on(m_curves[k + 1], u);
}

} // namespace sloper::pattern
