#pragma once
/// What counts as fitting: thresholds per girth, garment class and fabric, from a document that
/// people write.
#include <limits>
#include <map>
#include <optional>
#include <sloper/base/message.hpp>
#include <string>
#include <vector>

namespace sloper::garment {

struct Garment;

/// Version of the policy document that is read.
inline constexpr int FIT_POLICY_VERSION = 1;

/// Verdict on a girth or on the garment, from good to worst.
enum class FitVerdict { OK, LOOSE, TIGHT, TOO_LARGE, TOO_SMALL, IMPOSSIBLE };
/// "ok", "loose", "tight", "too large", "too small", "impossible".
const char* verdict_name(FitVerdict verdict);

/// Thresholds of one girth. Ease is a ratio to the body girth, strain l/l0 - 1.
struct FitLimits {
  double too_small_ease = -0.03; ///< of the body girth: below, the cloth does not go round
  /// Girth stretched further than this does not hold, whatever the ease.
  double too_small_strain = 0.08;
  double tight_ease = 0.01; ///< of the body girth: below, it is tight
  double loose_ease = 0.50; ///< of the body girth: above, it is loose
  /// Of the body girth: above, it is another size; infinite: there is no such limit.
  double too_large_ease = std::numeric_limits<double>::infinity();
};

/// Limits of which some are given.
struct FitOverride {
  /// As in FitLimits; empty: not given.
  std::optional<double> too_small_ease, too_small_strain, tight_ease, loose_ease, too_large_ease;
  /// Replaces those of `limits` that are given here.
  void apply(FitLimits& limits) const;
};

/// Rules of a policy for all garments, for a class of garments, or for a fabric.
struct FitRules {
  FitOverride standard;                      ///< for girths that `girths` does not name
  std::map<std::string, FitOverride> girths; ///< by girth or level, without _l or _r
  /// Limits of the cloth's strain and of the slip, m; FitPolicy has the meaning.
  std::optional<double> strain_p99, strain_max, slip_m;
};

/// Rules for all garments, and those that take precedence over them.
struct FitRuleSet {
  FitRules all; ///< for every garment
  /// By garment class; by material name.
  std::map<std::string, FitRules> classes, fabrics;
};

/// policy.json: {"format": "fit-policy", "version": 1, "name", "refuse": ["too small",
/// ...], RULES, "classes": {CLASS: {RULES}}, "fabrics": {MATERIAL: {RULES}}}; RULES:
/// "default": {limits}, "girths": {NAME: {limits}}, "strain_p99", "strain_max", "slip_m".
/// NAME is a row of the fit report, of a limb without _l or _r for both sides; CLASS is top, dress,
/// skirt, trousers or whole. A fabric takes precedence over a class, a class over all
/// garments, a girth over the default, and the document over the standard policy. Unknown
/// keys are errors.
struct FitPolicy {
  std::string name = "woven"; ///< of the policy, for reports
  FitRuleSet standard, own;   ///< built in; of the document
  /// Strain of the garment on the body that it comes from, or 0: a tenth more is allowed
  /// on another body.
  double worn_p99 = 0, worn_max = 0;
  /// The garment comes from this very body, on which it came to rest without a finding: by
  /// girth its ease there, a share of the body's. The same ease is allowed again.
  std::optional<std::map<std::string, double>> worn_here;
  /// "too small" and "too large" are always refused.
  bool refuse_loose = false, refuse_tight = false;

  /// The limits that hold for a girth of such a garment.
  /// @param girth  name without _l or _r
  /// @param garment_class  empty: none
  /// @param fabric  material name; empty: none
  FitLimits limits(const std::string& girth, const std::string& garment_class = {},
                   const std::string& fabric = {}) const;
  /// too_large_ease for a garment that was cut with ease on purpose: the larger of the
  /// limit L and (1 + designed) (1 + L / 2) - 1, the ease that the design has on a body
  /// whose girth is smaller by the factor 1 + L / 2. A limit of the document is returned as it is.
  /// @param limits  of limits()
  /// @param designed  ease as a ratio to the girth of the body that the garment was cut for
  double too_large_ease(const FitLimits& limits, double designed, const std::string& girth,
                        const std::string& garment_class, const std::string& fabric) const;
  /// too_small_strain of `limits` for a girth that is stretched by `worn` on the body that
  /// the garment comes from: the larger of the limit and a tenth more than `worn`. A limit of
  /// the document, and any limit where worn_p99 is 0, is returned as it is.
  double too_small_strain(const FitLimits& limits, double worn, const std::string& girth,
                          const std::string& garment_class, const std::string& fabric) const;
  /// too_small_ease for a garment that was cut tight on purpose: the smaller of the limit
  /// and `designed` - 0.01. A limit of the document, and any limit where worn_p99 is 0, is
  /// returned as it is.
  double too_small_ease(const FitLimits& limits, double designed, const std::string& girth,
                        const std::string& garment_class, const std::string& fabric) const;
  /// Largest 99th percentile of strain over all cloth with which the garment still fits.
  double strain_p99(const std::string& garment_class, const std::string& fabric) const;
  /// Largest strain of any triangle with which it still fits.
  double strain_max(const std::string& garment_class, const std::string& fabric) const;
  /// Distance that the garment may sink before it counts as falling off, m; infinite: as
  /// far as the hip holds it.
  double slip_m(const std::string& garment_class, const std::string& fabric) const;
};

/// For woven cloth that gives little. Loose and too large are by class: what hangs from the waist
/// must hold there, what hangs from the shoulders may stand off; skirts flare. The figures are in
/// the man page.
FitPolicy standard_fit_policy();
/// Rules for a fabric that gives more than woven cloth. A wearing load of 50 N/m (half of the
/// load from which stretch.hpp makes a finding) stretches its softer direction by a strain that
/// is allowed in a girth and over the whole garment, and by which a girth may be smaller than
/// the body; half of it is tight, twice it is allowed at one place. Empty where woven cloth is
/// allowed more.
/// @param stiffness_n_m  of the softer of warp and weft, above 0
FitRules elastic_fabric_rules(double stiffness_n_m);

/// Reads a policy document over the standard one.
/// @throws Error INPUT with its place
FitPolicy read_fit_policy(const std::string& path);

/// Warnings of a policy document. A limit of more than 3 and less than 1000 is probably meant in
/// per cent. A fabric whose name is almost that of a preset or of a material of the garment is
/// probably misspelt; other names belong to fabrics of other garments.
/// @param path  of the document, for the text
std::vector<Message> policy_doubts(const FitPolicy& policy, const Garment& garment,
                                   const std::string& path);

} // namespace sloper::garment
