#pragma once
/// Collars and lapels that are turned over lie outside of the cloth that they are turned over.
/// Test: tests/garment/levels/test_turned_leaves.cpp
#include <sloper/garment/garment.hpp>

namespace sloper::garment {

/// Moves turned cloth that ended beneath the rest of the garment onto it, along the normals there.
/// Soft sewing has no contact of cloth with cloth, so that chance decides which of two sheets is
/// above. Cloth within 8 mm of a roll line, which is folded, does not move.
/// @param garment  sewn, positions in m; without roll lines nothing changes
/// @param gap_m    distance from the other cloth to which it is moved, m
/// @return number of particles that were moved; cost: three searches a turned particle
int lay_leaves_over(Garment& garment, double gap_m);

} // namespace sloper::garment
