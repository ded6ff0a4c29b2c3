#pragma once
/// Sections of a limb, square to its axis, as support functions: the furthest skin in each
/// direction, m from the origin of the plane. Direction k of RING_ANGLES is turned by 2 pi k /
/// RING_ANGLES from (0, 1) towards (1, 0).
#include <sloper/geometry/types.hpp>

#include <algorithm>
#include <array>
#include <vector>

namespace sloper::pattern {

inline constexpr int RING_ANGLES = 180;
using Ring = std::array<double, RING_ANGLES>;

Vec2 direction(int k);
/// A section without skin; include() adds to it.
Ring empty_ring();
void include(Ring& ring, const Vec2& p);

/// Rows without skin take their neighbour's.
std::vector<Ring> filled(std::vector<Ring> rows);
/// Each row around all rows within `reach` of it.
std::vector<Ring> joined(const std::vector<Ring>& rows, int reach);
/// Weighted mean over the rows within `reach`.
std::vector<Ring> smooth(const std::vector<Ring>& rows, int reach);
/// Radius of the convex outline, grown by so much, in each direction from a centre inside it.
Ring radii(const Ring& support, const Vec2& center, double grown);

/// Weighted mean with the neighbours up to `reach` to both sides; the ends repeat.
template<class T> std::vector<T> averaged(const std::vector<T>& in, int reach) {
  std::vector<T> out = in;
  const int n = std::ssize(in);
  for (int k = 0; k < n; ++k) {
    T sum = in[0] * 0.0;
    double weight = 0;
    for (int o = -reach; o <= reach; ++o) {
      const double w = 1 + reach - std::abs(o);
      sum = sum + w * in[std::clamp(k + o, 0, n - 1)];
      weight += w;
    }
    out[k] = sum * (1 / weight);
  }
  return out;
}
/// Least of the neighbours up to `reach` to both sides.
std::vector<double> least(const std::vector<double>& in, int reach);

} // namespace sloper::pattern
