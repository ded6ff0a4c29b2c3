#pragma once
/// The potential of a near pair of elements, of skin and cloth or of cloth and cloth,
/// over their distance d:
///   E = k (r - d)^3 / (6 r)   for d < r, the activation distance,
///     + BARRIER_STIFFNESS k / 2 (F(b) - F(d)), F(d) = b^2 ln d - 2 b d + d^2 / 2,
///       for d < b = BARRIER_BEGINS r.
/// Force and stiffness grow from 0 at the activation distance, so that pairs that appear
/// and vanish do not kick; a Newton step from the deep side does not overshoot; and as d
/// -> 0 the barrier grows without bound, so that cloth in a pinch finds a place between
/// both walls (a logarithmic barrier as in Li et al. 2020, "Incremental Potential
/// Contact"). Test: tests/cloth/contact/test_contact.cpp
#include <algorithm>
#include <cmath>

namespace sloper::cloth {

/// Response of one pair, along the direction between its closest points; force and
/// stiffness are >= 0.
struct ContactResponse {
  double force = 0, stiffness = 0, energy = 0; ///< N, N/m, J
};

/// b / r, and the stiffness of the barrier over k.
inline constexpr double BARRIER_BEGINS = 0.3, BARRIER_STIFFNESS = 20;
/// Share of the activation distance below which the barrier does not grow any more; no
/// step brings elements nearer than that.
inline constexpr double LEAST_DISTANCE = 1e-4;

/// Evaluates the potential.
/// @param d  distance, m, >= 0
/// @param reach  activation distance r, m
/// @param k  N/m
inline ContactResponse evaluate_contact_potential(double d, double reach, double k) {
  ContactResponse p;
  if (d >= reach)
    return p;
  const double depth = reach - d, begins = BARRIER_BEGINS * reach;
  p.energy = k * depth * depth * depth / (6 * reach);
  p.force = 0.5 * k * depth * depth / reach;
  p.stiffness = k * depth / reach;
  if (d >= begins)
    return p;
  const double kb = BARRIER_STIFFNESS * k, e = std::max(d, LEAST_DISTANCE * reach);
  p.energy += 0.5 * kb *
              (begins * begins * std::log(begins / e) - 2 * begins * (begins - e) +
               0.5 * (begins * begins - e * e));
  p.force += 0.5 * kb * (begins - e) * (begins - e) / e;
  p.stiffness += 0.5 * kb * (begins * begins - e * e) / (e * e);
  return p;
}

} // namespace sloper::cloth
