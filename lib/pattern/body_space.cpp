#include <base/error.hpp>
#include <pattern/body_space.hpp>

#include <algorithm>
#include <cmath>

namespace sloper::pattern {

using body::Part;

BodySpace::BodySpace(const body::Body& body) : m_body(body), m_part(body.skin.positions.size(), Part::NONE) {
  for (std::size_t t = 0; t < body.skin.triangles.size(); ++t)
    for (int v : body.skin.triangles[t])
      if (m_part[static_cast<std::size_t>(v)] == Part::NONE && t < body.face_part.size()) m_part[static_cast<std::size_t>(v)] = body.face_part[t];
  m_stature = body.scan.stature_m > 0 ? body.scan.stature_m : bounding_box(body.skin.positions).high.y();
  if (body.skin.triangles.empty()) throw input_error("", "body", "the body has no skin", "make it with scan-landmarks");
}

std::vector<Vec2> BodySpace::points(const Axis& axis, const std::vector<Part>& parts, double low, double high) const {
  // For a hull the outermost point of every direction does; 256 directions keep it within 0.1 mm.
  std::vector<Vec2> all;
  Vec2 sum = Vec2::Zero();
  for (std::size_t k = 0; k < m_part.size(); ++k) {
    if (std::find(parts.begin(), parts.end(), m_part[k]) == parts.end()) continue;
    const double v = axis.height(m_body.skin.positions[k]);
    if (v < low || v > high) continue;
    all.push_back(axis.plane(m_body.skin.positions[k]));
    sum += all.back();
  }
  if (all.size() < 300) return all;
  std::vector<int> keep(256, -1);
  std::vector<Vec2> direction(keep.size());
  for (std::size_t d = 0; d < keep.size(); ++d)
    direction[d] = Vec2(std::cos(2 * M_PI * static_cast<double>(d) / 256), std::sin(2 * M_PI * static_cast<double>(d) / 256));
  for (std::size_t k = 0; k < all.size(); ++k)
    for (std::size_t d = 0; d < keep.size(); ++d)
      if (keep[d] < 0 || all[k].dot(direction[d]) > all[static_cast<std::size_t>(keep[d])].dot(direction[d])) keep[d] = static_cast<int>(k);
  std::sort(keep.begin(), keep.end());
  keep.erase(std::unique(keep.begin(), keep.end()), keep.end());
  std::vector<Vec2> out;
  for (int k : keep) out.push_back(all[static_cast<std::size_t>(k)]);
  return out;
}

Axis BodySpace::trunk(bool back) const {
  Axis axis;
  axis.front = back ? Vec3(0, 0, -1) : Vec3(0, 0, 1);
  return axis;
}

Axis BodySpace::neck() const {
  Axis axis;
  if (m_body.has_landmark("neck_center")) axis.origin = Vec3(m_body.landmark("neck_center").x(), 0, m_body.landmark("neck_center").z());
  return axis;
}

Axis BodySpace::arm(bool left, int facing, double sleeve_length) const {
  const std::string side = left ? "_l" : "_r";
  const auto landmark = [&](std::initializer_list<const char*> names) -> const Vec3& {
    for (const char* name : names)
      if (m_body.has_landmark(name + side)) return m_body.landmark(name + side);
    return m_body.landmark(*names.begin() + side); // throws, naming the first
  };
  const Vec3 shoulder = landmark({"shoulder_joint", "acromion"}), elbow = landmark({"elbow", "wrist", "hand_tip"}), wrist = landmark({"wrist", "hand_tip"});
  Axis axis;
  axis.origin = shoulder;
  axis.up = (shoulder - (sleeve_length > 1.1 * (shoulder - elbow).norm() ? wrist : elbow)).normalized();
  const Vec3 wanted = facing == 0 ? Vec3(0, 0, 1) : facing == 1 ? Vec3(0, 0, -1) : Vec3(left ? 1 : -1, 1, 0);
  axis.front = (wanted - wanted.dot(axis.up) * axis.up);
  if (axis.front.norm() < 1e-3) axis.front = axis.up.unitOrthogonal();
  axis.front.normalize();
  return axis;
}

double BodySpace::shoulder_height(double x) const {
  double top = -1e300;
  for (std::size_t k = 0; k < m_part.size(); ++k)
    if (m_part[k] == Part::TORSO && std::abs(std::abs(m_body.skin.positions[k].x()) - x) < 0.012) top = std::max(top, m_body.skin.positions[k].y());
  if (top > 0) return top;
  return m_body.has_landmark("neck_center") ? m_body.landmark("neck_center").y() : 0.83 * m_stature;
}

double BodySpace::level(const std::string& name, double fallback_fraction) const {
  const auto it = m_body.levels.find(name);
  return it != m_body.levels.end() ? it->second.y : fallback_fraction * m_stature;
}

double BodySpace::waist_height(double length) const {
  // Girths of the levels that are known, from the waist down, with straight lines between them.
  std::vector<std::array<double, 2>> known;
  for (const auto& [name, level] : m_body.levels)
    if (name == "waist_girth_min" || name == "waist_semantic" || name == "omphalion" || name == "abdomen" || name == "hip")
      known.push_back({level.y, level.girth_m});
  const double waist = level("waist_semantic", 0.63), hip = level("hip", 0.51);
  if (known.size() < 2) return waist;
  std::sort(known.begin(), known.end());
  for (double y = waist; y > hip + 0.05; y -= 0.005) {
    double girth = known.back()[1];
    for (std::size_t k = 0; k + 1 < known.size(); ++k)
      if (y >= known[k][0] && y <= known[k + 1][0])
        girth = known[k][1] + (y - known[k][0]) / std::max(known[k + 1][0] - known[k][0], 1e-6) * (known[k + 1][1] - known[k][1]);
    if (girth >= length - 0.005) return y;
  }
  return waist;
}

} // namespace sloper::pattern
