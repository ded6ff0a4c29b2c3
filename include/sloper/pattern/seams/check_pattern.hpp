#pragma once
/// Defects of a pattern, found without meshing it.
/// Test: tests/pattern/seams/test_check.cpp
#include <sloper/io/json_fwd.hpp>
#include <sloper/pattern/pattern.hpp>

namespace sloper::pattern {

/// One finding, by rule and place.
struct PatternFinding {
  /// "error": it cannot be sewn, or not as intended; "warning": check it; "info".
  std::string severity;
  /// One of crossing-outline, sharp-spike, hole-outside, tiny-edge, wrong-unit,
  /// sewn-twice, length-mismatch, many-gathers, impossible-gather, notch-mismatch,
  /// face-to-back, unsewn-panel, open-seam, loose-part; half-sewn of half_sewn().
  std::string rule;
  std::string place; ///< panel and edge, or seam
  std::string fact;  ///< with centimetres
};

/// All findings, in pattern order: crossing outlines, holes outside of them, spikes below
/// 10 degrees, edges below 2 mm, a largest panel below 12 cm or above 12 m2, runs sewn
/// twice, sides of a seam that differ by more than 2 % and 3 mm without being a gather or
/// stating their ease, gathers of more than 4 to 1 and of more than 20 to 1, notches that
/// miss each other by more than 1 cm, sides sewn face to back, unsewn panels, several
/// panels and no seam at all, panels that are sewn to each other and not to the garment,
/// missing seams.
std::vector<PatternFinding> check_pattern(const Pattern& pattern);

/// The findings as a SARIF 2.1.0 log, places as logical locations in `file`.
io::Json findings_sarif(const std::vector<PatternFinding>& findings, const std::string& file,
                        const std::string& tool);

/// Whether a finding makes sewing impossible. Lengths that differ, a size of no person,
/// loose parts and missing seams do not.
bool forbids_sewing(const PatternFinding& finding);

/// Refuses a pattern that cannot be sewn.
/// @throws Error INPUT for the first finding that forbids sewing
void require_sewable(const Pattern& pattern, const std::string& file);

} // namespace sloper::pattern
