#pragma once
/// A fit policy that knows the garment: what its fabric bears, and how it is worn where it comes
/// from.
#include <sloper/body/body.hpp>
#include <sloper/collision/body_collider.hpp>
#include <sloper/garment/fit/fit_policy.hpp>
#include <sloper/garment/fit/fit_report.hpp>
#include <sloper/garment/garment.hpp>

namespace sloper::garment {

/// Adds the rules of the fabric that most of the garment is of (elastic_fabric_rules) to what
/// Sloper says; a policy document goes before them.
void follow_fabric(const Garment& source, FitPolicy& policy);

/// Notes what the garment bears where it came to rest without the finding for stretched cloth
/// (Stretch::bound), so that it may bear as much again; and where that is this very body, the ease
/// of each girth there. Nothing for a garment that is not at rest, or has that finding.
/// @param body_sha256  of the skin of `body`
void follow_worn(const Garment& source, const body::Body& body, const collision::BodyCollider& skin,
                 const std::string& body_sha256, FitPolicy& policy);

/// "too_small_strain of policy woven, 8.0 %", or nothing.
std::string rule_text(const FitRule& rule, const std::string& policy);

/// "fits as far as is known: not if it was stretched ...", of a garment that fits and whose unknown
/// strain leaves the most doubt of that; else nothing.
std::string unknown_strain_text(const FitReport& fit);

} // namespace sloper::garment
