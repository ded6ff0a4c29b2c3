#pragma once
/// Cloth of several layers that act as one: interfacing, fusible, lining.
/// Test: tests/garment/test_materials.cpp
#include <sloper/garment/garment.hpp>

#include <vector>

namespace sloper::garment {

/// A layer on the face fabric.
struct ClothLayer {
  Material material;    ///< of this layer alone
  double bond = 0;      ///< 0..1: 0 lies loose (lining), 1 is fused over its whole area
  bool outside = false; ///< else on the body's side
};

/// One material that weighs, stretches, shears and bends as the stack does.
///
/// Weight, thickness, tension and shear per width add. Bending adds too, and a bonded
/// layer contributes the parallel-axis term bond * E1 E2 / (E1 + E2) d^2 of two sheets at
/// the distance d of their middles (Timoshenko and Gere 1961), with E the tension per
/// width at unit strain along the same direction; along the bias 4 / E = 1 / warp + 1 /
/// weft + 1 / shear (Hearle, Grosberg and Backer 1969). A bonded stack bends by direction
/// where its warp and weft differ. friction_body is that of the last layer on
/// the body's side, friction_self that of the last layer outside, which folds of the cloth touch;
/// on a side without a layer it is the face's.
/// @param layers  in the order in which they are put on; empty: the face as it is
Material layered(const Material& face, const std::vector<ClothLayer>& layers);

} // namespace sloper::garment
