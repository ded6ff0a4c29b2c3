#pragma once
/// Part frames (the paper's Table 2) with the skin radius R(theta, z) around each axis, and the
/// bones.
#include <sloper/body/body.hpp>
namespace sloper::body {

/// Frames of head, torso, arms, legs and the joint "lower_body", from the landmarks that were
/// found; a frame whose landmarks are missing is left out. Profiles come from body.skin and
/// body.face_part.
void build_frames(Body& body);
/// Bones between joints; those whose ends were not found are left out.
void build_bones(Body& body);
/// Radius of the skin around a frame's axis. Columns without skin (openings where a limb hangs on)
/// are filled from their neighbours, then lightly smoothed.
SkinProfile skin_profile(const PartFrame& frame, const TriangleMesh& skin,
                         const std::vector<int>& triangles, double z_low, double z_high, bool taut);

} // namespace sloper::body
