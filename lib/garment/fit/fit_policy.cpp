#include <garment/fit/fit_places.hpp>
#include <sloper/garment/fit/fit_policy.hpp>
#include <sloper/garment/materials.hpp>
#include <sloper/io/json.hpp>

#include <algorithm>
#include <array>

namespace sloper::garment {

namespace {

constexpr double STRAIN_P99 = 0.05, STRAIN_MAX = 0.30, SLIP = 0.10; // woven cloth; m
constexpr double WEARING_LOAD = 50; // N/m: half of the tension from which stretch is a finding
constexpr double ONE_PLACE = 2;     // times the strain of the whole, at one place

// No girth of cloth that is to fit is four times the body's, and no cloth stretches to that; a
// limit in per cent is hardly ever as low.
constexpr double LARGEST_SHARE = 3;
constexpr double NO_LIMIT = 1000; // times the body's girth: no limit, and no per cent either

/// Warns of limits that are given in per cent.
class ShareDoubts {
public:
  ShareDoubts(std::string path, std::vector<Message>& doubts)
      : m_path(std::move(path)), m_doubts(doubts) {}
  void look_at(const std::string& place, const FitRules& rules) {
    look_at(place + "/default", rules.standard);
    for (const auto& [girth, limits] : rules.girths)
      look_at(place + "/girths/" + girth, limits);
    look_at(place + "/strain_p99", rules.strain_p99);
    look_at(place + "/strain_max", rules.strain_max);
  }

private:
  void look_at(const std::string& place, const FitOverride& limits) {
    look_at(place + "/too_small_ease", limits.too_small_ease);
    look_at(place + "/too_small_strain", limits.too_small_strain);
    look_at(place + "/tight_ease", limits.tight_ease);
    look_at(place + "/loose_ease", limits.loose_ease);
    look_at(place + "/too_large_ease", limits.too_large_ease);
  }
  void look_at(const std::string& place, const std::optional<double>& limit) {
    const double size = std::abs(limit.value_or(0));
    if (size <= LARGEST_SHARE || size >= NO_LIMIT)
      return;
    m_doubts.emplace_back("policy.not-a-share"_id,
                          m_path + ": " + place + ": " + io::Json(*limit).dump() +
                              " is more than a share of a girth can be; limits are shares, not "
                              "per cent: " +
                              io::Json(*limit / 100).dump() + "? (1000 and more is no limit)");
  }

