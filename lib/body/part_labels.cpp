#include <body/measure/arm_region.hpp>
#include <body/part_labels.hpp>
#include <body/surface/point_grid.hpp>

#include <algorithm>
#include <cmath>

namespace sloper::body {

namespace {

constexpr double BORDER_REACH =
    0.15; ///< of stature: the plane between arm and trunk ends this far from its middle

} // namespace

std::vector<Part> label_skin(const Finder& f) {
  const TriangleMesh& skin = f.levels.skin();
  std::vector<Part> part(skin.positions.size(), Part::TORSO);
  const double s = f.s;
  const double crotch = f.has("crotch") ? f.at("crotch").y() : 0.47 * s;
  // head: above a slanting plane, from over the notch in front to under the skull behind
  if (f.has("neck_center")) {
    const Vec3 middle = f.at("neck_center") + Vec3(0, 0.032 * s, 0.010 * s),
               up = Vec3(0, 0.78, 0.63);
    for (std::size_t v = 0; v < part.size(); ++v)
      if ((skin.positions[v] - middle).dot(up) > 0 && std::abs(skin.positions[v].x()) < 0.1 * s)
        part[v] = Part::HEAD;
  }
  // legs: below the groin, which rises from the crotch to the hip joint, higher in front than
  // behind
  const double hip_x = f.has("hip_joint_l") ? std::abs(f.at("hip_joint_l").x()) : 0.06 * s;
  const double hip_y = f.has("hip_center") ? f.at("hip_center").y() : crotch + 0.05 * s,
               hip_z = f.has("hip_center") ? f.at("hip_center").z() : 0.0;
  for (std::size_t v = 0; v < part.size(); ++v) {
    const Vec3& p = skin.positions[v];
    const double border = crotch - 0.006 * s +
                          (hip_y - crotch + 0.002 * s) * std::min(1.0, std::abs(p.x()) / hip_x) +
                          0.009 * s * std::clamp((p.z() - hip_z) / (0.06 * s), -1.0, 1.0);
    if (p.y() < border)
      part[v] = p.x() > f.levels.crotch_point().x() ? Part::LEG_L : Part::LEG_R;
  }
  // arms: beyond the plane through arm pit and the top of the shoulder, on the traced arm
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
    n = (n + Vec3(0, 0, 0.13)).normalized();
    const Vec3 base = 0.5 * (top + corner);
    const ArmRegion region(arm, skin, s);
    for (const int v : region.vertices()) {
      // a hand may be anywhere, and before the trunk as well
      const bool is_near_border = (skin.positions[v] - base).norm() < BORDER_REACH * s;
      if (is_near_border && (skin.positions[v] - base).dot(n) < 0)
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
