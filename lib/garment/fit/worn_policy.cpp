#include <sloper/garment/fit/worn_policy.hpp>

#include <garment/fit/fit_places.hpp>
#include <sloper/base/text.hpp>
#include <sloper/garment/fit/fit.hpp>
#include <sloper/garment/fit/stretch.hpp>
#include <sloper/garment/materials.hpp>

#include <algorithm>
#include <cmath>

namespace sloper::garment {

void follow_fabric(const Garment& source, FitPolicy& policy) {
  const std::string fabric = main_material(source);
  for (const pattern::PanelInfo& panel : source.panels.panels) {
    const Material& m = material_of(source, panel.material);
    const double softer = std::min(m.stretch_warp_n_m, m.stretch_weft_n_m);
    if (m.name == fabric && softer > 0)
      policy.standard.fabrics[fabric] = elastic_fabric_rules(softer);
  }
}

void follow_worn(const Garment& source, const body::Body& body, const collision::BodyCollider& skin,
                 const std::string& body_sha256, FitPolicy& policy) {
  const Stretch worn = stretch_of(source);
  if (!source.converged || worn.p99 > worn.bound)
    return;
  policy.worn_p99 = std::max(worn.p99, 1e-9); // cloth that is not stretched was worn, too
  policy.worn_max = worn.max;
  if (source.body_sha256.empty() || source.body_sha256 != body_sha256)
    return;
  std::map<std::string, double> ease;
  const FitReport here =
      fit_garment(source, body, skin, policy, {.made_for = source.body_girths_m});
  for (const FitRow& row : here.rows)
    ease[row.name] = row.ease_m / row.body_m;
  policy.worn_here = std::move(ease);
}

std::string rule_text(const FitRule& rule, const std::string& policy) {
  if (rule.key.empty())
    return {};
  std::string limit = percent(rule.limit);
  if (rule.key == "slip_m")
    limit = centimetres(rule.limit);
  if (!std::isfinite(rule.limit))
    limit = "as far as the hip holds it";
  return rule.key + " of policy " + policy + ", " + limit;
}

std::string unknown_strain_text(const FitReport& fit) {
  if (!fit.fits || !fit.bears || fit.probability.rule != "strain_unknown")
    return {};
  const std::string where =
      fit.bears_at.empty() ? "" : "at the " + spoken_girth(fit.bears_at) + " ";
  return "fits as far as is known: not if, on the body that wore it, it was stretched " + where +
         "by more than " + percent(*fit.bears) + "; the probability that it fits is " +
         whole_percent(fit.probability.fits);
}

} // namespace sloper::garment
