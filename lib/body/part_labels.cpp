#include <body/measure/arm_region.hpp>
#include <body/part_labels.hpp>
#include <body/surface/point_grid.hpp>

#include <algorithm>
#include <cmath>

namespace sloper::body {

namespace {

constexpr double BORDER_REACH =
    0.15; ///< of stature: the border between arm and trunk ends this far from its middle

// Borders fitted to the modeller's parts of 704 bodies in natural and mixed stances. All numbers
// are shares of stature.

/// Of the crown's usual place before, and above, the middle of the neck: half of how far a head is
/// tilted.
constexpr double CROWN_BEFORE = 0.0216, CROWN_ABOVE = 0.1628;

/// The border from the throat to under the skull. It tilts with the head, is an arch from side to
/// side, and lies higher under a crown that is farther up or before the neck.
class HeadBorder {
public:
  /// @param neck middle of the neck @param crown m
  HeadBorder(const Vec3& neck, const std::optional<Vec3>& crown, double stature)
      : m_neck(neck), m_s(stature) {
    const Vec3 at = crown ? Vec3((*crown - neck) / stature) : Vec3(0, CROWN_ABOVE, CROWN_BEFORE);
    const double nods = at.z() / at.y() - CROWN_BEFORE / CROWN_ABOVE, rolls = at.x() / at.y();
    m_cos_nods = std::cos(nods);
    m_sin_nods = std::sin(nods);
    m_cos_rolls = std::cos(rolls);
    m_sin_rolls = std::sin(rolls);
    m_height = HEIGHT + WITH_CROWN_BEFORE * (at.z() - CROWN_BEFORE) +
               WITH_CROWN_ABOVE * (at.y() - CROWN_ABOVE);
  }
  bool is_below(const Vec3& p) const {
    if (std::abs(p.x()) >= BROADEST * m_s)
      return false;
    const Vec3 q = (p - m_neck) / m_s;
    const double y = q.y() * m_cos_nods + q.z() * m_sin_nods,
                 z = q.z() * m_cos_nods - q.y() * m_sin_nods;
    const double up = y * m_cos_rolls + q.x() * m_sin_rolls,
                 aside = q.x() * m_cos_rolls - y * m_sin_rolls;
    return up + STEEP * z - ARCH * aside * aside > m_height;
  }

private:
  static constexpr double BROADEST = 0.1, HEIGHT = 0.0406, STEEP = 0.941, ARCH = 9.0;
  static constexpr double WITH_CROWN_BEFORE = 0.35, WITH_CROWN_ABOVE = 0.68;
  Vec3 m_neck;
  double m_s, m_cos_nods, m_sin_nods, m_cos_rolls, m_sin_rolls, m_height;
};

/// Height of the groin at p, m: it rises from the crotch outwards, steeply to the hip joint, and
/// higher in front than behind.
double groin(double crotch, double hip_x, double hip_z, double s, const Vec3& p) {
  constexpr double BELOW_CROTCH = 0.0194, TO_JOINT = 0.0344, OUTWARDS = 0.39;
  constexpr double FRONT = 0.0131, FRONT_REACH = 0.06, WIDEST = 0.17;
  return crotch - BELOW_CROTCH * s + TO_JOINT * s * std::min(1.0, std::abs(p.x()) / hip_x) +
         OUTWARDS * std::min(std::abs(p.x()), WIDEST * s) +
         FRONT * s * std::clamp((p.z() - hip_z) / (FRONT_REACH * s), -1.0, 1.0);
}

/// How far q is beyond the seam of a sleeve. @param q outwards, up along the seam, forwards from
/// the middle between arm pit and shoulder
double beyond_seam(const Vec3& q) {
  constexpr double OUTSIDE = 0.004, LEANS = 0.13, TURNS = 0.236, BENDS = 133.5, END = 0.06;
  const double along = std::clamp(q.y(), -END, END);
  return q.x() - OUTSIDE - LEANS * along + (TURNS - BENDS * along * along) * q.z();
}

} // namespace

std::vector<Part> label_skin(const Finder& f) {
  const TriangleMesh& skin = f.levels.skin();
  std::vector<Part> part(skin.positions.size(), Part::TORSO);
  const double s = f.s;
  const double crotch = f.has("crotch") ? f.at("crotch").y() : 0.47 * s;
  if (f.has("neck_center")) {
    const HeadBorder border(f.at("neck_center"),
                            f.has("head_tip") ? std::optional(f.at("head_tip")) : std::nullopt, s);
    for (std::size_t v = 0; v < part.size(); ++v)
      if (border.is_below(skin.positions[v]))
        part[v] = Part::HEAD;
  }
  const double hip_x = f.has("hip_joint_l") ? std::abs(f.at("hip_joint_l").x()) : 0.06 * s;
  const double hip_z = f.has("hip_center") ? f.at("hip_center").z() : 0.0;
  for (std::size_t v = 0; v < part.size(); ++v) {
    const Vec3& p = skin.positions[v];
    if (p.y() < groin(crotch, hip_x, hip_z, s, p))
      part[v] = p.x() > f.levels.crotch_point().x() ? Part::LEG_L : Part::LEG_R;
  }
  // arms: beyond the seam from arm pit to the top of the shoulder, on the traced arm
  for (int side = 0; side < 2; ++side) {
    const ArmTrace& arm = f.arms[side];
    if (arm.sections.empty())
      continue;
    const std::string name = std::string("shoulder_joint") + side_suffix(side);
    const Vec3 joint = f.has(name) ? f.at(name) : arm.at(arm.length() + 0.02 * s);
    const double outward = arm.left ? 1 : -1;
    const Vec3 corner = arm.axilla ? *arm.axilla : arm.at(arm.length());
    const Vec3 top = joint + Vec3(-outward * 0.014 * s, 0.037 * s, -0.007 * s);
    Vec3 n = Vec3(top.y() - corner.y(), corner.x() - top.x(), 0)
                 .normalized(); // square to the line from pit to top
    if (n.x() * outward < 0)
      n = -n;
    const Vec3 up(-outward * n.y(), outward * n.x(), 0);
    const Vec3 base = 0.5 * (top + corner);
    const ArmRegion region(arm, skin, s);
    for (const int v : region.vertices()) {
      // a hand may be anywhere, and before the trunk as well
      const Vec3 d = (skin.positions[v] - base) / s;
      if (d.norm() < BORDER_REACH && beyond_seam(Vec3(d.dot(n), d.dot(up), d.z())) < 0)
        continue;
      part[v] = side == 0 ? Part::ARM_L : Part::ARM_R;
    }
  }
  return part;
}

std::vector<Part> label_faces(const std::vector<Triangle>& triangles,
                              const std::vector<Part>& vertex_part) {
  std::vector<Part> face_part(triangles.size());
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    const Part a = vertex_part[triangles[t][0]], b = vertex_part[triangles[t][1]],
               c = vertex_part[triangles[t][2]];
    face_part[t] = b == c ? b : a;
  }
  return face_part;
}

std::vector<Part> label_scan(const std::vector<Vec3>& positions, const std::vector<char>& is_body,
                             const std::vector<int>& of_scan, const TriangleMesh& skin,
                             const std::vector<Part>& skin_part, double reach) {
  std::vector<Part> part(positions.size(), Part::NONE);
  const PointGrid near(skin.positions, 0.25 * reach), far(skin.positions, reach);
  for (std::size_t v = 0; v < positions.size(); ++v) {
    if (!is_body[v])
      continue;
    int i = of_scan.empty() ? -1 : of_scan[v];
    if (i < 0)
      i = near.nearest(positions[v]);
    if (i < 0)
      i = far.nearest(positions[v]);
    if (i >= 0)
      part[v] = skin_part[i];
  }
  return part;
}

} // namespace sloper::body
