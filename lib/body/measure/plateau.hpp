#pragma once
/// The centre of a flat minimum: the weighted mean of all samples within `flat` of the lowest. The
/// single lowest sample of a flat curve is unstable.
#include <sloper/geometry/types.hpp>
#include <vector>
namespace sloper::body {

/// A flat minimum.
struct Lowest {
  double middle; ///< weighted mean of the places around `least` whose value is less than `flat`
                 ///< above its own, the lower the heavier
  double least;  ///< the place of the lowest sample: at an end of the search there is no valley
};

/// @param curve (place, value) in the order of their places, not empty; @param flat how much higher
/// still counts, > 0
inline Lowest lowest_of(const std::vector<Vec2>& curve, double flat) {
  std::size_t least = 0;
  for (std::size_t k = 1; k < curve.size(); ++k)
    if (curve[k].y() < curve[least].y())
      least = k;
  double sum = 0, weight = 0;
  auto add = [&](std::size_t k) {
    const double w = curve[least].y() + flat - curve[k].y();
    if (w > 0) {
      sum += w * curve[k].x();
      weight += w;
    }
    return w > 0;
  };
  for (std::size_t k = least; k < curve.size() && add(k); ++k) {}
  for (std::size_t k = least; k > 0 && add(k - 1); --k) {}
  return {sum / weight, curve[least].x()};
}

} // namespace sloper::body
