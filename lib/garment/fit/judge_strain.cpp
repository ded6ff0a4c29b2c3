#include <garment/fit/judge_strain.hpp>

#include <garment/fit/fit_places.hpp>
#include <sloper/base/text.hpp>

namespace sloper::garment {

namespace {

/// The region whose cloth is stretched most.
const FitRegion* worst_region(const FitReport& report, bool by_p99) {
  const FitRegion* worst = nullptr;
  for (const FitRegion& r : report.regions)
    if (!worst || (by_p99 ? r.strain_p99 > worst->strain_p99 : r.strain_max > worst->strain_max))
      worst = &r;
  return worst;
}

std::string place_text(const FitRegion* region) {
  if (!region)
    return {};
  const bool wraps = region->name == "trunk" || region->name == "shoulders";
  return (wraps ? " over the " : " on the ") + region->name;
}

/// Girths around which the cloth is stretched by more than it bears are too small.
/// @return the one where it is stretched most; nullptr: none
const FitRow* judge_rows(double p99, FitReport& report) {
  const FitRow* most = nullptr;
  for (FitRow& row : report.rows) {
    if (row.strain_p99 <= p99)
      continue;
    if (!most || row.strain_p99 > most->strain_p99)
      most = &row;
    if (row.verdict != FitVerdict::OK && row.verdict != FitVerdict::TIGHT)
      continue;
    row.verdict = FitVerdict::TOO_SMALL;
    row.rule = {"strain_p99", p99};
    row.reason =
        "is stretched by " + whole_percent(row.strain_p99) + " at the " + spoken_girth(row.name);
  }
  return most;
}

} // namespace

void judge_strain(const FitPolicy& policy, FitReport& report) {
  const double p99 = policy.strain_p99(report.garment_class, report.fabric),
               most = policy.strain_max(report.garment_class, report.fabric);
  if (report.verdict == FitVerdict::TOO_SMALL ||
      (report.strain_p99 <= p99 && report.strain_max <= most))
    return;
  const bool by_p99 = report.strain_p99 > p99;
  const std::string where = place_text(worst_region(report, by_p99));
  report.verdict = FitVerdict::TOO_SMALL;
  report.rule = {by_p99 ? "strain_p99" : "strain_max", by_p99 ? p99 : most};
  if (!by_p99) {
    report.reason = "is stretched by " + whole_percent(report.strain_max) + " at one place" +
                    where + "; the cloth bears " + whole_percent(most);
    return;
  }
  report.reason = "is stretched by " + percent(report.strain_p99) +
                  " or more in a hundredth of its cloth, chiefly" + where;
  if (const FitRow* row = judge_rows(p99, report))
    report.reason +=
        " (at the " + spoken_girth(row->name) + " by " + whole_percent(row->strain_p99) + ")";
  report.reason += "; the cloth bears " + whole_percent(p99);
}

} // namespace sloper::garment
