#pragma once
/// The body's skin over time, from a motion file or a sequence of skins.
#include <sloper/body/body.hpp>
#include <sloper/body/pose_file.hpp>
#include <sloper/garment/garment.hpp>
#include <sloper/garment/simulate/request.hpp>

#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace sloper::garment {

/// The body's skin over time, frame by frame; frame 0 comes `frame_s` after the body
/// stood as it was draped.
struct BodyMoves {
  std::size_t n_frames = 0;  ///< lead-in included
  double frame_s = 1.0 / 30; ///< between two frames
  /// Frames at the start that lead from the body as it was draped to the motion's first
  /// pose.
  std::size_t lead_in = 0;
  std::function<std::vector<Vec3>(std::size_t)> skin; ///< of frame k, #V by 3 as body.skin, m
  /// The whole body in the last frame, with its landmarks; null where not known.
  std::shared_ptr<const body::Body> end;

  /// Description for checkpoints of a motion that no file identifies.
  MotionInput input() const { return {"", 1 / frame_s}; }
};

/// Poses of a motion (pose_file.hpp) on a body, with a lead-in from its stance: joints
/// turn evenly, for as long as no skin vertex is faster than LEAD_IN_SPEED, at least 0.2
/// s.
/// @param body  outlives the result
/// @throws Error INPUT where the body cannot be posed or there is no pose
BodyMoves moves_of(const body::Body& body, const body::Motion& motion);

/// A numbered sequence of skins (NAME.0001.obj, NAME.0002.obj, ... as scan-landmarks --pose writes
/// it) from its first file on, with a straight lead-in. Files are read as they are needed. @throws
/// Error INPUT for a file without number, or of other vertices or faces than the body's
/// @param first_file  NAME.0001.obj or a later number
/// @param frame_s  s between two files
BodyMoves moves_of_files(const body::Body& body, const std::string& first_file, double frame_s);

/// Either of them, by the file's name: a BVH motion, or the first of a numbered sequence
/// of skins.
/// @param frame_s  s between two frames
/// @throws Error INPUT
BodyMoves read_moves(const body::Body& body, const std::string& file, double frame_s);

/// Identity of a motion: SHA-256 of the BVH file, or of the hashes of all files of the
/// sequence, one after the other. Reads them all.
/// @throws Error INPUT
std::string motion_sha256(const std::string& file);

/// One frame of the cloth, with what an exact audit of it found.
struct MotionFrame {
  int number = 0; ///< from 1
  /// Of the motion, from 1, as scan-landmarks --pose numbers its skins; 0 in the lead-in.
  int pose = 0;
  double time_s = 0; ///< since the body began to move
  /// Counts of the audit.
  std::size_t faces_through = 0, vertices_inside = 0, self_intersections = 0;
  /// Substeps in which the body advanced (cloth/motion/body_motion.hpp); 0: the cloth was
  /// at rest and not simulated.
  long parts = 0;
  bool forced = false;  ///< cloth could not give way, and the skin went through it
  double speed_m_s = 0; ///< of the fastest particle, at most
};
/// Called after each frame, with the garment as it is then.
using OnMotionFrame = std::function<void(const MotionFrame&, const Garment&)>;

/// A motion that a drape follows, and who sees its frames. It must outlive the drape.
struct FollowedMotion {
  const BodyMoves* moves = nullptr; ///< null: the body stands
  OnMotionFrame on_frame = {};      ///< after each frame; may be empty
};

} // namespace sloper::garment
