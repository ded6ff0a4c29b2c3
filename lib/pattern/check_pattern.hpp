#pragma once
/// What is wrong with a pattern, found without meshing it.
#include <pattern/pattern.hpp>

namespace sloper::pattern {

struct PatternFinding {
  std::string severity; ///< "error": it cannot be sewn as drawn; "warning": look at it; "info"
  std::string rule;     ///< crossing-outline, sharp-spike, sewn-twice, length-mismatch, face-to-back, unsewn-panel, small-panel
  std::string place;    ///< panel and edge, or seam
  std::string fact;     ///< with centimetres
};

/// Crossing outlines, spikes below 10 degrees, runs sewn twice, sides of a seam that differ by more than 2 % and 3 mm without
/// being a gather or stating their ease, sides sewn face to back, panels that nothing is sewn to. In pattern order.
std::vector<PatternFinding> check_pattern(const Pattern& pattern);

/// @throws Error INPUT for the first finding of severity "error"
void require_sewable(const Pattern& pattern, const std::string& file);

} // namespace sloper::pattern
