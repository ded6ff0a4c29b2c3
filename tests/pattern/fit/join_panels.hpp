#pragma once
/// Specifications made to look like CAD files: panels in one piece that were drawn in two.
#include <sloper/pattern/pattern.hpp>

namespace sloper::pattern::fit {

/// Joins halves of fronts, backs and skirts along their straight middle seams and the halves of
/// sleeves along the straight seam over the arm. Joined sleeves have their grain along that seam.
/// @param keep  called for each seam that could go; true leaves it
template<class Keep> Pattern joined(Pattern pattern, Keep keep);

namespace detail {
bool can_join(const Pattern& pattern, const Seam& seam);
void join(Pattern& pattern, std::size_t seam);
} // namespace detail

template<class Keep> Pattern joined(Pattern pattern, Keep keep) {
  for (std::size_t k = 0; k < pattern.seams.size();)
    if (detail::can_join(pattern, pattern.seams[k]) && !keep()) {
      detail::join(pattern, k);
      k = 0;
    } else
      ++k;
  return pattern;
}

} // namespace sloper::pattern::fit
