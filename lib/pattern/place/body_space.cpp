#include <pattern/place/body_space.hpp>
#include <sloper/base/error.hpp>
#include <sloper/base/units.hpp>
#include <sloper/body/measure/section.hpp>

#include <algorithm>
#include <cmath>

namespace sloper::pattern {

using body::Part;

BodySpace::BodySpace(const body::Body& body)
    : m_body(body), m_part(body.skin.positions.size(), Part::NONE) {
  for (std::size_t t = 0; t < body.skin.triangles.size(); ++t)
    for (int v : body.skin.triangles[t])
      if (m_part[v] == Part::NONE && t < body.face_part.size())
        m_part[v] = body.face_part[t];
  for (std::size_t t = 0; t < body.face_part.size() && t < body.skin.triangles.size(); ++t)
    if (const Part part = body.face_part[t];
        part == Part::TORSO || part == Part::LEG_L || part == Part::LEG_R)
      m_trunk.push_back(static_cast<int>(t));
  m_stature =
      body.scan.stature_m > 0 ? body.scan.stature_m : bounding_box(body.skin.positions).high.y();
  if (body.skin.triangles.empty())
    throw input_error("body.no-skin"_id, "", "body", "the body has no skin",
                      "make it with scan-landmarks");
}

std::vector<Vec2> BodySpace::points(const Axis& axis, const std::vector<Part>& parts, double low,
                                    double high) const {
  // For a hull the outermost point of every direction does; 256 directions keep it within 0.1 mm.
  std::vector<Vec2> all;
  Vec2 sum = Vec2::Zero();
  for (std::size_t k = 0; k < m_part.size(); ++k) {
    if (std::find(parts.begin(), parts.end(), m_part[k]) == parts.end())
      continue;
    const double v = axis.height(m_body.skin.positions[k]);
    if (v < low || v > high)
      continue;
    all.push_back(axis.plane(m_body.skin.positions[k]));
    sum += all.back();
  }
  if (all.size() < 300)
    return all;
  std::vector<int> keep(256, -1);
  std::vector<Vec2> direction(keep.size());
  for (std::size_t d = 0; d < keep.size(); ++d)
    direction[d] = Vec2(std::cos(2 * units::PI * static_cast<double>(d) / 256),
                        std::sin(2 * units::PI * static_cast<double>(d) / 256));
  for (std::size_t k = 0; k < all.size(); ++k)
    for (std::size_t d = 0; d < keep.size(); ++d)
      if (keep[d] < 0 || all[k].dot(direction[d]) > all[keep[d]].dot(direction[d]))
        keep[d] = static_cast<int>(k);
  std::sort(keep.begin(), keep.end());
  keep.erase(std::unique(keep.begin(), keep.end()), keep.end());
  std::vector<Vec2> out;
  for (int k : keep)
    out.push_back(all[k]);
  return out;
}

Axis BodySpace::trunk(bool back) const {
  Axis axis;
  axis.front = back ? Vec3(0, 0, -1) : Vec3(0, 0, 1);
  return axis;
}

Axis BodySpace::neck() const {
  Axis axis;
  if (m_body.has_landmark("neck_center"))
    axis.origin = Vec3(m_body.landmark("neck_center").x(), 0, m_body.landmark("neck_center").z());
  return axis;
}

Axis BodySpace::arm(bool left, int facing, double sleeve_length) const {
  const std::string side = left ? "_l" : "_r";
  const auto landmark = [&](std::initializer_list<const char*> names) -> const Vec3& {
    for (const char* name : names)
      if (m_body.has_landmark(name + side))
        return m_body.landmark(name + side);
    return m_body.landmark(*names.begin() + side); // throws, naming the first
  };
  const Vec3 shoulder = landmark({"shoulder_joint", "acromion"}),
             elbow = landmark({"elbow", "wrist", "hand_tip"}),
             wrist = landmark({"wrist", "hand_tip"});
  Axis axis;
  axis.origin = shoulder;
  axis.up =
      (shoulder - (sleeve_length > 1.1 * (shoulder - elbow).norm() ? wrist : elbow)).normalized();
  Vec3 wanted(left ? 1 : -1, 1, 0);
  if (facing == 0)
    wanted = Vec3(0, 0, 1);
  if (facing == 1)
    wanted = Vec3(0, 0, -1);
  axis.front = (wanted - wanted.dot(axis.up) * axis.up);
  if (axis.front.norm() < 1e-3)
    axis.front = axis.up.unitOrthogonal();
  axis.front.normalize();
  return axis;
}

bool BodySpace::has_arm(bool left) const {
  const std::string side = left ? "_l" : "_r";
  const auto has = [&](const char* name) { return m_body.has_landmark(name + side); };
  return (has("shoulder_joint") || has("acromion")) &&
         (has("elbow") || has("wrist") || has("hand_tip")) && (has("wrist") || has("hand_tip"));
}

double BodySpace::shoulder_height(double x) const {
  double top = -1e300;
  for (std::size_t k = 0; k < m_part.size(); ++k)
    if (m_part[k] == Part::TORSO && std::abs(std::abs(m_body.skin.positions[k].x()) - x) < 0.012)
      top = std::max(top, m_body.skin.positions[k].y());
  if (top > 0)
    return top;
  return m_body.has_landmark("neck_center") ? m_body.landmark("neck_center").y() : 0.83 * m_stature;
}

double BodySpace::level(const std::string& name, double fallback_fraction) const {
  const auto it = m_body.levels.find(name);
  return it != m_body.levels.end() ? it->second.y : fallback_fraction * m_stature;
}

double BodySpace::girth(double y) const {
  constexpr double CLOTH = 0.002; // m off the skin
  std::vector<Vec2> points;
  for (int t : m_trunk) {
    const Triangle& triangle = m_body.skin.triangles[t];
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec3 &a = m_body.skin.positions[triangle[k]],
                 &b = m_body.skin.positions[triangle[(k + 1) % 3]];
      if ((a.y() < y) == (b.y() < y))
        continue;
      const Vec3 p = a + (y - a.y()) / (b.y() - a.y()) * (b - a);
      points.push_back({p.x(), p.z()});
    }
  }
  if (points.size() < 3)
    return 0;
  return body::closed_length(body::convex_hull(std::move(points))) + 2 * units::PI * CLOTH;
}