  std::string m_path;
  std::vector<Message>& m_doubts;
};

FitOverride read_override(const io::Node& node) {
  node.allow_only(
      {"too_small_ease", "too_small_strain", "tight_ease", "loose_ease", "too_large_ease"});
  FitOverride o;
  const auto read = [&](const char* key, std::optional<double>& value) {
    if (node.has(key))
      value = node.at(key).number();
  };
  read("too_small_ease", o.too_small_ease);
  read("too_small_strain", o.too_small_strain);
  read("tight_ease", o.tight_ease);
  read("loose_ease", o.loose_ease);
  read("too_large_ease", o.too_large_ease);
  if (o.too_small_strain && *o.too_small_strain <= 0)
    node.fail("policy.bad-limits"_id, "too_small_strain must be above zero");
  // Only what is said here can be out of order here; the rest is checked where it is used with the
  // rest.
  const double low = o.too_small_ease.value_or(-1e300), middle = o.tight_ease.value_or(low),
               high = o.loose_ease.value_or(middle);
  if (!(low <= middle && middle <= high && high <= o.too_large_ease.value_or(high)))
    node.fail("policy.bad-limits"_id, "the limits are out of order",
              "too_small_ease <= tight_ease <= loose_ease <= too_large_ease");
  return o;
}

bool is_row(const std::string& girth) {
  const std::vector<std::string>& names = fit_row_names();
  return std::any_of(names.begin(), names.end(), [&](const std::string& name) {
    return girth == name || (has_sides(name) && (girth == name + "_l" || girth == name + "_r"));
  });
}

/// The row that is meant by a name that none has: as the report speaks of it, as it begins, or as
/// it is written almost. @return " (did you mean ...?)", or nothing
std::string row_meant(const std::string& girth) {
  const std::vector<std::string>& names = fit_row_names();
  const auto question = [](const std::string& name) { return " (did you mean \"" + name + "\"?)"; };
  for (const std::string& name : names)
    if (spoken_girth(name) == girth)
      return question(name);
  for (const std::string& name : names)
    if (name.rfind(girth + "_", 0) == 0)
      return question(name);
  return did_you_mean(girth, names, "\"");
}

/// A rule for a girth that no report has a row of would never be applied.
void refuse_unknown(const io::Node& girths) {
  for (const std::string& girth : girths.keys()) {
    if (is_row(girth))
      continue;
    std::string known;
    for (const std::string& name : fit_row_names())
      known += (known.empty() ? "" : ", ") + name;
    girths.fail("policy.unknown-girth"_id,
                "\"" + girth + "\" is not a girth of a fit report" + row_meant(girth),
                "use " + known + "; of one limb alone with _l or _r");
  }
}

FitRules read_rules(const io::Node& node) {
  FitRules rules;
  if (node.has("default"))
    rules.standard = read_override(node.at("default"));
  if (node.has("girths"))
    refuse_unknown(node.at("girths"));
  if (node.has("girths"))
    for (const std::string& name : node.at("girths").keys())
      rules.girths[name] = read_override(node.at("girths").at(name));
  const auto positive = [&](const char* key, std::optional<double>& value) {
    if (!node.has(key))
      return;
    value = node.at(key).number();
    if (*value <= 0)
      node.at(key).fail("policy.bad-limits"_id, "must be above zero");
  };
  positive("strain_p99", rules.strain_p99);
  positive("strain_max", rules.strain_max);
  positive("slip_m", rules.slip_m);
  return rules;
}

const FitRules* rules_of(const std::map<std::string, FitRules>& rules, const std::string& name) {
  const auto found = rules.find(name);
  return found == rules.end() ? nullptr : &found->second;
}

/// The last of all garments', the class's and the fabric's that says something.
double last_said(const FitPolicy& policy, std::optional<double> FitRules::*value, double fallback,
                 const std::string& garment_class, const std::string& fabric) {
  for (const FitRuleSet* set : {&policy.standard, &policy.own})
    for (const FitRules* rules :
         {&set->all, rules_of(set->classes, garment_class), rules_of(set->fabrics, fabric)})
      if (rules && rules->*value)
        fallback = *(rules->*value);
  return fallback;
}

/// @param loose, too_large  shares of the girth; too_large 0: no such limit
FitOverride roomy(double loose, double too_large) {
  FitOverride o;
  o.loose_ease = loose;
  if (too_large > 0)
    o.too_large_ease = too_large;
  return o;
}

constexpr double BEYOND_DESIGN = 0.5; // of the ease that is too large: how much smaller than the
                                      // body it was cut for one in a wide garment may be
constexpr double BELOW_DESIGN = 0.01; // of a girth: what it differs by from drape to drape
constexpr double AS_WORN = 1.1;       // times the strain on the body that a garment comes from

constexpr const char* WAIST_LEVELS[] = {"waist_semantic", "waist_girth_min", "waist_width_min",
                                        "omphalion"};
constexpr const char* CHESTS[] = {"bust", "chest_axilla"};
constexpr const char* HIPS[] = {"hip", "hip_girth_max", "crotch"};

template<class Names>
void say(FitRules& rules, const Names& names, double loose, double too_large) {
  for (const char* name : names)
    rules.girths[name] = roomy(loose, too_large);
}

/// Ease charts of pattern makers call a bust of 10 cm "fitted", of 13 to 20 cm "loose" and beyond
/// that "very loose"; a waistband that is a tenth too wide falls to the hips.
FitRuleSet woven_rules() {
  FitRuleSet set;
  FitRules &top = set.classes["top"], &dress = set.classes["dress"], &skirt = set.classes["skirt"],
           &trousers = set.classes["trousers"], &whole = set.classes["whole"];
  for (FitRules* rules : {&top, &dress, &whole}) {
    say(*rules, CHESTS, 0.25, 0.45);
    say(*rules, WAIST_LEVELS, 0.35, 0.65);
    rules->girths["upper_arm"] = roomy(0.60, 1.20);
    rules->girths["wrist"] = rules->girths["sleeve_hem"] = roomy(1.00, 0);
    rules->girths["neck_edge"] = rules->girths["neck_base"] = rules->girths["neck"] =
        roomy(0.35, 0);
  }
  say(top, HIPS, 0.35, 0.65);
  dress.standard = skirt.standard = roomy(1.50, 0);
  say(trousers, WAIST_LEVELS, 0.08, 0.15); // a skirt may flare below its top edge
  for (FitRules* rules : {&skirt, &trousers}) {
    rules->girths["top_edge"] = roomy(0.08, 0.15);
    rules->slip_m = std::numeric_limits<double>::infinity();
  }
  for (FitRules* rules : {&trousers, &whole}) {
    say(*rules, HIPS, 0.25, 0.45);
    rules->girths["thigh"] = roomy(0.50, 0.90);
    rules->girths["knee"] = rules->girths["calf"] = rules->girths["ankle_min"] =
        rules->girths["leg_hem"] = roomy(1.50, 0);
  }
  return set;
}

} // namespace

const char* verdict_name(FitVerdict verdict) {
  switch (verdict) {
  case FitVerdict::LOOSE: return "loose";
  case FitVerdict::TIGHT: return "tight";
  case FitVerdict::TOO_LARGE: return "too large";
  case FitVerdict::TOO_SMALL: return "too small";
  case FitVerdict::IMPOSSIBLE: return "impossible";
  default: return "ok";
  }
}

void FitOverride::apply(FitLimits& limits) const {
  limits.too_small_strain = too_small_strain.value_or(limits.too_small_strain);
  // A limit that is said pushes those on the way, which were said less near.
  const std::array<double*, 4> ladder = {&limits.too_small_ease, &limits.tight_ease,
                                         &limits.loose_ease, &limits.too_large_ease};
  const std::array<const std::optional<double>*, 4> said = {&too_small_ease, &tight_ease,
                                                            &loose_ease, &too_large_ease};
  for (std::size_t k = 0; k < ladder.size(); ++k) {
    if (!*said[k])
      continue;
    for (std::size_t j = 0; j < k; ++j)
      *ladder[j] = std::min(*ladder[j], **said[k]);
    *ladder[k] = **said[k];
    for (std::size_t j = k + 1; j < ladder.size(); ++j)
      *ladder[j] = std::max(*ladder[j], **said[k]);
  }
}

FitLimits FitPolicy::limits(const std::string& girth, const std::string& garment_class,
                            const std::string& fabric) const {
  FitLimits limits;
  const std::string both_sides = girth.size() > 2 && girth[girth.size() - 2] == '_'
                                     ? girth.substr(0, girth.size() - 2)
                                     : girth;
  for (const FitRuleSet* set : {&standard, &own}) {
    const std::array<const FitRules*, 3> layers = {&set->all, rules_of(set->classes, garment_class),
                                                   rules_of(set->fabrics, fabric)};
    for (const FitRules* rules : layers)
      if (rules)
        rules->standard.apply(limits);
    for (const FitRules* rules : layers) {
      if (!rules)
        continue;
      for (const std::string& key : {both_sides, girth})
        if (const auto found = rules->girths.find(key); found != rules->girths.end())
          found->second.apply(limits);
    }
  }
  return limits;
}

static FitPolicy without_document(const FitPolicy& policy) {
  FitPolicy ours;
  ours.standard = policy.standard;
  return ours;
}

double FitPolicy::too_small_strain(const FitLimits& limits, double worn, const std::string& girth,
                                   const std::string& garment_class,
                                   const std::string& fabric) const {
  const bool said = limits.too_small_strain !=
                    without_document(*this).limits(girth, garment_class, fabric).too_small_strain;
  return worn_p99 == 0 || said ? limits.too_small_strain
                               : std::max(limits.too_small_strain, AS_WORN * worn + BELOW_DESIGN);
}

double FitPolicy::too_small_ease(const FitLimits& limits, double designed, const std::string& girth,
                                 const std::string& garment_class,
                                 const std::string& fabric) const {
  if (worn_p99 == 0)
    return limits.too_small_ease;
  const bool said = limits.too_small_ease !=
                    without_document(*this).limits(girth, garment_class, fabric).too_small_ease;
  return said ? limits.too_small_ease : std::min(limits.too_small_ease, designed - BELOW_DESIGN);
}

double FitPolicy::too_large_ease(const FitLimits& limits, double designed, const std::string& girth,
                                 const std::string& garment_class,
                                 const std::string& fabric) const {
  const bool said = limits.too_large_ease !=
                    without_document(*this).limits(girth, garment_class, fabric).too_large_ease;
  return said ? limits.too_large_ease
              : std::max(limits.too_large_ease,
                         (1 + designed) * (1 + BEYOND_DESIGN * limits.too_large_ease) - 1);
}

double FitPolicy::strain_p99(const std::string& garment_class, const std::string& fabric) const {
  return std::max(last_said(*this, &FitRules::strain_p99, STRAIN_P99, garment_class, fabric),
                  AS_WORN * worn_p99);
}
double FitPolicy::strain_max(const std::string& garment_class, const std::string& fabric) const {
  return std::max(last_said(*this, &FitRules::strain_max, STRAIN_MAX, garment_class, fabric),
                  AS_WORN * worn_max);
}
double FitPolicy::slip_m(const std::string& garment_class, const std::string& fabric) const {
  return last_said(*this, &FitRules::slip_m, SLIP, garment_class, fabric);
}

FitPolicy standard_fit_policy() {
  FitPolicy policy;
  policy.standard = woven_rules();
  return policy;
}

FitRules elastic_fabric_rules(double stiffness_n_m) {
  FitRules rules;
  const double strain = WEARING_LOAD / stiffness_n_m;
  const FitLimits woven;
  if (strain <= STRAIN_P99)
    return rules; // it gives no more than woven cloth
  if (strain > woven.too_small_strain)
    rules.standard.too_small_strain = strain;
  rules.strain_p99 = strain;
  if (ONE_PLACE * strain > STRAIN_MAX)
    rules.strain_max = ONE_PLACE * strain;
  const double ease = -strain / (1 + strain); // of the body's girth
  if (ease < woven.too_small_ease) {
    rules.standard.too_small_ease = ease;
    rules.standard.tight_ease = std::min(woven.tight_ease, 0.5 * ease);
  }
  return rules;
}

FitPolicy read_fit_policy(const std::string& path) {
  const io::Json document = io::read_document(path, "fit-policy", FIT_POLICY_VERSION);
  const io::Node root(document, path);
  root.allow_only({"format", "version", "generator", "length_unit", "name", "refuse", "default",
                   "girths", "strain_p99", "strain_max", "slip_m", "classes", "fabrics"});
  FitPolicy policy = standard_fit_policy();
  policy.name = root.string("name", "unnamed");
  policy.own.all = read_rules(root);
  const auto layer = [&](const char* key, std::map<std::string, FitRules>& rules) {
    if (!root.has(key))
      return;
    for (const std::string& name : root.at(key).keys()) {
      const io::Node node = root.at(key).at(name);
      node.allow_only({"default", "girths", "strain_p99", "strain_max", "slip_m"});
      rules[name] = read_rules(node);
    }
  };
  layer("classes", policy.own.classes);
  layer("fabrics", policy.own.fabrics);
  for (const auto& [name, rules] : policy.own.classes)
    if (name != "top" && name != "dress" && name != "skirt" && name != "trousers" &&
        name != "whole")
      root.at("classes").fail("json.unknown-word"_id, "\"" + name + "\" is not a class of garments",
                              "use top, dress, skirt, trousers or whole");
  if (root.has("refuse")) {
    const io::Node refuse = root.at("refuse");
    for (std::size_t i = 0; i < refuse.size(); ++i) {
      const std::string word = refuse.at(i).string();
      if (word == "loose")
        policy.refuse_loose = true;
      else if (word == "tight")
        policy.refuse_tight = true;
      else if (word != "too small" && word != "too large")
        refuse.at(i).fail("json.unknown-word"_id, "\"" + word + "\" is not a verdict",
                          "use \"too small\", \"too large\", \"tight\" or \"loose\"");
    }
  }
  return policy;
}

std::vector<Message> policy_doubts(const FitPolicy& policy, const Garment& garment,
                                   const std::string& path) {
  std::vector<std::string> known;
  for (const auto& [key, material] : garment.materials)
    known.insert(known.end(), {key, material.name});
  for (const pattern::PanelInfo& panel : garment.panels.panels)
    known.push_back(panel.material);
  for (const Material& preset : material_presets())
    known.push_back(preset.name);
  std::vector<Message> doubts;
  for (const auto& [fabric, rules] : policy.own.fabrics) {
    const std::string meant = did_you_mean(fabric, known, "\"");
    if (meant.empty() || std::find(known.begin(), known.end(), fabric) != known.end())
      continue;
    doubts.emplace_back("policy.unknown-fabric"_id,
                        path + ": /fabrics: \"" + fabric +
                            "\" is neither a preset nor a material of the garment" + meant +
                            "; its rules are not applied");
  }
  ShareDoubts shares(path, doubts);
  shares.look_at("", policy.own.all);
  for (const auto& [name, rules] : policy.own.classes)
    shares.look_at("/classes/" + name, rules);
  for (const auto& [name, rules] : policy.own.fabrics)
    shares.look_at("/fabrics/" + name, rules);
  return doubts;
}

} // namespace sloper::garment
