#pragma once
/// How a draped garment fits the body it hangs on: ease, strain, gap and pressure per girth, hems, coverage, balance, a verdict.
///
/// Trunk levels are cut level, without what hangs on the arms, as the body's own girths are; limb girths are cut square to the
/// limb. A garment's girth is the length of the line of cloth in the cut: `lying` as it hangs, `rest` as it would be
/// unstretched; ease = rest - body girth, so a garment that only goes on by stretching has negative ease. Free edges
/// (neck, sleeves, legs, the top of what hangs from the waist) are measured along themselves, against the skin in their plane. Strain and
/// contact pressure are those of cloth_strain.hpp.
/// Uncertainties: of the body's girth its spread, or what the next level tells of its slope; of the garment's the change within the error of the level's height
/// and the chord's shortfall against its arc; of strain the change when half the band is taken; of the gap the sagitta of an edge; of pressure as of the
/// strain. A drape that did not come to rest adds `convergence_m` to lengths and gaps, and its strain and slip decide nothing (only the ease of its girths
/// does), unless it was ended for them.
#include <body/body.hpp>
#include <collision/body_collider.hpp>
#include <garment/drape/drape.hpp>
#include <garment/fit/fit_lines.hpp>
#include <garment/fit/fit_policy.hpp>
#include <garment/garment.hpp>
#include <io/json_fwd.hpp>

#include <limits>

namespace sloper::garment {

struct FitRow {
  std::string name;                    ///< "bust", "upper_arm_l", ...: as in the body document, or a free edge: "neck_edge", "sleeve_hem_l", ...
  std::string kind;                    ///< "level", "limb", "neck" or "edge"
  double height_m = 0;                 ///< of the cut's centre
  double body_m = 0;                   ///< body girth
  double lying_m = 0, rest_m = 0;      ///< garment girth as it hangs and unstretched
  double ease_m = 0;                   ///< rest_m - body_m
  double bridged_m = 0;                ///< of the girth, where there is no trunk cloth: openings, under the arms
  bool open = false;                   ///< something is bridged
  double strain_p99 = 0;               ///< of the triangles within 2 cm of the cut, or along the edge
  double strain_girth = 0;             ///< lying_m / rest_m - 1: how far the girth as a whole is stretched
  std::string strain_direction;        ///< "warp" or "weft": of the triangles beyond the 99th percentile
  double gap_p05_m = 0, gap_p50_m = 0; ///< cloth to skin, signed
  double pressure_p95_pa = 0;
  double body_uncertainty_m = 0, garment_uncertainty_m = 0, ease_uncertainty_m = 0;
  double strain_uncertainty = 0, gap_uncertainty_m = 0, pressure_uncertainty_pa = 0;
  FitLimits limits;    ///< of the policy, for this girth
  double margin_m = 0; ///< ease to the nearer limit of "ok"; negative when it is not ok
  FitVerdict verdict = FitVerdict::OK;
  std::string reason; ///< of a verdict that is not OK
};

/// Strain over one region of the garment: where it is stretched though no girth says so (across the shoulders, over a sleeve).
struct FitRegion {
  std::string name; ///< "shoulders", "trunk", "left sleeve", "left leg", "skirt", "collar" (or a hood)
  int triangles = 0;
  double strain_p50 = 0, strain_p99 = 0, strain_max = 0;
  std::string strain_direction;
};

struct FitReport {
  std::string garment_class; ///< "top", "dress", "skirt", "trousers" or "whole"
  std::string fabric;        ///< name of the material of most of it
  std::vector<FitRow> rows;
  std::vector<FitRegion> regions;
  FitLines lines;                        ///< hems, coverage, balance
  double strain_p99 = 0, strain_max = 0; ///< over all cloth
  double slip_m = 0;                     ///< how far the garment as a whole sank from where it was placed
  /// Farther than this it falls off, m; what hangs from the waist does where its top edge is below the level of the hip, 10 cm down at least.
  double slip_borne_m = std::numeric_limits<double>::infinity();
  double margin_m = 0;                                       ///< least of the rows'
  std::string margin_at;                                     ///< its girth
  std::vector<std::pair<std::string, std::string>> left_out; ///< girth, why
  double hem_height_m = 0, top_height_m = 0;                 ///< lowest and highest point of the garment
  double below_soles_m = 0;                                  ///< how far it reaches below the feet; 0 where it does not
  double convergence_m = 0;                                  ///< how far it may still move: 0 at rest
  bool fits = true;
  FitVerdict verdict = FitVerdict::OK; ///< the worst of all
  std::string reason;                  ///< "closes at the bust only stretched by 4 %: it is 3.6 cm too small there"
  std::string policy;                  ///< its name
  std::string state;                   ///< of the cloth that was measured: "at rest", "not at rest", "placed" (not draped), "not placed" (not measured)
};

/// @param garment draped on `body` and bound to it (bind_garment)
/// @param placed  positions before the drape, #P, or nullptr: how far the garment slid is measured from them
/// @param made_for  Garment::body_girths_m of the body it was cut for, if known: what was cut wide is not too large for being wide, and what
///                 was cut tight not too small for being tight (see FitPolicy::too_large_ease, too_small_ease)
/// @param unfit  misfit_text(DrapeReport::misfit): where FitBounds ended the drape, strain and slip decide although it is not at rest, and the answer is no
/// @throws Error INPUT when it is not bound
FitReport fit_garment(const Garment& garment, const body::Body& body, const collision::BodyCollider& skin, const FitPolicy& policy,
                      const std::vector<Vec3>* placed = nullptr, const std::string& unfit = {}, const std::map<std::string, double>& made_for = {});

/// Bounds for a drape beyond which the garment will not fit by the policy: a tenth more slip and half as much strain again as it bears.
/// @param before  of fit_before_drape(), for the class, the fabric and the least ease
FitBounds hopeless_beyond(const FitPolicy& policy, const FitReport& before);

/// Whether a garment can go on at all, before any drape: only girths, and the top edge of what hangs from the waist, that the cloth does not
/// reach round. That is so where the girth is too small by the policy though the garment slides 6 cm up or down, which no tight cloth does, or, to
/// be told of less of the body, though it slides 3 cm and is stretched by all that the policy bears; and as far as it was stretched on the first body
/// where that is further (an elastic band). Only `fits`, `verdict`, `reason`, the refused rows and, where it may go on, a `margin_m`
/// below zero for a tight girth, class, fabric and `slip_borne_m` are told.
/// @param placed on `body`, bound to any body   @param source_position #P: where it hung when it was at rest
FitReport fit_before_drape(const Garment& placed, const std::vector<Vec3>& source_position, const body::Body& body, const FitPolicy& policy);

/// A report that says no for a reason that needs no measuring.
FitReport impossible_fit(const std::string& reason, const FitPolicy& policy);

/// fit.json without its envelope's inputs.
io::Json fit_json(const FitReport& report, const std::string& tool);
/// The rows as CSV (RFC 4180), one line per girth; first line names the columns with their units.
std::string fit_csv(const FitReport& report);
/// One HTML page without any other file: verdict, girths as a sortable table and as bars of ease, regions, hems.
std::string fit_page(const FitReport& report, const std::string& garment, const std::string& body);

} // namespace sloper::garment
