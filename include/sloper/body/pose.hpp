#pragma once
/// A body in other poses: smooth skin weights from parts and bones, and dual quaternion skinning
/// (Kavan, Collins, Zara and O'Sullivan 2007), which keeps the skin's volume at shoulders and
/// crotch where blended matrices would collapse it. Bones turn about their heads and never change
/// their length. The skin does not flex its muscles or touch itself.
/// Test: tests/body/test_pose.cpp
#include <Eigen/Geometry>
#include <sloper/body/body.hpp>
namespace sloper::body {

/// The chain that poses turn: "root" (all), then the bones of body.bones by name. Pelvis
/// bones move with the root; "spine" bends the trunk above the hips, and head, clavicles
/// and arms follow it. A clavicle that a pose does not turn rises with its arm, by a
/// quarter of the arm's elevation beyond 60 degrees from hanging (about 30 of 180
/// degrees: Inman, Saunders and Abbott 1944); the arm's own direction is as the pose
/// states it.
struct SkinWeights {
  static constexpr int MOST = 5;               ///< joints that can move one vertex
  std::vector<std::string> joints;             ///< names; 0 is "root"
  std::vector<std::array<int, MOST>> joint;    ///< per vertex of the skin
  std::vector<std::array<double, MOST>> share; ///< sum to 1
};

/// Weights from the six parts and the bones. Along a limb they pass from bone to bone
/// within about its radius, at a border of parts within 2.5 to 4.5 % of stature to both
/// sides over the skin; the trunk around a shoulder moves with its clavicle. Independent
/// of the mesh's resolution. A few shortest-path searches over the skin, 30 ms for 13,000
/// vertices.
/// @throws Error INPUT when the body has no skin or lacks the bones of the trunk
SkinWeights skin_weights(const Body& body);

/// How far each joint turns from where the scan has it.
struct Pose {
  /// Joint -> turn about its head, axes of the body frame, relative to its parent.
  std::map<std::string, Eigen::Quaterniond> turn;
  Vec3 shift = Vec3::Zero(); ///< of the whole body, m
};

/// "root" and every bone that a pose may turn.
std::vector<std::string> joint_names(const Body& body);

/// Motion of every joint: world = turn * (p - head) + head, in the body frame, m.
/// @throws Error INPUT for a joint of `pose` that the body does not have
std::map<std::string, Eigen::Isometry3d> joint_motions(const Body& body, const Pose& pose);

/// The skin's vertices in a pose, #V by 3, m. O(#V).
/// @param weights  of skin_weights(body)
/// @throws Error INPUT for a joint that the body does not have
std::vector<Vec3> posed_skin(const Body& body, const SkinWeights& weights, const Pose& pose);

/// The whole body in a pose: skin, landmarks, bones, frames, stance. Girths and levels
/// stay those of the scan. Arguments and errors as of posed_skin().
Body posed_body(const Body& body, const SkinWeights& weights, const Pose& pose);

/// Turn of an upper arm that brings it to this angle, rad, from straight down, about the
/// body's z axis.
/// @throws Error INPUT when the body has no such bone
Eigen::Quaterniond arm_turn(const Body& body, bool left, double angle);

} // namespace sloper::body
