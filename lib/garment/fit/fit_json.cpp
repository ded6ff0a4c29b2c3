#include <sloper/garment/fit/fit.hpp>
#include <sloper/io/json.hpp>

#include <cmath>
#include <cstdio>

namespace sloper::garment {

namespace {

constexpr std::size_t COLUMNS_OF_FIGURES = 19; ///< of the CSV, from height_m to margin_cm

io::Json rule_json(const FitRule& rule) {
  io::Json j = {{"key", rule.key}};
  if (!rule.key.empty() && std::isfinite(rule.limit))
    j["limit"] = rule.limit;
  return j;
}

io::Json length_json(const FitLength& length) {
  io::Json j;
  j["place"] = length.place;
  j["above_cm"] = {{"value", 100 * length.above_m}, {"uncertainty", 100 * length.uncertainty_m}};
  if (length.source_above_m) {
    j["source_above_cm"] = 100 * *length.source_above_m;
    j["verdict"] = length.verdict;
  }
  j["text"] = length_text(length);
  return j;
}

/// A text within quotes of RFC 4180.
std::string quoted(const std::string& text) {
  std::string out = "\"";
  for (const char c : text)
    out += c == '"' ? std::string("\"\"") : std::string(1, c);
  return out + "\"";
}

/// A row without figures: a length, or a finding.
std::string row_of_words(const std::string& name, const std::string& kind,
                         const std::string& verdict, const std::string& reason) {
  return name + "," + kind + "," + std::string(COLUMNS_OF_FIGURES, ',') + verdict + "," +
         quoted(reason) + "\r\n";
}

} // namespace

io::Json fit_json(const FitReport& report, const std::string& tool) {
  io::Json document = io::new_document("fit", 1, tool);
  document["fits"] = report.fits;
  document["verdict"] = verdict_name(report.verdict);
  document["reason"] = report.reason;
  document["rule"] = rule_json(report.rule);
  document["probability"] = {{"fits", report.probability.fits},
                             {"girth", report.probability.girth},
                             {"rule", report.probability.rule}};
  if (report.strain_unknown) {
    document["strain_unknown"] = io::Json::object();
    if (report.bears)
      document["strain_unknown"] = {{"bears", *report.bears}, {"girth", report.bears_at}};
  }
  document["state"] = report.state;
  if (!report.mode.empty())
    document["mode"] = report.mode;
  document["policy"] = report.policy;
  document["garment_class"] = report.garment_class;
  document["fabric"] = report.fabric;
  document["margin_cm"] = {{"value", 100 * report.margin_m}, {"girth", report.margin_at}};
  document["strain"] = {{"p99", report.strain_p99}, {"max", report.strain_max}};
  document["slip_m"] = report.slip_m;
  document["hem_height_m"] = report.hem_height_m;
  document["below_soles_m"] = report.below_soles_m;
  document["top_height_m"] = report.top_height_m;
  document["convergence_m"] = report.convergence_m;
  document["girths"] = io::Json::object();
  for (const FitRow& r : report.rows) {
    io::Json j;
    j["kind"] = r.kind;
    j["height_m"] = r.height_m;
    j["body_m"] = {{"value", r.body_m}, {"uncertainty", r.body_uncertainty_m}};
    j["garment_m"] = {
        {"rest", r.rest_m}, {"lying", r.lying_m}, {"uncertainty", r.garment_uncertainty_m}};
    j["ease_cm"] = {{"value", 100 * r.ease_m}, {"uncertainty", 100 * r.ease_uncertainty_m}};
    if (r.source_ease_m)
      j["source_ease_cm"] = 100 * *r.source_ease_m;
    j["ease_percent"] = {{"value", 100 * r.ease_m / r.body_m},
                         {"uncertainty", 100 * r.ease_uncertainty_m / r.body_m}};
    j["gathered"] = r.gathered;
    j["open"] = r.open;
    j["bridged_m"] = r.bridged_m;
    j["strain"] = {{"girth", r.strain_girth},
                   {"p99", r.strain_p99},
                   {"direction", r.strain_direction},
                   {"uncertainty", r.strain_uncertainty}};
    j["gap_m"] = {{"p05", r.gap_p05_m}, {"p50", r.gap_p50_m}, {"uncertainty", r.gap_uncertainty_m}};
    j["pressure_p95_pa"] = {{"value", r.pressure_p95_pa},
                            {"uncertainty", r.pressure_uncertainty_pa}};
    j["limits_percent"] = {{"too_small", 100 * r.limits.too_small_ease},
                           {"tight", 100 * r.limits.tight_ease},
                           {"loose", 100 * r.limits.loose_ease}};
    if (std::isfinite(r.limits.too_large_ease))
      j["limits_percent"]["too_large"] = 100 * r.limits.too_large_ease;
    j["margin_cm"] = 100 * r.margin_m;
    j["verdict"] = verdict_name(r.verdict);
    j["reason"] = r.reason;
    j["rule"] = rule_json(r.rule);
    document["girths"][r.name] = j;
  }
  document["regions"] = io::Json::object();
  for (const FitRegion& r : report.regions)
    document["regions"][r.name] = {{"triangles", r.triangles},
                                   {"strain",
                                    {{"p50", r.strain_p50},
                                     {"p99", r.strain_p99},
                                     {"max", r.strain_max},
                                     {"direction", r.strain_direction}}}};
  document["hems"] = io::Json::object();
  for (const FitHem& h : report.lines.hems)
    document["hems"][h.name] = {
        {"height_m",
         {{"value", h.height_m}, {"uncertainty", h.uncertainty_m + report.convergence_m}}},
        {"lowest_m", h.lowest_m},
        {"highest_m", h.highest_m},
        {"length_m", h.length_m},
        {"balance_cm",
         {{"front_minus_back", 100 * h.front_minus_back_m},
          {"left_minus_right", 100 * h.left_minus_right_m}}}};
  document["coverage"] = io::Json::object();
  for (const auto& [name, share] : report.lines.coverage)
    document["coverage"][name] = {{"share", share}, {"length_m", report.lines.coverage_m.at(name)}};
  if (report.was_draped()) {
    document["lengths"] = io::Json::object();
    for (const FitLength& length : report.lengths)
      document["lengths"][length.name] = length_json(length);
  }
  document["left_out"] = io::Json::object();
  for (const auto& [name, why] : report.left_out)
    document["left_out"][name] = why;
  io::put_findings(document, report.findings);
  return document;
}

std::string fit_csv(const FitReport& report) {
  std::string csv = "girth,kind,height_m,body_cm,body_uncertainty_cm,garment_rest_cm,garment_lying_"
                    "cm,garment_uncertainty_cm,ease_cm,ease_percent,"
                    "ease_uncertainty_cm,strain_girth,strain_p99,strain_direction,strain_"
                    "uncertainty,gap_p05_mm,gap_p50_mm,gap_uncertainty_mm,"
                    "pressure_p95_pa,pressure_uncertainty_pa,margin_cm,verdict,reason\r\n";
  for (const FitRow& r : report.rows) {
    char sizes[256];
    std::snprintf(sizes, sizeof sizes, "%s,%s,%.4f,%.2f,%.2f,%.2f,%.2f,%.2f,%.2f,%.2f,%.2f,",
                  r.name.c_str(), r.kind.c_str(), r.height_m, 100 * r.body_m,
                  100 * r.body_uncertainty_m, 100 * r.rest_m, 100 * r.lying_m,
                  100 * r.garment_uncertainty_m, 100 * r.ease_m, 100 * r.ease_m / r.body_m,
                  100 * r.ease_uncertainty_m);
    char draped[256] = ",,,,,,,,,";
    if (report.was_draped())
      std::snprintf(draped, sizeof draped, "%.4f,%.4f,%s,%.4f,%.2f,%.2f,%.2f,%.1f,%.1f,",
                    r.strain_girth, r.strain_p99, r.strain_direction.c_str(), r.strain_uncertainty,
                    1000 * r.gap_p05_m, 1000 * r.gap_p50_m, 1000 * r.gap_uncertainty_m,
                    r.pressure_p95_pa, r.pressure_uncertainty_pa);
    char verdict[64];
    std::snprintf(verdict, sizeof verdict, "%.2f,%s,", 100 * r.margin_m, verdict_name(r.verdict));
    csv += sizes;
    csv += draped;
    csv += verdict;
    csv += quoted(r.reason) + "\r\n";
  }
  if (report.was_draped())
    for (const FitLength& length : report.lengths)
      csv += row_of_words(length.name, "length", length.verdict, length_text(length));
  for (const Message& finding : report.findings)
    csv += row_of_words(finding.id, "finding", "", finding.text);
  return csv;
}

} // namespace sloper::garment
