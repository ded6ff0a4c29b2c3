#pragma once
/// How far particles may go in one step, so that a state free of crossings stays free of them
/// whatever the forces do.
///
/// Two elements (vertex and face, edge and edge) are convex: a plane square to the way between
/// their closest points separates them. While every particle stays on its element's side, the two
/// cannot cross (conservative bounds as in Offset Geometric Contact, Chen et al. 2025, with planes
/// for balls, so that sliding along and moving apart are free). A plane between two elements of
/// cloth may go along its normal as fast as both let it: cloth in folds then moves as one where it
/// flies or is carried. Test: tests/cloth/contact/test_contact.cpp
#include <sloper/geometry/types.hpp>
#include <vector>

namespace sloper::cloth {

inline constexpr int MAX_CCD_ROUNDS =
    4; ///< in which new limits are looked for; then those of the last round stop everything

/// Particles 0 .. n_above - 1 keep normal . x >= above, the others normal . x <= below.
struct SeparatingPlane {
  int n = 0, n_above = 0;
  std::array<int, 4> particle{};
  Vec3 normal = Vec3::UnitY(); ///< unit
  double above = 0, below = 0; ///< m
};

struct MotionLimits {
  std::vector<SeparatingPlane> planes;
  std::vector<double> max_displacement; ///< #P, m: no particle moves farther in this step
  /// Planes between cloth and cloth may translate along their normal. Static solves leave them
  /// fixed, which is cheaper and converges as well.
  bool planes_translate = false;

  void reset(std::size_t n_particles); ///< all but planes_translate
  /// Takes off what of a displacement runs into a plane, then shortens what still breaks a plane or
  /// is too long; pushes nothing. The present positions must keep all planes; then positions + dx
  /// do, those between cloth and cloth by planes moved along where planes_translate.
  /// @param x, dx #P by 3, m; no dx grows   @param held #P, set to 1 where a plane stopped a
  /// particle Cost: a few passes over the planes; with planes_translate as many more as there are
  /// planes that hand on what they stop
  void apply(const std::vector<Vec3>& x, std::vector<Vec3>& dx, std::vector<char>& held) const;
};

} // namespace sloper::cloth
