#pragma once
/// How a draped garment fits the body it hangs on: ease, strain, gap and pressure per
/// girth, hems, coverage, balance, a verdict.
///
/// Trunk levels are cut level, without cloth that hangs on the arms, as the body's own
/// girths are; limb girths are cut square to the limb. A garment's girth is the length of
/// the line of cloth in the cut: `lying` as it hangs, `rest` as it would be unstretched.
/// Ease = rest - body girth, so a garment that must stretch to be put on has negative
/// ease. Free edges (neck, sleeves, legs, the top of cloth that hangs from the waist) are
/// measured along themselves, against the skin in their plane. cloth_strain.hpp defines
/// strain and contact pressure.
///
/// Uncertainties: of the body's girth its spread, or of a level what the skin's girth changes
/// within the error of its height; of the garment's girth its change within the error of the
/// level's height, and the chord's shortfall against its arc; of strain its change when half the
/// band is taken; of the gap the sagitta of an edge; of pressure as of the strain. A garment that
/// was re-draped (Garment::redrapes) adds its standard deviations. A drape that did not come to
/// rest adds `convergence_m` to lengths and gaps, and its strain and slip decide nothing (only the
/// ease of its girths does), unless it was ended for them. Test: tests/garment/fit/test_fit.cpp
#include <sloper/body/body.hpp>
#include <sloper/collision/body_collider.hpp>
#include <sloper/garment/fit/fit_policy.hpp>
#include <sloper/garment/fit/fit_report.hpp>
#include <sloper/garment/garment.hpp>
#include <sloper/garment/simulate/request.hpp>
#include <sloper/io/json_fwd.hpp>

namespace sloper::garment {

/// What is known of a draped garment besides its cloth. All of it is optional.
struct FitHistory {
  /// Positions before the drape, #P by 3, m, from which the slip is measured.
  const std::vector<Vec3>* placed = nullptr;
  /// misfit_text(DrapeReport::misfit): where FitBounds ended the drape, strain and slip decide
  /// although it is not at rest, and the answer is no.
  std::string unfit = {};
  /// Garment::body_girths_m of the body it was cut for: a design that was cut wide is not too large
  /// for being wide, and one that was cut tight not too small for being tight
  /// (FitPolicy::too_large_ease, too_small_ease).
  std::map<std::string, double> made_for = {};
  /// Positions of the particles on the body that the garment comes from, #P by 3, m: a girth may be
  /// stretched as it was there (FitPolicy::too_small_strain).
  const std::vector<Vec3>* source = nullptr;
  /// How it hung there, at rest: where its hems ended (FitReport::lengths).
  const Bind* source_bind = nullptr;
  /// Ease on that body, m, by girth (Retargeted::source_ease_m), for FitRow::source_ease_m.
  std::map<std::string, double> source_ease_m = {};
};

/// Measures the fit of a draped garment and judges it by a policy.
/// @param garment  draped on `body` and bound to it (bind_garment)
/// @throws Error INPUT when the garment is not bound
FitReport fit_garment(const Garment& garment, const body::Body& body,
                      const collision::BodyCollider& skin, const FitPolicy& policy,
                      const FitHistory& history = {});

/// Bounds for a drape beyond which the garment will not fit by the policy: 1.1 times the
/// slip and 1.5 times the strain that the policy allows.
/// @param before  of fit_before_drape(), for the class, the fabric and the least ease
FitBounds early_termination_bounds(const FitPolicy& policy, const FitReport& before);

/// Refuses, before any drape, garments whose cloth does not reach round the body: by
/// girths, and by the top edge of cloth that hangs from the waist. A girth is refused in
/// either of two cases. Stretched as far as the policy allows, or as on the first body
/// where that is further (an elastic band), it closes around no level within 3 cm. Or,
/// unstretched, it is too small by the policy at every level within 6 cm, farther than
/// tight cloth slides. Only `fits`, `verdict`, `reason`, the refused rows and, where it
/// passes, a `margin_m` below zero for a tight girth, class, fabric and `slip_borne_m`
/// are set.
/// @param placed  on `body`, bound to any body
/// @param source_position  #P by 3, m: where it hung when it was at rest
FitReport fit_before_drape(const Garment& placed, const std::vector<Vec3>& source_position,
                           const body::Body& body, const FitPolicy& policy);

/// A report that says no without measuring.
/// @param reason  a sentence
/// @param policy  for its name
FitReport impossible_fit(const std::string& reason, const FitPolicy& policy);

/// fit.json without its envelope's inputs.
io::Json fit_json(const FitReport& report, const std::string& tool);
/// The rows as CSV (RFC 4180), one line per girth; first line names the columns with their units.
std::string fit_csv(const FitReport& report);
/// One HTML page without any other file: verdict, girths as a sortable table and as bars of ease,
/// regions, hems.
std::string fit_page(const FitReport& report, const std::string& garment, const std::string& body);

} // namespace sloper::garment
