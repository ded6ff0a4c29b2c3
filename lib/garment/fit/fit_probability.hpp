#pragma once
/// How likely it is that a garment fits, from the uncertainties of body and drape.
///
/// Each bound of the policy is a quantity q with a limit L and a standard deviation s, and holds
/// with the probability F((L - q) / s), F being Student's distribution with two degrees of
/// freedom. The bounds that say "too small" all follow from the same
/// girths, and so do those that say "too large": of each kind the least likely bound counts, and as
/// cloth is not both, their doubts add up. Calibration: docs/fit-probability.md.
///
/// Where the rest shape of a garment is that of a mesh as it was worn (Garment::strain_unknown),
/// cloth that lay close to its first body may have been stretched there by e, and its rest girth is
/// 1 / (1 + e) of what it seems; e is taken as half-normal (FitPolicy::strain_p99 its deviation).
/// Test: tests/garment/fit/test_fit_probability.cpp
#include <map>
#include <sloper/garment/fit/fit_policy.hpp>
#include <sloper/garment/fit/fit_report.hpp>
#include <string>

namespace sloper::garment {

/// Sets `probability` of a report that is otherwise whole, and of one whose strain is unknown
/// `bears`: the strain that its girths which lay close to the first body may have had there. The
/// probability is at least a half where the garment fits and its strain is known, at most a half
/// where it does not.
/// @param worn_on  girths of the body that the garment comes from, by name, m
/// @param strain_counts  the cloth is at rest, or was ended for its strain or its slip
void take_probability(const FitPolicy& policy, const std::map<std::string, double>& worn_on,
                      bool strain_counts, FitReport& report);

} // namespace sloper::garment
