#pragma once
/// How a draped garment fits the body it hangs on: ease, strain, gap and pressure per girth, and a verdict.
///
/// Trunk levels are cut level, without what hangs on the arms, as the body's own girths are; limb girths are cut square to the
/// limb. A garment's girth is the length of the line of cloth in the cut: `lying` as it hangs, `rest` as it would be
/// unstretched; ease = rest - body girth, so a garment that only goes on by stretching has negative ease. Contact pressure
/// is estimated by Laplace's law, tension / radius, with the fabric's stretch modulus and radius = body girth / 2 pi.
#include <body/body.hpp>
#include <collision/body_collider.hpp>
#include <garment/fit_policy.hpp>
#include <garment/garment.hpp>
#include <io/json.hpp>

namespace sloper::garment {

struct FitRow {
  std::string name;                    ///< "bust", "upper_arm_l", ...: as in the body document
  std::string kind;                    ///< "level" or "limb"
  double height_m = 0;                 ///< of the cut's centre
  double body_m = 0;                   ///< body girth
  double lying_m = 0, rest_m = 0;      ///< garment girth as it hangs and unstretched
  double ease_m = 0;                   ///< rest_m - body_m
  bool open = false;                   ///< the cloth does not go all the way round: the opening is bridged straight
  double strain_p99 = 0;               ///< of the edges within 2 cm of the cut
  double strain_girth = 0;             ///< lying_m / rest_m - 1: how far the girth as a whole is stretched
  std::string strain_direction;        ///< "warp", "weft" or "bias": of the edges beyond the 99th percentile
  double gap_p05_m = 0, gap_p50_m = 0; ///< cloth to skin, signed
  double pressure_p95_pa = 0;
  double body_uncertainty_m = 0, garment_uncertainty_m = 0, ease_uncertainty_m = 0;
  FitVerdict verdict = FitVerdict::OK;
  std::string reason; ///< of a verdict that is not OK
};

struct FitReport {
  std::vector<FitRow> rows;
  std::vector<std::pair<std::string, std::string>> left_out; ///< girth, why
  double hem_height_m = 0, top_height_m = 0;                 ///< lowest and highest point of the garment
  bool fits = true;
  FitVerdict verdict = FitVerdict::OK; ///< the worst row's
  std::string reason;                  ///< "does not close at the bust by 4.2 cm"
  std::string policy;                  ///< its name
};

/// @param garment draped on `body` and bound to it (bind_garment)
/// @throws Error INPUT when it is not bound
FitReport fit_garment(const Garment& garment, const body::Body& body, const collision::BodyCollider& skin, const FitPolicy& policy);

/// fit.json without its envelope's inputs.
io::Json fit_json(const FitReport& report, const std::string& tool);

} // namespace sloper::garment
