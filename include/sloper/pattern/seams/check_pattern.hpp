#pragma once
/// What is wrong with a pattern, found without meshing it.
#include <sloper/io/json_fwd.hpp>
#include <sloper/pattern/pattern.hpp>

namespace sloper::pattern {

struct PatternFinding {
  std::string severity; ///< "error": it cannot be sewn, or not to what it was meant to be;
                        ///< "warning": look at it; "info"
  std::string rule;     ///< crossing-outline, sharp-spike, hole-outside, tiny-edge, wrong-unit,
                        ///< sewn-twice, length-mismatch, many-gathers, impossible-gather,
                        ///< notch-mismatch, face-to-back, unsewn-panel, open-seam
  std::string place;    ///< panel and edge, or seam
  std::string fact;     ///< with centimetres
};

/// Crossing outlines, holes outside of them, spikes below 10 degrees, edges below 2 mm, a largest
/// panel below 12 cm or above 12 m2, runs sewn twice, sides of a seam that differ by more than 2 %
/// and 3 mm without being a gather or stating their ease, gathers of more than 4 to 1, of more than
/// 20 to 1, notches that miss each other by more than 1 cm, sides sewn face to back, panels that
/// nothing is sewn to, several panels and no seam at all, seams that are missing (see
/// missing_seams.hpp). In pattern order.
std::vector<PatternFinding> check_pattern(const Pattern& pattern);

/// The findings as a SARIF 2.1.0 log, places as logical locations in `file`.
io::Json findings_sarif(const std::vector<PatternFinding>& findings, const std::string& file,
                        const std::string& tool);

/// Whether it cannot be sewn at all. Lengths that differ, a size of no person and missing seams
/// can.
bool forbids_sewing(const PatternFinding& finding);

/// @throws Error INPUT for the first finding that forbids sewing
void require_sewable(const Pattern& pattern, const std::string& file);

} // namespace sloper::pattern
