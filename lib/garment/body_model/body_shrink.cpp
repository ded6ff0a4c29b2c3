#include <sloper/garment/body_model/body_shrink.hpp>

#include <algorithm>

namespace sloper::garment {

namespace {

struct Segment {
  Vec3 a, b;
};

Vec3 nearest_on(const Segment& s, const Vec3& p) {
  const Vec3 d = s.b - s.a;
  const double t = std::clamp((p - s.a).dot(d) / std::max(d.squaredNorm(), 1e-12), 0.0, 1.0);
  return s.a + t * d;
}

/// Bones of one part as line segments; those whose landmarks were not found are left out.
std::vector<Segment> bones_of(const body::Body& body, body::Part part) {
  std::vector<Segment> bones;
  auto add = [&](const std::string& from, const std::string& to) {
    if (body.has_landmark(from) && body.has_landmark(to))
      bones.push_back({body.landmarks.at(from).p, body.landmarks.at(to).p});
  };
  auto limb = [&](const std::string& side, bool arm) {
    if (arm) {
      add("shoulder_joint" + side, "elbow" + side);
      add("elbow" + side, "wrist" + side);
      add("wrist" + side, "hand_tip" + side);
    } else {
      add("hip_joint" + side, "knee" + side);
      add("knee" + side, "ankle" + side);
      add("ankle" + side, "foot_tip" + side);
    }
  };
  switch (part) {
  case body::Part::HEAD: add("neck_center", "head_tip"); break;
  case body::Part::ARM_L: limb("_l", true); break;
  case body::Part::ARM_R: limb("_r", true); break;
  case body::Part::LEG_L: limb("_l", false); break;
  case body::Part::LEG_R: limb("_r", false); break;
  default:
    add("hip_center", "neck_center");
    add("neck_center", "shoulder_joint_l");
    add("neck_center", "shoulder_joint_r");
    add("hip_center", "hip_joint_l");
    add("hip_center", "hip_joint_r");
  }
  return bones;
}

} // namespace

BodyShrink::BodyShrink(const body::Body& body)
    : m_skin(body.skin.positions), m_bone_point(body.skin.positions) {
  std::vector<body::Part> part(m_skin.size(), body::Part::TORSO);
  for (std::size_t f = 0; f < body.skin.triangles.size(); ++f)
    for (int v : body.skin.triangles[f])
      part[v] = body.face_part[f];
  std::vector<Segment> bones[body::N_PARTS];
  for (int p = 0; p < body::N_PARTS; ++p)
    bones[p] = bones_of(body, static_cast<body::Part>(p));
  for (std::size_t v = 0; v < m_skin.size(); ++v) {
    const int p = std::min(static_cast<int>(part[v]), body::N_PARTS - 1);
    double best = 1e300;
    for (const Segment& bone : bones[p]) {
      const Vec3 q = nearest_on(bone, m_skin[v]);
      if (const double d = (q - m_skin[v]).norm(); d < best) {
        best = d;
        m_bone_point[v] = q;
      }
    }
    if (best < 1e300)
      m_reach = std::max(m_reach, best);
  }
}

std::vector<Vec3> BodyShrink::positions(double s) const {
  std::vector<Vec3> out(m_skin.size());
  for (std::size_t v = 0; v < out.size(); ++v)
    out[v] = m_bone_point[v] + s * (m_skin[v] - m_bone_point[v]);
  return out;
}

} // namespace sloper::garment
