#pragma once
/// Continuous collision: when do moving features first come near (additive CCD, Li et al. 2021, Codimensional IPC, section 4.3).
/// All vertices move on straight lines over t in [0, 1]. Test: tests/collision/test_ccd.cpp
#include <geometry/types.hpp>
#include <optional>
namespace sloper::collision {

/// The time by which the distance has fallen to `min_distance` or, nearer than that at the start, to a tenth of itself:
/// conservative, never later than the true time by rounding or tolerance. Empty where that does not happen in [0, 1].
/// @param min_distance m, >= 0   Features that touch at t = 0 give 0.
std::optional<double> vertex_face_impact(const Vec3& p_t0, const Vec3& p_t1, const std::array<Vec3, 3>& t_t0, const std::array<Vec3, 3>& t_t1,
                                         double min_distance = 0);
std::optional<double> edge_edge_impact(const std::array<Vec3, 2>& a_t0, const std::array<Vec3, 2>& a_t1, const std::array<Vec3, 2>& b_t0,
                                       const std::array<Vec3, 2>& b_t1, double min_distance = 0);

} // namespace sloper::collision
