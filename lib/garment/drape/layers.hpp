#pragma once
/// Garments over each other: a jacket over a shirt, a shirt tucked into trousers.
///
/// Each outer garment is first draped alone, with a wider gap to the skin. Then inner cloth that
/// lies beyond it is tucked in, along the shortest path to the skin, until no element of one layer
/// crosses another; from that state all garments come to rest together, and self contact keeps the
/// order as it keeps any cloth from passing through cloth. So layers need no force of their own. In
/// motion all go with the body. Test: tests/garment/drape/test_layers.cpp
#include <garment/drape/layer_order.hpp>
#include <garment/drape/motion.hpp>
#include <sloper/garment/simulate/checkpoint.hpp>

namespace sloper::garment {

/// Drapes garments over each other. @param garments from the skin outwards; those not sewn yet are
/// draped alone first
/// @return of the joint drape; `quality.layers`: for each garment its strain, what of it is in the
/// body, and its order violations
/// @param checkpoints  as for drape()
/// @param motion  followed once they are at rest, as in drape_in_motion(); its frames show all
/// garments as merge_layers() joins them
/// @throws Error INPUT without a body, or as drape()
DrapeReport drape_layers(std::vector<Garment>& garments, const body::Body* body,
                         const DrapeSettings& settings, Reporter& reporter,
                         const Checkpoints& checkpoints = {}, const FollowedMotion& motion = {});

/// Goes on from a checkpoint of drape_layers() to the same bytes.
/// @param garments  out: from the skin outwards
/// @param body  the one that the run began with
/// @param checkpoints  as for resume_drape()
/// @param motion  as for resume_in_motion(), where the run was in motion
/// @throws Error INPUT for a checkpoint without layers, without a body, or without the motion that
/// the run began with
DrapeReport resume_layers(const DrapeCheckpoint& checkpoint, std::vector<Garment>& garments,
                          const body::Body* body, Reporter& reporter,
                          const Checkpoints& checkpoints = {}, const FollowedMotion& motion = {});

} // namespace sloper::garment
