#pragma once
/// What counts as fitting: thresholds per girth, garment class and fabric, from a document that
/// people write.
#include <limits>
#include <map>
#include <optional>
#include <string>

namespace sloper::garment {

inline constexpr int FIT_POLICY_VERSION = 1;

enum class FitVerdict {
  OK,
  LOOSE,
  TIGHT,
  TOO_LARGE,
  TOO_SMALL,
  IMPOSSIBLE
}; ///< from good to worst
const char* verdict_name(
    FitVerdict verdict); ///< "ok", "loose", "tight", "too large", "too small", "impossible"

struct FitLimits {
  double too_small_ease = -0.03; ///< of the body girth: below, the cloth does not go round
  double too_small_strain =
      0.08;                 ///< girth stretched further than this does not hold, whatever the ease
  double tight_ease = 0.01; ///< of the body girth: below, it is tight
  double loose_ease = 0.50; ///< of the body girth: above, it is loose
  double too_large_ease =
      std::numeric_limits<double>::infinity(); ///< of the body girth: above, it is another size;
                                               ///< infinite: there is no such limit
};

/// Limits of which some are said.
struct FitOverride {
  std::optional<double> too_small_ease, too_small_strain, tight_ease, loose_ease, too_large_ease;
  void apply(FitLimits& limits) const;
};

/// What a policy says for all garments, for a class of garments, or for a fabric.
struct FitRules {
  FitOverride standard;
  std::map<std::string, FitOverride> girths;
  std::optional<double> strain_p99, strain_max, slip_m;
};

/// Rules for all garments, and those that go before them.
struct FitRuleSet {
  FitRules all;
  std::map<std::string, FitRules> classes, fabrics;
};

/// policy.json: {"format": "fit-policy", "version": 1, "name", "refuse": ["too small", ...], RULES,
/// "classes": {CLASS: {RULES}}, "fabrics": {MATERIAL: {RULES}}}; RULES: "default": {limits},
/// "girths": {NAME: {limits}}, "strain_p99", "strain_max", "slip_m". NAME is a girth or level of
/// the body document, without _l or _r; CLASS is top, dress, skirt, trousers or whole. What is said
/// for a fabric goes before a class, a class before all garments, a girth before the default; all
/// of it before the standard policy's. Unknown keys are errors.
struct FitPolicy {
  std::string name = "woven";
  FitRuleSet standard, own;          ///< what Sloper says, and what the document says
  double worn_p99 = 0, worn_max = 0; ///< strain of a garment on the body that it comes from, or 0:
                                     ///< a tenth more is borne on another
  bool refuse_loose = false,
       refuse_tight = false; ///< "too small" and "too large" are always refused

  FitLimits limits(const std::string& girth, const std::string& garment_class = {},
                   const std::string& fabric = {}) const;
  /// too_large_ease of `limits` (of limits()) for a garment that was cut with `designed` ease, a
  /// share of the girth of the body it was cut for: where that is more, the ease that the design
  /// has on a body whose girth goes into that of the other 1 plus half of that limit times. A limit
  /// that the document says holds.
  double too_large_ease(const FitLimits& limits, double designed, const std::string& girth,
                        const std::string& garment_class, const std::string& fabric) const;
  /// too_small_ease of `limits` for a garment that is worn with `designed` ease: where that is
  /// less, a hundredth less than that. A limit that the document says holds, and any where worn_p99
  /// is 0.
  double too_small_ease(const FitLimits& limits, double designed, const std::string& girth,
                        const std::string& garment_class, const std::string& fabric) const;
  double
  strain_p99(const std::string& garment_class,
             const std::string& fabric) const; ///< of all edges: stretched further, it does not fit
  double strain_max(const std::string& garment_class,
                    const std::string& fabric) const; ///< of any edge
  /// m that it may sink before it counts as falling off; infinite: as far as the hip holds it
  double slip_m(const std::string& garment_class, const std::string& fabric) const;
};

/// For woven cloth that gives little. Loose and too large are by class: what hangs from the waist
/// must hold there, what hangs from the shoulders may stand off; skirts flare. The figures are in
/// the man page.
FitPolicy standard_fit_policy();
FitPolicy read_fit_policy(const std::string& path); ///< @throws Error INPUT

} // namespace sloper::garment
