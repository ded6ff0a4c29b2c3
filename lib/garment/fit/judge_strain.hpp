#pragma once
/// The verdict of a fit report by the strain of its cloth.
/// Test: tests/garment/fit/test_fit.cpp
#include <sloper/garment/fit/fit_policy.hpp>
#include <sloper/garment/fit/fit_report.hpp>

namespace sloper::garment {

/// Makes a garment too small whose cloth is stretched beyond what the policy lets its fabric bear
/// (strain_p99, strain_max). The reason names the region, and the girth where cloth is stretched
/// most; rows beyond strain_p99 that were "ok" or "tight" by their ease are too small with it. A
/// report that is too small already stays as it is.
void judge_strain(const FitPolicy& policy, FitReport& report);

} // namespace sloper::garment
