#pragma once
/// Garments over each other: a jacket over a shirt, a shirt tucked into trousers.
///
/// Each outer garment is first draped alone, with a wider gap to the skin. Then inner cloth that lies beyond it is tucked in, along the shortest
/// way to the skin, until no element of one layer crosses another; from that state all garments come to rest together, and self contact
/// keeps the order as it keeps any cloth from passing through cloth. So layers need no force of their own. In motion all go with the body.
/// Test: tests/garment/simulate/test_layers.cpp
#include <collision/body_collider.hpp>
#include <garment/simulate/motion.hpp>

namespace sloper::garment {

/// What ordering did.
struct LayerOrder {
  std::size_t tucked = 0;              ///< inner particles that lay beyond an outer garment, and were moved
  double farthest_m = 0;               ///< of those
  std::size_t crossed = 0, remain = 0; ///< edges through faces of another layer, after tucking and at the end
};

/// All garments as one: panels in the same order, materials and scene effects by names of their own. @param garments from the skin outwards, sewn
Garment merge_layers(const std::vector<Garment>& garments);

/// Gives each garment its positions back. @param merged of merge_layers(garments)
void split_layers(const Garment& merged, std::vector<Garment>& garments);

/// Brings layers into order, around the body. Deterministic; does nothing where they are in order.
/// @param garments  from the skin outwards, sewn, each free of the body; positions change
/// @param thickness_m  between two layers
LayerOrder order_layers(std::vector<Garment>& garments, const collision::BodyCollider& body, double thickness_m);

/// Particles of a garment that have a garment which belongs outside of them between themselves and the skin. By layer; the last is 0.
std::vector<std::size_t> order_violations(const std::vector<Garment>& garments, const collision::BodyCollider& body);

/// Drapes garments over each other. @param garments from the skin outwards; those not sewn yet are draped alone first
/// @return of the joint drape; `quality.layers`: for each garment its strain, what of it is in the body, and its order violations
/// @param checkpoints  as for drape()   @param moves  null, or the motion that follows once they are at rest, as in drape_in_motion()
/// @param on_frame  after each of its frames, with all garments as merge_layers() joins them   @throws Error INPUT without a body, or as drape()
DrapeReport drape_layers(std::vector<Garment>& garments, const body::Body* body, const DrapeSettings& settings, Reporter& reporter,
                         Checkpoints checkpoints = {}, const BodyMoves* moves = nullptr, const OnMotionFrame& on_frame = {});

struct DrapeCheckpoint;
/// Goes on from a checkpoint of drape_layers() to the same bytes. @param garments  out: from the skin outwards   @param body  the one that the run
/// began with   @param checkpoints  as for resume_drape()   @param moves, on_frame  as for resume_in_motion(), where the run was in motion
/// @throws Error INPUT for a checkpoint without layers, without a body, or without the motion that the run began with
DrapeReport resume_layers(const DrapeCheckpoint& checkpoint, std::vector<Garment>& garments, const body::Body* body, Reporter& reporter,
                          Checkpoints checkpoints = {}, const BodyMoves* moves = nullptr, const OnMotionFrame& on_frame = {});

} // namespace sloper::garment
