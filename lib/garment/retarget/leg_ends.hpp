#pragma once
/// Legs of trousers that are longer than those of the body. Placed by their coordinates they keep
/// their length below the knee, and the foot, which stands across the leg, comes through the cloth.
/// Who wears such trousers has the hem at the ankle and folds above.
/// Test: tests/garment/retarget/test_leg_ends.cpp
#include <sloper/body/body.hpp>
#include <sloper/garment/garment.hpp>

#include <vector>

namespace sloper::garment {

/// Raises the end of each leg that has faces through the skin of the foot, to where it lay over the
/// ankle of the body that the garment is bound to. The leg is shortened evenly below the knee.
/// @param placed  #P by 3, m, in and out
/// @param through  triangles that cross the skin once the garment was cleared of it
/// @return particles of the ends that were raised
std::vector<int> raise_ends_off_feet(std::vector<Vec3>& placed, const Garment& garment,
                                     const body::Body& to, const std::vector<Triangle>& through);

} // namespace sloper::garment
