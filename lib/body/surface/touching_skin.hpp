#pragma once
/// Parts of a body that touch in a scan (thighs, an arm and the trunk) are drawn back a little, so
/// that cloth finds room between.
///
/// Flesh gives way to cloth; scanned skin does not. Where skin comes nearer than `gap_m` to skin
/// that faces it, both are moved apart along the normal by half of what is missing, by 3 mm at most
/// and with a smooth rim. Skin that passes through other skin by less than 6 mm is parted too.
/// Landmarks, levels and girths are measured before and do not change. Test:
/// tests/body/surface/test_touching_skin.cpp
#include <sloper/geometry/triangle_mesh.hpp>

namespace sloper::body {

/// How far skin was drawn back.
struct OpenedSkin {
  int vertices = 0;     ///< moved by more than 0.1 mm
  double largest_m = 0; ///< displacement of a vertex
  Vec3 place{0, 0, 0};  ///< where that is, m
};

/// @param skin  outward   @param may_move one per vertex of skin: 0 for hands, feet and head @param
/// gap_m wanted between facing skin Cost: a query of a few millimetres for each vertex and round,
/// up to six rounds.
OpenedSkin open_touching_skin(TriangleMesh& skin, const std::vector<char>& may_move, double gap_m);

} // namespace sloper::body
