#include <body/measure/arm_region.hpp>

#include <algorithm>
#include <cmath>

namespace sloper::body {

namespace {

// all shares of stature
constexpr double HAND = 0.13;       ///< along the centre line: fingers and thumb spread from it
constexpr double HAND_REACH = 0.07; ///< and no farther than this
constexpr double SHOULDER =
    0.05; ///< along the centre line before its end, where the arm widens to the shoulder
constexpr double SHOULDER_REACH = 0.085;
constexpr double BEYOND = 0.08;     ///< the centre line goes on this far beyond its last section
constexpr double FREE_PLAY = 0.012; ///< over what the arm's radius tells
constexpr double THICK = 1.5;       ///< of the radius: a flexed or flattened arm
constexpr double DETOUR = 0.035;    ///< a way over the skin that is longer than the shortest to the
                                    ///< same section by more leads around the arm pit
constexpr double BIN = 0.01;        ///< along the centre line

} // namespace

ArmRegion::ArmRegion(const ArmTrace& arm, const TriangleMesh& skin, double stature)
    : m_arm(arm), m_s(stature) {
  if (arm.sections.empty())
    return;
  auto add = [&](const Vec3& p, double along, double girth) {
    m_points.push_back(p);
    m_along.push_back(along);
    m_radius.push_back(girth / (2 * 3.14159265358979));
  };
  add(arm.tip, 0, arm.sections.front().girth);
  for (std::size_t k = 0; k < arm.sections.size(); k += 3)
    add(arm.sections[k].center, arm.sections[k].along, arm.sections[k].girth);
  const double end = arm.length();
  add(arm.at(end), end, arm.sections.back().girth);
  add(arm.at(end + BEYOND * m_s), end + BEYOND * m_s, arm.sections.back().girth);
  std::vector<int> reached;
  std::vector<Place> places;
  std::vector<double> shortest(static_cast<std::size_t>((end + BEYOND * m_s) / (BIN * m_s)) + 2,
                               1e300);
  auto bin_of = [&](double along) { return static_cast<std::size_t>(along / (BIN * m_s)); };
  for (std::size_t v = 0; v < skin.positions.size(); ++v) {
    if (arm.from_tip[v] > 1e199)
      continue;
    const Place place = nearest(skin.positions[v]);
    if (!is_within(place))
      continue;
    reached.push_back(static_cast<int>(v));
    places.push_back(place);
    double& least = shortest[bin_of(place.along)];
    least = std::min(least, arm.from_tip[v]);
  }
  for (std::size_t b = 1; b < shortest.size(); ++b) // a coarse mesh has no vertex in some of them
    if (shortest[b] > 1e199)
      shortest[b] = shortest[b - 1] + BIN * m_s;
  for (std::size_t i = 0; i < reached.size(); ++i)
    if (arm.from_tip[reached[i]] < shortest[bin_of(places[i].along)] + DETOUR * m_s ||
        places[i].along < HAND * m_s)
      m_vertices.push_back(reached[i]);
}

ArmRegion::Place ArmRegion::nearest(const Vec3& p) const {
  Place best{0, 1e300, 0};
  for (std::size_t k = 0; k + 1 < m_points.size(); ++k) {
    const Vec3 d = m_points[k + 1] - m_points[k];
    const double t =
        std::clamp((p - m_points[k]).dot(d) / std::max(d.squaredNorm(), 1e-20), 0.0, 1.0);
    const double off = (p - m_points[k] - t * d).norm();
    if (off < best.off)
      best = {(1 - t) * m_along[k] + t * m_along[k + 1], off,
              (1 - t) * m_radius[k] + t * m_radius[k + 1]};
  }
  return best;
}

bool ArmRegion::is_within(const Place& place) const {
  if (place.along < HAND * m_s)
    return place.off < HAND_REACH * m_s;
  if (place.along > m_arm.length() - SHOULDER * m_s)
    return place.off < SHOULDER_REACH * m_s + FREE_PLAY * m_s;
  return place.off < THICK * place.radius + FREE_PLAY * m_s;
}

} // namespace sloper::body
