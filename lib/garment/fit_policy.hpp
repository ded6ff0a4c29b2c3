#pragma once
/// What counts as fitting: thresholds per girth, from a document that people write.
#include <map>
#include <string>

namespace sloper::garment {

inline constexpr int FIT_POLICY_VERSION = 1;

enum class FitVerdict { OK, LOOSE, TIGHT, TOO_SMALL }; ///< from good to worst
const char* verdict_name(FitVerdict verdict);          ///< "ok", "loose", "tight", "too small"

struct FitLimits {
  double too_small_ease = -0.03;  ///< of the body girth: below, the cloth does not go round
  double too_small_strain = 0.08; ///< girth stretched further than this does not hold, whatever the ease
  double tight_ease = 0.01;       ///< of the body girth: below, it is tight
  double loose_ease = 0.50;       ///< of the body girth: above, it is loose
};

/// policy.json: {"format": "fit-policy", "version": 1, "name", "refuse": ["too small", ...], "default": {limits},
/// "girths": {NAME: {limits}}}; NAME is a girth or level of the body document, without _l or _r. Unknown keys are errors.
struct FitPolicy {
  std::string name = "woven";
  FitLimits standard;
  std::map<std::string, FitLimits> girths;
  bool refuse_loose = false, refuse_tight = false; ///< "too small" is always refused
  const FitLimits& limits(const std::string& girth) const;
};

/// For woven cloth that gives little; skirts and sleeves may be loose.
FitPolicy standard_fit_policy();
FitPolicy read_fit_policy(const std::string& path); ///< @throws Error INPUT

} // namespace sloper::garment
