#include <garment/fit_policy.hpp>

#include <io/json.hpp>

#include <array>

namespace sloper::garment {

namespace {

FitLimits read_limits(const io::Node& node, FitLimits limits) {
  node.allow_only({"too_small_ease", "too_small_strain", "tight_ease", "loose_ease"});
  limits.too_small_ease = node.number("too_small_ease", limits.too_small_ease);
  limits.too_small_strain = node.number("too_small_strain", limits.too_small_strain);
  limits.tight_ease = node.number("tight_ease", limits.tight_ease);
  limits.loose_ease = node.number("loose_ease", limits.loose_ease);
  if (!(limits.too_small_ease <= limits.tight_ease && limits.tight_ease <= limits.loose_ease))
    node.fail("the limits are out of order", "too_small_ease <= tight_ease <= loose_ease");
  if (limits.too_small_strain <= 0) node.fail("too_small_strain must be above zero");
  return limits;
}

} // namespace

const char* verdict_name(FitVerdict verdict) {
  switch (verdict) {
  case FitVerdict::LOOSE: return "loose";
  case FitVerdict::TIGHT: return "tight";
  case FitVerdict::TOO_SMALL: return "too small";
  default: return "ok";
  }
}

const FitLimits& FitPolicy::limits(const std::string& girth) const {
  if (const auto found = girths.find(girth); found != girths.end()) return found->second;
  if (girth.size() > 2 && girth[girth.size() - 2] == '_')
    if (const auto found = girths.find(girth.substr(0, girth.size() - 2)); found != girths.end()) return found->second;
  return standard;
}

FitPolicy standard_fit_policy() { return {}; }

FitPolicy read_fit_policy(const std::string& path) {
  const io::Json document = io::read_document(path, "fit-policy", FIT_POLICY_VERSION);
  const io::Node root(document, path);
  root.allow_only({"format", "version", "generator", "length_unit", "name", "refuse", "default", "girths"});
  FitPolicy policy = standard_fit_policy();
  policy.name = root.string("name", "unnamed");
  if (root.has("default")) policy.standard = read_limits(root.at("default"), policy.standard);
  if (root.has("girths"))
    for (const std::string& name : root.at("girths").keys()) policy.girths[name] = read_limits(root.at("girths").at(name), policy.standard);
  if (root.has("refuse")) {
    const io::Node refuse = root.at("refuse");
    for (std::size_t i = 0; i < refuse.size(); ++i) {
      const std::string word = refuse.at(i).string();
      if (word == "loose") policy.refuse_loose = true;
      else if (word == "tight") policy.refuse_tight = true;
      else if (word != "too small") refuse.at(i).fail("\"" + word + "\" is not a verdict", "use \"too small\", \"tight\" or \"loose\"");
    }
  }
  return policy;
}

} // namespace sloper::garment
