#pragma once
/// A garment on a body that moves: poses as skins, and a drape that follows them with the cloth's
/// own inertia.
#include <sloper/garment/drape/drape.hpp>
#include <sloper/garment/simulate/body_moves.hpp>

namespace sloper::garment {

/// drape(), then the motion: the cloth keeps its velocity, sticks to and slides over the moving
/// skin, and comes to rest again in the last pose. Cloth that comes nowhere for 0.2 s (no particle
/// farther than 0.1 mm) sleeps until skin within 5 cm of its box moves, and in wind never: such
/// frames cost no step. `quality.motion`: frames, lead_in, simulated_s, parts, forced_frames,
/// asleep_frames, largest_way_m (of skin in one frame), ms_per_frame, and frames and counts with
/// faces through the body, vertices inside it and self intersections.
/// @param motion  with moves
/// @param request  as for drape(); while the body moves, checkpoints are taken between two frames,
/// where so many of its parts have passed
DrapeReport drape_in_motion(Garment& garment, const body::Body& body, const DrapeSettings& settings,
                            const FollowedMotion& motion, Reporter& reporter,
                            const DrapeRequest& request = {});

struct DrapeCheckpoint;
/// Goes on from a checkpoint of drape_in_motion() to the same bytes.
/// @param garment  out
/// @param body, motion  those that the run began with, for whose identity the caller answers;
/// motion.on_frame sees the frames still to come: after DrapeState::move.frame
/// @param checkpoints  as for resume_drape()
/// @throws Error INPUT for a checkpoint without motion,
/// or whose frames the motion does not have
DrapeReport resume_in_motion(const DrapeCheckpoint& checkpoint, Garment& garment,
                             const body::Body& body, const FollowedMotion& motion,
                             Reporter& reporter, const Checkpoints& checkpoints = {});

} // namespace sloper::garment
