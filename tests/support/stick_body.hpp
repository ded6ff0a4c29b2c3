#pragma once
/// A figure of closed tubes with the landmarks that placement asks for; arms at any angle from
/// hanging down.
#include <sloper/body/body.hpp>

#include <cmath>

namespace sloper::pattern::test {

/// Closed tube from a to b with half axes rx (along `wide`) and rz.
inline void add_tube(body::Body& body, body::Part part, const Vec3& a, const Vec3& b,
                     const Vec3& wide, double rx, double rz) {
  constexpr int AROUND = 24, UP = 16;
  const Vec3 up = (b - a).normalized(), x = (wide - wide.dot(up) * up).normalized(),
             z = x.cross(up);
  TriangleMesh& m = body.skin;
  const int first = std::ssize(m.positions);
  for (int r = 0; r <= UP; ++r) {
    const double t = static_cast<double>(r) / UP,
                 swell = std::sqrt(std::max(0.05, 1 - std::pow(2 * t - 1, 8)));
    for (int c = 0; c < AROUND; ++c) {
      const double angle = 2 * M_PI * c / AROUND;
      m.positions.push_back(a + t * (b - a) +
                            swell * (rx * std::cos(angle) * x + rz * std::sin(angle) * z));
    }
  }
  const auto id = [&](int r, int c) { return first + r * AROUND + c % AROUND; };
  const auto add = [&](int i, int j, int k) {
    m.triangles.push_back({i, j, k});
    body.face_part.push_back(part);
  };
  for (int r = 0; r < UP; ++r)
    for (int c = 0; c < AROUND; ++c) {
      add(id(r, c), id(r + 1, c + 1), id(r, c + 1));
      add(id(r, c), id(r + 1, c), id(r + 1, c + 1));
    }
  for (int c = 1; c + 1 < AROUND; ++c) {
    add(id(0, 0), id(0, c), id(0, c + 1));
    add(id(UP, 0), id(UP, c + 1), id(UP, c));
  }
}

inline body::Body stick_body(double arm_deg, double size = 1) {
  body::Body body;
  using body::Part;
  const auto mark = [&](const std::string& name, const Vec3& p) {
    body.landmarks[name].p = size * p;
  };
  const auto level = [&](const std::string& name, double y, double girth) {
    body.levels[name] = {size * y, size * girth, size * 0.3, size * 0.2, "test"};
  };
  const auto tube = [&](Part part, const Vec3& a, const Vec3& b, double rx, double rz) {
    add_tube(body, part, size * a, size * b, Vec3(1, 0, 0.01), size * rx, size * rz);
  };
  tube(Part::TORSO, Vec3(0, 0.78, 0), Vec3(0, 1.42, 0), 0.17, 0.12);
  tube(Part::HEAD, Vec3(0, 1.38, 0), Vec3(0, 1.7, 0), 0.07, 0.08);
  for (int side = 0; side < 2; ++side) {
    const double s = side ? -1 : 1, a = arm_deg * M_PI / 180;
    const Vec3 shoulder(s * 0.19, 1.36, 0), along(s * std::sin(a), -std::cos(a), 0);
    tube(side ? Part::ARM_R : Part::ARM_L, shoulder, shoulder + 0.7 * along, 0.045, 0.045);
    tube(side ? Part::LEG_R : Part::LEG_L, Vec3(s * 0.09, 0.02, 0), Vec3(s * 0.09, 0.85, 0), 0.075,
         0.08);
    const std::string tail = side ? "_r" : "_l";
    mark("shoulder_joint" + tail, shoulder);
    mark("elbow" + tail, shoulder + 0.3 * along);
    mark("wrist" + tail, shoulder + 0.55 * along);
    mark("neck_side" + tail, Vec3(s * 0.06, 1.42, 0));
  }
  mark("neck_center", Vec3(0, 1.41, 0));
  level("waist_semantic", 1.05, 0.85);
  level("omphalion", 1.0, 0.9);
  level("hip", 0.86, 0.95);
  body.scan.stature_m = size * 1.7;
  return body;
}

} // namespace sloper::pattern::test
