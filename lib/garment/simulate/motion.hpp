#pragma once
/// A garment on a body that moves: poses as skins, and a drape that follows them with the cloth's own inertia.
#include <body/pose_file.hpp>
#include <garment/simulate/drape.hpp>

#include <functional>
#include <memory>

namespace sloper::garment {

/// The body's skin over time, frame by frame; frame 0 comes `frame_s` after the body stood as it was draped.
struct BodyMoves {
  std::size_t n_frames = 0;
  double frame_s = 1.0 / 30;
  std::size_t lead_in = 0;                            ///< frames at the start that lead from the body as it was draped to the motion's first
  std::function<std::vector<Vec3>(std::size_t)> skin; ///< of frame k, #V by 3 as body.skin, m
  std::shared_ptr<const body::Body> end;              ///< the whole body in the last frame, with its landmarks; null where not known

  MotionInput input() const { return {"", 1 / frame_s}; } ///< for checkpoints of a motion that no file tells from another
};

/// Poses of a motion (pose_file.hpp) on `body`, which outlives this, with a lead-in from the body as it stands: joints turn evenly, for as long
/// as it takes no skin faster than LEAD_IN_SPEED, at least 0.2 s. @throws Error INPUT where the body cannot be posed or there is no pose
BodyMoves moves_of(const body::Body& body, const body::Motion& motion);

/// A numbered sequence of skins (NAME.0001.obj, NAME.0002.obj, ... as scan-landmarks --pose writes it) from its first file on, with a
/// straight lead-in. Files are read as they are needed. @throws Error INPUT for a file without number, or of other vertices or faces than the body's
BodyMoves moves_of_files(const body::Body& body, const std::string& first_file, double frame_s);

/// Either of them by the file's name: a BVH motion, or the first of a numbered sequence of skins. @throws Error INPUT
BodyMoves read_moves(const body::Body& body, const std::string& file, double frame_s);

/// What tells a motion from another: SHA-256 of the BVH file, or of those of all files of the sequence, one after the other. Reads them all.
/// @throws Error INPUT
std::string motion_sha256(const std::string& file);

/// One frame of the cloth, with what an exact audit of it found.
struct MotionFrame {
  int number = 0;    ///< from 1
  int pose = 0;      ///< of the motion, from 1, as scan-landmarks --pose numbers its skins; 0 in the lead-in
  double time_s = 0; ///< since the body began to move
  std::size_t faces_through = 0, vertices_inside = 0, self_intersections = 0;
  long parts = 0;       ///< in which the body went, see cloth/motion/body_motion.hpp; 0: the cloth slept
  bool forced = false;  ///< cloth could not give way, and the skin went through it
  double speed_m_s = 0; ///< of the fastest particle, at most
};
using OnMotionFrame = std::function<void(const MotionFrame&, const Garment&)>;

/// drape(), then the motion: the cloth keeps its velocity, sticks to and slides over the moving skin, and comes to rest again in the last
/// pose. Cloth that comes nowhere for 0.2 s (no particle farther than 0.1 mm) sleeps until skin within 5 cm of its box moves, and in wind never: such
/// frames cost no step. `quality.motion`: frames, lead_in, simulated_s, parts, forced_frames, asleep_frames, largest_way_m (of skin in one frame),
/// ms_per_frame, and frames and counts with faces through the body, vertices inside it and self intersections.
/// @param on_frame  after each frame; may be empty
/// @param checkpoints  as for drape(); while the body moves between two frames, where so many of its parts have passed
DrapeReport drape_in_motion(Garment& garment, const body::Body& body, const BodyMoves& moves, const DrapeSettings& settings, const OnMotionFrame& on_frame,
                            Reporter& reporter, Checkpoints checkpoints = {});

struct DrapeCheckpoint;
/// Goes on from a checkpoint of drape_in_motion() to the same bytes. @param garment  out   @param body, moves  those that the run began with, for whose
/// identity the caller answers   @param on_frame  for the frames still to come: after DrapeState::motion.frame
/// @param checkpoints  as for resume_drape()   @throws Error INPUT for a checkpoint without motion, or whose frames the motion does not have
DrapeReport resume_in_motion(const DrapeCheckpoint& checkpoint, Garment& garment, const body::Body& body, const BodyMoves& moves, const OnMotionFrame& on_frame,
                             Reporter& reporter, Checkpoints checkpoints = {});

} // namespace sloper::garment
