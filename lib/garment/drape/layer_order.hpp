#pragma once
/// The order of garments over each other: joined into one cloth, parted again, and brought into
/// order around the body. Test: tests/garment/drape/test_layers.cpp
#include <sloper/collision/body_collider.hpp>
#include <sloper/garment/garment.hpp>

#include <cstddef>
#include <string>
#include <vector>

namespace sloper::garment {

/// What ordering did.
struct LayerOrder {
  std::size_t tucked = 0; ///< inner particles that lay beyond an outer garment, and were moved
  double farthest_m = 0;  ///< of those
  std::size_t crossed = 0,
              remain = 0; ///< edges through faces of another layer, after tucking and at the end
};

/// All garments as one: panels in the same order, materials and scene effects by names of their
/// own. @param garments from the skin outwards, sewn
Garment merge_layers(const std::vector<Garment>& garments);

/// Gives each garment its positions back. @param merged of merge_layers(garments)
void split_layers(const Garment& merged, std::vector<Garment>& garments);

/// Brings layers into order, around the body. Deterministic; does nothing where they are in order.
/// @param garments  from the skin outwards, sewn, each free of the body; positions change
/// @param thickness_m  between two layers
LayerOrder order_layers(std::vector<Garment>& garments, const collision::BodyCollider& body,
                        double thickness_m);

/// Particles of a garment that have a garment which belongs outside of them between themselves and
/// the skin. By layer; the last is 0.
std::vector<std::size_t> order_violations(const std::vector<Garment>& garments,
                                          const collision::BodyCollider& body);

/// "layer 1: ", before the names of panels and materials of merge_layers()
std::string layer_prefix(std::size_t layer);

} // namespace sloper::garment
