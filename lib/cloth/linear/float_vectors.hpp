#pragma once
/// Vectors of single precision, one Float4 a particle, the fourth lane unused and 0.
#include <sloper/base/parallel.hpp>
#include <sloper/base/simd4.hpp>
#include <sloper/cloth/linear/block_matrix.hpp>

#include <algorithm>

namespace sloper::cloth {

/// a . b over [begin, end), a chunk of parallel_for. Eight products are summed in single precision
/// at a time.
inline double dot(const std::vector<Float4>& a, const std::vector<Float4>& b, std::size_t begin,
                  std::size_t end) {
  double sum[3] = {};
  for (std::size_t first = begin; first < end; first += 8) {
    Float4 some = Float4::all(0);
    for (std::size_t i = first; i < std::min(first + 8, end); ++i)
      some = some + a[i] * b[i];
    alignas(16) float lane[4];
    some.store(lane);
    for (int k = 0; k < 3; ++k)
      sum[k] += lane[k];
  }
  return sum[0] + sum[1] + sum[2];
}

/// a . b; the same bits for any number of threads. @param part  work
inline double dot(const std::vector<Float4>& a, const std::vector<Float4>& b,
                  std::vector<double>& part) {
  return parallel_sum(a.size(), ROW_GRAIN, part,
                      [&](std::size_t begin, std::size_t end) { return dot(a, b, begin, end); });
}

} // namespace sloper::cloth
