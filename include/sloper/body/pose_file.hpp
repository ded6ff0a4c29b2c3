#pragma once
/// Poses from files: joint angles as JSON, motion as BVH (Biovision hierarchy).
#include <sloper/body/pose.hpp>
namespace sloper::body {

/// Poses at equal steps of time.
struct Motion {
  std::vector<Pose> poses; ///< in order
  double frame_s = 0;      ///< time between two poses; 0 for a single one
};

/// {"format": "pose", "version": 1, "arms_deg": 30, "turn_deg": {"forearm_l": [x, y, z], ...},
/// "shift_m": [x, y, z]}. `arms_deg` lets both arms hang at that angle from straight down
/// (`arm_l_deg`, `arm_r_deg` one of them); `turn_deg` turns a joint about the body's x (to its
/// left), then y (up), then z (to the front) axis, relative to its parent, from where the scan has
/// it, after that.
/// @throws Error INPUT; unknown keys and joints are errors with a suggestion
Pose read_pose(const std::string& path, const Body& body);

/// BVH, joints by the usual names (Hips, Spine, Chest, Neck, Head, LeftArm or LeftShoulder,
/// LeftForeArm, LeftUpLeg, ...). Every bone takes the direction that its BVH bone has, whatever
/// stance the scan and the BVH's own rest pose stand in; the hips travel in proportion to the leg's
/// length, from above the origin. Fingers and face are left out.
/// @param step_s s between the poses that are kept, 0 for all
/// @throws Error INPUT naming line and fact
Motion read_bvh(const std::string& path, const Body& body, double step_s);
/// The same from text.
/// @param name  for messages
/// @param step_s  as of read_bvh()
Motion parse_bvh(std::string_view text, const std::string& name, const Body& body, double step_s);

} // namespace sloper::body
