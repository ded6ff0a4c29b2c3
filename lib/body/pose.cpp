#include <body/skin_profile.hpp>
#include <body/surface/point_grid.hpp>
#include <sloper/base/error.hpp>
#include <sloper/base/units.hpp>
#include <sloper/body/pose.hpp>

#include <algorithm>
#include <cmath>

namespace sloper::body {

namespace {

using Eigen::Isometry3d;
using Eigen::Quaterniond;

/// A raised arm lifts its shoulder: of 180 degrees about 30 are the clavicle's (pose.hpp).
constexpr double LIFT_FROM = units::PI / 3, LIFT_SHARE = 0.25;

/// Unit dual quaternion of a rigid motion: x -> real x real* + translation, with dual = translation
/// * real / 2.
struct DualQuaternion {
  Quaterniond real = Quaterniond::Identity(), dual = Quaterniond(0, 0, 0, 0);
};

DualQuaternion dual_quaternion(const Isometry3d& m) {
  DualQuaternion q;
  q.real = Quaterniond(m.linear()).normalized();
  const Vec3 t = m.translation();
  q.dual = Quaterniond(0, t.x(), t.y(), t.z()) * q.real;
  q.dual.coeffs() *= 0.5;
  return q;
}

/// Kavan et al. 2007, eq. (5) and Algorithm 1: the blend is normalised, so that it is rigid again.
Vec3 blend(const std::vector<DualQuaternion>& motions,
           const std::array<int, SkinWeights::MOST>& joint,
           const std::array<double, SkinWeights::MOST>& share, const Vec3& p) {
  const Quaterniond& pivot = motions[joint[0]].real;
  Eigen::Vector4d real = Eigen::Vector4d::Zero(), dual = Eigen::Vector4d::Zero();
  for (int k = 0; k < SkinWeights::MOST; ++k) {
    if (share[k] <= 0)
      continue;
    const DualQuaternion& q = motions[joint[k]];
    const double w = q.real.dot(pivot) < 0 ? -share[k] : share[k]; // the short way round
    real += w * q.real.coeffs();
    dual += w * q.dual.coeffs();
  }
  const double norm = real.norm();
  Quaterniond r, d;
  r.coeffs() = real / norm;
  d.coeffs() = dual / norm;
  return r * p + 2 * (d * r.conjugate()).vec();
}

/// How far the clavicle goes up with an arm that a pose turns, against where the scan has it.
Quaterniond clavicle_lift(const Body& body, bool left, const Quaterniond& arm_turn) {
  for (const Bone& b : body.bones)
    if (b.name == (left ? "upper_arm_l" : "upper_arm_r")) {
      const Vec3 out = (b.tail - b.head).normalized();
      const auto beyond = [](const Vec3& direction) {
        return std::max(0.0, std::acos(std::clamp(-direction.y(), -1.0, 1.0)) - LIFT_FROM);
      };
      const double lift = LIFT_SHARE * (beyond(arm_turn * out) - beyond(out));
      return Quaterniond(Eigen::AngleAxisd(left ? lift : -lift, Vec3::UnitZ()));
    }
  return Quaterniond::Identity();
}

std::vector<DualQuaternion> motions_of(const Body& body, const SkinWeights& weights,
                                       const Pose& pose) {
  const std::map<std::string, Isometry3d> motion = joint_motions(body, pose);
  std::vector<DualQuaternion> list;
  for (const std::string& name : weights.joints)
    list.push_back(dual_quaternion(motion.at(name)));
  return list;
}

} // namespace

std::vector<std::string> joint_names(const Body& body) {
  std::vector<std::string> names = {"root"};
  for (const Bone& b : body.bones)
    if (!b.name.starts_with("pelvis"))
      names.push_back(b.name);
  return names;
}

std::map<std::string, Isometry3d> joint_motions(const Body& body, const Pose& pose) {
  std::map<std::string, Isometry3d> motion;
  auto turn = [&](const std::string& name) {
    const auto it = pose.turn.find(name);
    return it == pose.turn.end() ? Quaterniond::Identity() : it->second;
  };
  const std::vector<std::string> names = joint_names(body);
  for (const auto& [name, q] : pose.turn)
    if (std::find(names.begin(), names.end(), name) == names.end())
      throw input_error("pose.no-joint"_id, "", name, "the body has no such joint");
  auto about = [](const Quaterniond& q, const Vec3& center) {
    return Isometry3d(Eigen::Translation3d(center) * q * Eigen::Translation3d(-center));
  };
  Vec3 hips = Vec3::Zero();
  for (const Bone& b : body.bones)
    if (b.name == "spine")
      hips = b.head;
  motion["root"] = Isometry3d(Eigen::Translation3d(pose.shift)) * about(turn("root"), hips);
  std::map<std::string, Quaterniond> own;
  for (const std::string& name : names)
    own[name] = turn(name);
  for (const bool left :
       {true, false}) { // the clavicle rises with the arm, which keeps its direction
    const std::string arm = left ? "upper_arm_l" : "upper_arm_r",
                      clavicle = left ? "clavicle_l" : "clavicle_r";
    if (pose.turn.count(clavicle) || !pose.turn.count(arm) || !own.count(clavicle))
      continue;
    own[clavicle] = clavicle_lift(body, left, own[arm]);
    own[arm] = own[clavicle].conjugate() * own[arm];
  }
  for (const Bone& b : body.bones) { // parents come first
    const bool of_root = b.parent.empty() || b.name.starts_with("pelvis");
    const auto parent = motion.find(of_root ? "root" : b.parent);
    const auto turned = own.find(b.name);
    motion[b.name] = (parent == motion.end() ? motion["root"] : parent->second) *
                     about(turned == own.end() ? Quaterniond::Identity() : turned->second, b.head);
  }
  return motion;
}

std::vector<Vec3> posed_skin(const Body& body, const SkinWeights& weights, const Pose& pose) {
  const std::vector<DualQuaternion> motions = motions_of(body, weights, pose);
  std::vector<Vec3> positions(body.skin.positions.size());
  for (std::size_t v = 0; v < positions.size(); ++v)
    positions[v] = blend(motions, weights.joint[v], weights.share[v], body.skin.positions[v]);
  return positions;
}

Body posed_body(const Body& body, const SkinWeights& weights, const Pose& pose) {
  Body out = body;
  const std::map<std::string, Isometry3d> motion = joint_motions(body, pose);
  const std::vector<DualQuaternion> motions = motions_of(body, weights, pose);
  out.skin.positions = posed_skin(body, weights, pose);
  std::map<std::string, std::string>
      joint_of; // landmark at a bone's end -> the bone that carries it
  for (const Bone& b : body.bones)
    for (const auto& [name, landmark] : body.landmarks) {
      if ((landmark.p - b.tail).norm() < 1e-12)
        joint_of[name] = b.name;
      else if ((landmark.p - b.head).norm() < 1e-12 && !joint_of.count(name))
        joint_of[name] = b.name;
    }
  const double reach = 0.15 * std::max(body.scan.stature_m, 0.3);
  const PointGrid near(body.skin.positions, 0.1 * reach), far(body.skin.positions, reach);
  auto move = [&](const std::string& name, const Vec3& p) -> Vec3 {
    if (const auto it = joint_of.find(name); it != joint_of.end())
      return motion.at(it->second) * p;
    int v = near.nearest(p);
    if (v < 0)
      v = far.nearest(p);
    return v < 0 ? Vec3(motion.at("root") * p)
                 : blend(motions, weights.joint[v], weights.share[v], p);
  };
  for (auto& [name, landmark] : out.landmarks) {
    landmark.p = move(name, landmark.p);
    landmark.alternatives.clear();
  }
  for (Bone& b : out.bones) {
    const Isometry3d& m = motion.at(b.name);
    b.head = m * b.head;
    b.tail = m * b.tail;
  }
  double sum = 0;
  int n = 0;
  for (const Bone& b : out.bones)
    for (const bool left : {true, false})
      if (b.name == (left ? "upper_arm_l" : "upper_arm_r")) {
        const double deg =
            units::degrees(std::acos(std::clamp((b.head - b.tail).normalized().y(), -1.0, 1.0)));
        (left ? out.arm_l_deg : out.arm_r_deg) = deg;
        sum += deg;
        ++n;
      }
  if (n)
    out.stance_class = stance_of(sum / n);
  out.frames.clear();
  build_frames(out);
  out.scan.findings.push_back(
      {"body.posed"_id, "info",
       "the body was posed; levels and girths are those of the scan's own stance", "pose"});
  return out;
}

Quaterniond arm_turn(const Body& body, bool left, double angle) {
  for (const Bone& b : body.bones)
    if (b.name == (left ? "upper_arm_l" : "upper_arm_r")) {
      const Vec3 out = (b.tail - b.head).normalized();
      const double now = std::atan2(std::abs(out.x()), -out.y());
      return Quaterniond(Eigen::AngleAxisd((left ? 1 : -1) * (angle - now), Vec3::UnitZ()));
    }
  throw input_error("pose.no-limb"_id, body.scan.file, "bones",
                    std::string("the body has no ") + (left ? "left" : "right") + " upper arm");
}

} // namespace sloper::body
