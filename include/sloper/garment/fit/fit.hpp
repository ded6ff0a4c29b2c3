#pragma once
/// How a draped garment fits the body it hangs on: ease, strain, gap and pressure per girth, hems,
/// coverage, balance, a verdict.
///
/// Trunk levels are cut level, without what hangs on the arms, as the body's own girths are; limb
/// girths are cut square to the limb. A garment's girth is the length of the line of cloth in the
/// cut: `lying` as it hangs, `rest` as it would be unstretched; ease = rest - body girth, so a
/// garment that only goes on by stretching has negative ease. Free edges (neck, sleeves, legs, the
/// top of what hangs from the waist) are measured along themselves, against the skin in their
/// plane. Strain and contact pressure are those of cloth_strain.hpp. Uncertainties: of the body's
/// girth its spread, or what the next level tells of its slope; of the garment's the change within
/// the error of the level's height and the chord's shortfall against its arc; of strain the change
/// when half the band is taken; of the gap the sagitta of an edge; of pressure as of the strain. A
/// garment that was draped again and again (Garment::redrapes) adds its standard deviations. A
/// drape that did not come to rest adds `convergence_m` to lengths and gaps, and its strain and
/// slip decide nothing (only the ease of its girths does), unless it was ended for them.
#include <sloper/body/body.hpp>
#include <sloper/collision/body_collider.hpp>
#include <sloper/garment/fit/fit_policy.hpp>
#include <sloper/garment/fit/fit_report.hpp>
#include <sloper/garment/garment.hpp>
#include <sloper/garment/simulate/request.hpp>
#include <sloper/io/json_fwd.hpp>

namespace sloper::garment {

/// @param garment draped on `body` and bound to it (bind_garment)
/// @param placed  positions before the drape, #P, or nullptr: how far the garment slid is measured
/// from them
/// @param made_for  Garment::body_girths_m of the body it was cut for, if known: what was cut wide
/// is not too large for being wide, and what
///                 was cut tight not too small for being tight (see FitPolicy::too_large_ease,
///                 too_small_ease)
/// @param unfit  misfit_text(DrapeReport::misfit): where FitBounds ended the drape, strain and slip
/// decide although it is not at rest, and the answer is no
/// @throws Error INPUT when it is not bound
FitReport fit_garment(const Garment& garment, const body::Body& body,
                      const collision::BodyCollider& skin, const FitPolicy& policy,
                      const std::vector<Vec3>* placed = nullptr, const std::string& unfit = {},
                      const std::map<std::string, double>& made_for = {});

/// Bounds for a drape beyond which the garment will not fit by the policy: a tenth more slip and
/// half as much strain again as it bears.
/// @param before  of fit_before_drape(), for the class, the fabric and the least ease
FitBounds early_termination_bounds(const FitPolicy& policy, const FitReport& before);

/// Whether a garment can go on at all, before any drape: only girths, and the top edge of what
/// hangs from the waist, that the cloth does not reach round. That is so where the girth is too
/// small by the policy though the garment slides 6 cm up or down, which no tight cloth does, or, to
/// be told of less of the body, though it slides 3 cm and is stretched by all that the policy
/// bears; and as far as it was stretched on the first body where that is further (an elastic band).
/// Only `fits`, `verdict`, `reason`, the refused rows and, where it may go on, a `margin_m` below
/// zero for a tight girth, class, fabric and `slip_borne_m` are told.
/// @param placed on `body`, bound to any body   @param source_position #P: where it hung when it
/// was at rest
FitReport fit_before_drape(const Garment& placed, const std::vector<Vec3>& source_position,
                           const body::Body& body, const FitPolicy& policy);

/// A report that says no for a reason that needs no measuring.
FitReport impossible_fit(const std::string& reason, const FitPolicy& policy);

/// fit.json without its envelope's inputs.
io::Json fit_json(const FitReport& report, const std::string& tool);
/// The rows as CSV (RFC 4180), one line per girth; first line names the columns with their units.
std::string fit_csv(const FitReport& report);
/// One HTML page without any other file: verdict, girths as a sortable table and as bars of ease,
/// regions, hems.
std::string fit_page(const FitReport& report, const std::string& garment, const std::string& body);

} // namespace sloper::garment