double BodySpace::hang_height(const std::vector<double>& around, double limit) const {
  constexpr double STEP = 0.005,
                   FREE = 2e-5; // m; squared strain, added up over the rows: 0.45 % on one of them
  const double waist = level("waist_semantic", 0.63), hip = level("hip", 0.51);
  const double low = hip + 0.02,
               high = std::min(
                   std::max(waist + 0.01, std::min(level("underbust", 0.66), waist + 0.08)),
                   std::max(limit, low + 0.02));
  const int n = static_cast<int>((high - low) / STEP) + 1,
            depth = static_cast<int>(std::lround(0.01 * static_cast<double>(around.size()) / STEP));
  if (n < 2 || around.empty())
    return waist;
  std::vector<double> girths; // from `high` down
  for (int k = 0; k < n + depth; ++k)
    girths.push_back(girth(high - STEP * k));
  const auto tension = [&](int top) {
    double sum = 0;
    for (std::size_t row = 0; row < around.size(); ++row) {
      const std::size_t at =
          static_cast<std::size_t>(top) + row * static_cast<std::size_t>(std::lround(0.01 / STEP));
      if (at < girths.size() && around[row] > 0)
        sum += std::pow(std::max(girths[at] / around[row] - 1, 0.0), 2);
    }
    return sum;
  };
  int narrowest = 0;
  for (int k = 0; k < n; ++k)
    if (girths[k] < girths[narrowest])
      narrowest = k;
  int best = -1;
  for (int k = 0; k < n; ++k) // the free place nearest to the narrowest
    if (tension(k) <= FREE && (best < 0 || std::abs(k - narrowest) < std::abs(best - narrowest)))
      best = k;
  if (best >= 0) {
    while (best + 1 < n && tension(best + 1) <= FREE)
      ++best;
  } else {
    best = narrowest;
    for (int k = 0; k < n; ++k)
      if (tension(k) < tension(best) - 1e-12)
        best = k;
  }
  return high - STEP * best;
}

} // namespace sloper::pattern
