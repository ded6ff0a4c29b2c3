#pragma once
/// The narrowest taut girth of a neck, however the head leans: a length that needs no landmark on
/// the skin.
/// Test: tests/body/measure/test_narrowest_neck.cpp
#include <optional>
#include <sloper/geometry/triangle_mesh.hpp>
namespace sloper::body {

/// A plane section of the neck.
struct NeckSection {
  double girth_m;
  Vec3 center; ///< where its plane meets the neck's axis, m
  Vec3 normal; ///< unit, upwards
};

/// The section of least taut girth over the plane's height, pitch and roll. The plane leans where
/// the neck does, so a bent head does not lengthen it. Chin and shoulders only widen a section, so
/// none is taken that has them in it.
/// @param base    middle of the neck's base, m
/// @param normal  unit: up along the neck, as well as it is known
/// @param stature m
/// @return nothing where no plane above the base has a section around the neck's axis.
/// Cost: about a hundred cuts of the skin within a tenth of the stature of the neck.
std::optional<NeckSection> narrowest_neck(const TriangleMesh& skin, const Vec3& base,
                                          const Vec3& normal, double stature);

} // namespace sloper::body
