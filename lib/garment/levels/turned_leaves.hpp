#pragma once
/// Collars and lapels that are turned over lie outside of the cloth that they are turned over.
/// Test: tests/garment/levels/test_turned_leaves.cpp
#include <sloper/garment/garment.hpp>

namespace sloper::garment {

/// Lays turned cloth that ended beneath the rest of the garment on it, along the normals there.
/// Soft sewing knows no contact of cloth with cloth: which of two sheets that cross gives way
/// would be left to chance. Cloth near a roll line, which is folded, stays.
/// @param garment  sewn; without roll lines nothing changes
/// @param gap_m    by which it comes to lie off the other cloth
/// @return particles that were moved
int lay_leaves_over(Garment& garment, double gap_m);

} // namespace sloper::garment
