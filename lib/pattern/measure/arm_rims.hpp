#pragma once
/// Rims of a sewn garment that lie at one of its arms and can be no wrist.
/// Test: tests/pattern/measure/test_half_sewn.cpp
#include <pattern/measure/cloth_rims.hpp>
#include <sloper/pattern/seams/check_pattern.hpp>

#include <vector>

namespace sloper::pattern {

/// Rims that a missing seam leaves: of the trunk and of one of two arms, as an armhole of which a
/// part is sewn to nothing; and, of an arm that hangs on the trunk, rims beside the longest of its
/// own, as where the end of a cap is sewn to nothing. A neck has the pieces of both arms or of
/// none, and an arm one wrist. Rims of collars, and holes in one panel, are left out. Each finding
/// ("half-sewn") names the rim's longest edge.
/// @param pattern  with its seams
/// @param mesh  of that pattern
/// @param rims  all of the mesh
std::vector<PatternFinding> half_sewn_arms(const Pattern& pattern, const PanelMesh& mesh,
                                           const std::vector<ClothRim>& rims);

} // namespace sloper::pattern
