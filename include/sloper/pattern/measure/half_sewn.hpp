#pragma once
/// Edges that are open although the seams around them belong together, found on the sewn cloth.
/// Test: tests/pattern/measure/test_half_sewn.cpp
#include <sloper/pattern/panel_mesh.hpp>
#include <sloper/pattern/seams/check_pattern.hpp>

#include <vector>

namespace sloper::pattern {

/// Places where two edges are open though the seams about them say that they belong together. Where
/// one seam ends on another one and the next does not go on, four pieces lie around the point:
/// about 360 degrees of cloth, and its edge comes back as it went. Necks, slits and hems have one
/// or two pieces at their points. Each finding ("half-sewn") names both edges with what is open of
/// them, m along the rim to its next corner.
///
/// Of 120 random GarmentCode specifications with all of their seams none has one.
/// @param pattern  with its seams
/// @param mesh  of that pattern
std::vector<PatternFinding> half_sewn(const Pattern& pattern, const PanelMesh& mesh);

} // namespace sloper::pattern
