#pragma once
/// Limits on the displacement of a step, so that a state free of crossings stays free of
/// them whatever the forces are.
///
/// Two elements (vertex and face, edge and edge) are convex: a plane square to the line
/// between their closest points separates them. While every particle stays on its
/// element's side, the two cannot cross (conservative bounds as in Offset Geometric
/// Contact, Chen et al. 2025, with planes for balls, so that sliding along and moving
/// apart are free). A plane between two elements of cloth may translate along its normal
/// as fast as both let it: cloth in folds then moves as one. Test:
/// tests/cloth/contact/test_contact.cpp
#include <sloper/geometry/types.hpp>
#include <vector>

namespace sloper::cloth {

/// Rounds of a step in which new planes are added; those of the last round stop all
/// remaining displacements.
inline constexpr int MAX_CCD_ROUNDS = 4;

/// A plane between two elements. Particles 0 .. n_above - 1 keep normal . x >= above, the
/// others normal . x <= below.
struct SeparatingPlane {
  /// Particles in use, and how many of them are above.
  int n = 0, n_above = 0;
  /// Those above first.
  std::array<int, 4> particle{};
  Vec3 normal = Vec3::UnitY(); ///< unit
  double above = 0, below = 0; ///< m
};

/// All limits of one step.
struct MotionLimits {
  std::vector<SeparatingPlane> planes;  ///< of near pairs
  std::vector<double> max_displacement; ///< #P, m: no particle moves farther in this step
  /// Planes between cloth and cloth may translate along their normal. Static solves leave them
  /// fixed, which is cheaper and converges as well.
  bool planes_translate = false;

  /// Removes all limits; keeps planes_translate.
  void reset(std::size_t n_particles);
  /// Projects a displacement onto the planes, then shortens what still breaks a plane or
  /// is too long; it pushes nothing. The present positions must keep all planes; then
  /// positions + dx do, those between cloth and cloth by planes moved along where
  /// planes_translate. A few passes over the planes; with planes_translate one more for
  /// each plane that passes on what it stops.
  /// @param x, dx  #P by 3, m; no dx grows
  /// @param held  #P, set to 1 where a plane stopped a particle
  void apply(const std::vector<Vec3>& x, std::vector<Vec3>& dx, std::vector<char>& held) const;
};

} // namespace sloper::cloth
