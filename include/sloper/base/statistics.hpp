#pragma once
/// Order statistics of values that are all there. Each puts its values in another order; none may
/// be asked of nothing.
///
/// There are two conventions, and results depend on which is used: a quantile is taken at the place
/// floor(q (n - 1)), so that the median of an even number is the lower of the two in the middle;
/// upper_median() takes the place floor(n / 2), the upper of them.
/// Test: tests/base/test_statistics.cpp
#include <algorithm>
#include <cstddef>
#include <vector>

namespace sloper {

/// Puts the value of a rank (0 is the least) in its place, smaller ones before it and larger ones
/// behind. @returns its place
/// @param values  not empty; reordered
template<class T>
typename std::vector<T>::iterator place_rank(std::vector<T>& values, std::size_t rank) {
  const auto at = values.begin() + static_cast<std::ptrdiff_t>(rank);
  std::nth_element(values.begin(), at, values.end());
  return at;
}

/// The rank floor(q (n - 1)) of a quantile among n values. @param q 0..1
inline std::size_t quantile_rank(std::size_t n, double q) {
  return static_cast<std::size_t>(q * static_cast<double>(n - 1));
}

/// The largest value with at most the share q of the others below it, without interpolation. @param
/// q 0..1
/// @param values  not empty; reordered
template<class T> T lower_quantile(std::vector<T>& values, double q) {
  return *place_rank(values, quantile_rank(values.size(), q));
}

/// The median; of an even number of values the upper of the two in the middle.
template<class T> T upper_median(std::vector<T>& values) {
  return *place_rank(values, values.size() / 2);
}

} // namespace sloper
