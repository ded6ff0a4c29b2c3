#pragma once
/// How good a panel mesh is.
#include <pattern/mesh/smallest_angle.hpp>
#include <sloper/base/units.hpp>
#include <sloper/pattern/panel_mesh.hpp>

#include <algorithm>

namespace sloper::pattern {

/// Smallest angle over all triangles, degrees, in the pattern.
inline double smallest_angle_deg(const PanelMesh& mesh) {
  double worst = units::PI;
  const auto at = [&](int v) -> const Vec2& { return mesh.pattern[v]; };
  for (const Triangle& t : mesh.triangles)
    worst = std::min(worst, smallest_angle(at(t[0]), at(t[1]), at(t[2])));
  return units::degrees(worst);
}

} // namespace sloper::pattern
