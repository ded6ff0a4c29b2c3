#pragma once
/// What is found out about how a garment fits: rows by girth, regions, free edges, the verdict.
/// fit.hpp says how it is measured.
#include <sloper/garment/fit/fit_lines.hpp>
#include <sloper/garment/fit/fit_policy.hpp>

#include <limits>
#include <string>
#include <utility>
#include <vector>

namespace sloper::garment {

struct FitRow {
  std::string name;    ///< "bust", "upper_arm_l", ...: as in the body document, or a free edge:
                       ///< "neck_edge", "sleeve_hem_l", ...
  std::string kind;    ///< "level", "limb", "neck" or "edge"
  double height_m = 0; ///< of the cut's centre
  double body_m = 0;   ///< body girth
  double lying_m = 0, rest_m = 0; ///< garment girth as it hangs and unstretched
  double ease_m = 0;              ///< rest_m - body_m
  double bridged_m = 0;  ///< of the girth, where there is no trunk cloth: openings, under the arms
  bool open = false;     ///< something is bridged
  double strain_p99 = 0; ///< of the triangles within 2 cm of the cut, or along the edge
  double strain_girth = 0;      ///< lying_m / rest_m - 1: how far the girth as a whole is stretched
  std::string strain_direction; ///< "warp" or "weft": of the triangles beyond the 99th percentile
  double gap_p05_m = 0, gap_p50_m = 0; ///< cloth to skin, signed
  double pressure_p95_pa = 0;
  double body_uncertainty_m = 0, garment_uncertainty_m = 0, ease_uncertainty_m = 0;
  double strain_uncertainty = 0, gap_uncertainty_m = 0, pressure_uncertainty_pa = 0;
  FitLimits limits;    ///< of the policy, for this girth
  double margin_m = 0; ///< ease to the nearer limit of "ok"; negative when it is not ok
  FitVerdict verdict = FitVerdict::OK;
  std::string reason; ///< of a verdict that is not OK
};

/// Strain over one region of the garment: where it is stretched though no girth says so (across the
/// shoulders, over a sleeve).
struct FitRegion {
  std::string
      name; ///< "shoulders", "trunk", "left sleeve", "left leg", "skirt", "collar" (or a hood)
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
  double slip_m = 0; ///< how far the garment as a whole sank from where it was placed
  /// Farther than this it falls off, m; what hangs from the waist does where its top edge is below
  /// the level of the hip, 10 cm down at least.
  double slip_borne_m = std::numeric_limits<double>::infinity();
  double margin_m = 0;                                       ///< least of the rows'
  std::string margin_at;                                     ///< its girth
  std::vector<std::pair<std::string, std::string>> left_out; ///< girth, why
  double hem_height_m = 0, top_height_m = 0; ///< lowest and highest point of the garment
  double below_soles_m = 0; ///< how far it reaches below the feet; 0 where it does not
  double convergence_m = 0; ///< how far it may still move: 0 at rest
  bool fits = true;
  FitVerdict verdict = FitVerdict::OK; ///< the worst of all
  std::string reason; ///< "closes at the bust only stretched by 4 %: it is 3.6 cm too small there"
  std::string policy; ///< its name
  std::string state;  ///< of the cloth that was measured: "at rest", "not at rest", "placed" (not
                      ///< draped), "not placed" (not measured)
};

} // namespace sloper::garment
