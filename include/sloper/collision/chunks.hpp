#pragma once
/// Partition of searches over many elements into chunks for threads: fixed borders, so
/// that the same input gives the same bytes.
#include <sloper/base/parallel.hpp>

#include <algorithm>
#include <cstddef>
#include <vector>

namespace sloper::collision {

inline constexpr std::size_t SEARCH_GRAIN = 512; ///< elements that one piece searches for

/// Pieces of SEARCH_GRAIN elements that n elements make.
inline std::size_t n_chunks(std::size_t n) {
  return (n + SEARCH_GRAIN - 1) / SEARCH_GRAIN;
}

/// Runs find(begin, end, out) over the pieces of [0, n), in parallel, and joins what they found in
/// the order of the pieces.
/// @param find appends Items to `out`; called from several threads at once
template<class Item, class Find> std::vector<Item> gather(std::size_t n, const Find& find) {
  std::vector<std::vector<Item>> found(n_chunks(n));
  parallel_for(n, SEARCH_GRAIN, [&](std::size_t begin, std::size_t end) {
    find(begin, end, found[begin / SEARCH_GRAIN]);
  });
  std::vector<Item> all;
  for (const auto& part : found)
    all.insert(all.end(), part.begin(), part.end());
  return all;
}

} // namespace sloper::collision
