#pragma once
/// What is measured of a garment's fit: rows by girth, regions, free edges, the verdict.
/// fit.hpp defines the measures; fit.json(5) describes the document.
#include <sloper/base/message.hpp>
#include <sloper/garment/fit/fit_lines.hpp>
#include <sloper/garment/fit/fit_policy.hpp>

#include <limits>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace sloper::garment {

/// The limit of the policy that decided a verdict.
struct FitRule {
  std::string key;  ///< in the document: "too_small_ease", "strain_p99", ...; empty: none did
  double limit = 0; ///< a ratio
};

/// How likely it is that a garment fits, and the bound that leaves the most doubt.
struct FitProbability {
  double fits = 1;   ///< 0..1: that the policy would accept it on the person as they are
  std::string girth; ///< of that bound; empty: of the whole garment
  std::string rule; ///< FitRule::key of that bound, or "strain_unknown"; empty: none leaves a doubt
};

/// One girth of the body, or one free edge, and the cloth around it.
struct FitRow {
  /// "bust", "upper_arm_l", ...: as in the body document, or a free edge: "neck_edge",
  /// "sleeve_hem_l", ...
  std::string name;
  std::string kind;               ///< "level", "limb", "neck" or "edge"
  double height_m = 0;            ///< of the cut's centre
  double body_m = 0;              ///< body girth
  double lying_m = 0, rest_m = 0; ///< garment girth as it hangs and unstretched
  double ease_m = 0;              ///< rest_m - body_m; lying_m - body_m where it is gathered
  bool gathered = false;  ///< pressed together as a whole, by gathers that a narrower piece holds:
                          ///< it opens no further than it lies
  double worn_strain = 0; ///< strain_girth of the same line on the body that the garment comes from
  /// Ease of the same cloth on the body that the garment comes from; nothing where it hung loose
  /// or is not known.
  std::optional<double> source_ease_m = {};
  /// Ease that it was cut with, as a share of the girth of the body that it was cut for; nothing
  /// where that body is not known.
  std::optional<double> cut_ease = {};
  double bridged_m = 0;  ///< of the girth, where there is no trunk cloth: openings, under the arms
  bool open = false;     ///< something is bridged
  double strain_p99 = 0; ///< of the triangles within 2 cm of the cut, or along the edge
  double strain_girth = 0;      ///< lying_m / rest_m - 1: how far the girth as a whole is stretched
  std::string strain_direction; ///< "warp" or "weft": of the triangles beyond the 99th percentile
  double gap_p05_m = 0, gap_p50_m = 0; ///< cloth to skin, signed
  double pressure_p95_pa = 0;          ///< 95th percentile of contact pressure near the cut
  /// Uncertainties of the body's girth, the garment's and the ease (fit.hpp).
  double body_uncertainty_m = 0, garment_uncertainty_m = 0, ease_uncertainty_m = 0;
  /// The same of strain, gap and pressure.
  double strain_uncertainty = 0, gap_uncertainty_m = 0, pressure_uncertainty_pa = 0;
  double short_m = 0;  ///< refused before any drape: what the cloth lacks to be let through, m
  FitLimits limits;    ///< of the policy, for this girth
  double margin_m = 0; ///< ease to the nearer limit of "ok"; negative when it is not ok
  FitVerdict verdict = FitVerdict::OK; ///< of this girth alone
  std::string reason;                  ///< of a verdict that is not OK
  FitRule rule;                        ///< that decided it
};

/// Strain over one region of the garment: where it is stretched though no girth says so (across the
/// shoulders, over a sleeve).
struct FitRegion {
  /// "shoulders", "trunk", "left sleeve", "left leg", "skirt", "collar" (or a hood)
  std::string name;
  int triangles = 0;                                     ///< of the garment in this region
  double strain_p50 = 0, strain_p99 = 0, strain_max = 0; ///< quantiles by area, l/l0 - 1
  std::string strain_direction;                          ///< as FitRow::strain_direction
};

/// The whole report of one garment on one body.
struct FitReport {
  std::string garment_class;      ///< "top", "dress", "skirt", "trousers" or "whole"
  std::string fabric;             ///< name of the material of most of it
  std::vector<FitRow> rows;       ///< one per girth that could be measured
  std::vector<FitRegion> regions; ///< one per region that has cloth
  FitLines lines;                 ///< hems, coverage, balance
  /// Where hems, sleeves and legs end; of cloth that was draped.
  std::vector<FitLength> lengths;
  /// What was found on the pattern and its panels (PanelMesh::findings), and in this run.
  std::vector<Message> findings;
  std::string mode;                      ///< of the retargeting, "keep-fabric"; empty: none
  double strain_p99 = 0, strain_max = 0; ///< over all cloth
  double slip_m = 0; ///< how far the garment as a whole sank from where it was placed
  /// Farther than this it falls off, m; what hangs from the waist does where its top edge is below
  /// the level of the hip, 10 cm down at least.
  double slip_borne_m = std::numeric_limits<double>::infinity();
  double margin_m = 0;                                       ///< least of the rows'
  std::string margin_at;                                     ///< its girth
  std::vector<std::pair<std::string, std::string>> left_out; ///< girth, why
  double hem_height_m = 0, top_height_m = 0; ///< lowest and highest point of the garment
  double below_soles_m = 0;    ///< how far it reaches below the feet; 0 where it does not
  double convergence_m = 0;    ///< how far it may still move: 0 at rest
  bool fits = true;            ///< whether the policy accepts it
  FitProbability probability;  ///< that it fits (docs/fit-probability.md)
  bool strain_unknown = false; ///< Garment::strain_unknown
  /// Of a garment whose strain is unknown: strain that it may have had on the body that it was worn
  /// on and still fit here; none: nothing lay close to that body.
  std::optional<double> bears;
  std::string bears_at;                ///< girth of that strain; empty: of all cloth
  FitVerdict verdict = FitVerdict::OK; ///< the worst of all
  std::string reason; ///< "closes at the bust only stretched by 4 %: it is 3.6 cm too small there"
  FitRule rule;       ///< that gave the verdict
  std::string policy; ///< its name
  /// Of the cloth that was measured: "at rest", "not at rest", "placed" (not draped),
  /// "not placed" (not measured)
  std::string state;

  /// Whether strain, gap, pressure and slip were measured: those of cloth that was only placed, or
  /// refused before any drape, are 0 and say nothing.
  bool was_draped() const { return state == "at rest" || state == "not at rest"; }
};

} // namespace sloper::garment
