#include <garment/fit/fit_probability.hpp>

#include <algorithm>
#include <cmath>
#include <optional>

namespace sloper::garment {

namespace {

constexpr double LEAST_DEVIATION = 1e-9; // of anything
constexpr double GIRTH_SHARE =
    0.004; // of a girth, besides its uncertainty: with it errors of 131 girths on 9 scans (clean,
           // noise of 2 mm, slices) of 3 fresh bodies are distributed as below() has them, those of
           // 131 on 9 scans of 5 others less widely
constexpr double GIRTH_STRAIN = 0.004; // ratio: what a girth's strain differs by between drapes
constexpr double STRAIN_SHARE = 0.1;   // of the strain of all cloth
constexpr double PLACE_SHARE = 0.2;    // of the strain of one place
constexpr double SLIP_M = 0.01;        // m, of how far a garment sinks
constexpr double LAY_CLOSE = 0.04; // ratio to the girth of the body that a garment was worn on: a
                                   // line that is longer hung free of it, unstretched

/// Probability that a number of Student's distribution with two degrees of freedom is below z:
/// errors of girths have longer tails than normal ones, since a level may be found at another
/// place.
double below(double z) {
  return 0.5 + 0.5 * z / std::sqrt(2 + z * z);
}

/// The bounds of one kind: the one least likely to hold.
struct Least {
  FitProbability least;
  void bound(double margin, double deviation, const std::string& girth, const char* rule) {
    const double p = below(margin / std::max(deviation, LEAST_DEVIATION));
    if (p < least.fits)
      least = {p, girth, rule};
  }
};

void add_row(const FitPolicy& policy, const FitRow& row, bool strain_counts, Least& small,
             Least& large) {
  const double ease = row.ease_m / row.body_m,
               deviation = std::hypot(row.ease_uncertainty_m / row.body_m, GIRTH_SHARE),
               body_deviation = std::hypot(row.body_uncertainty_m / row.body_m, GIRTH_SHARE);
  if (row.short_m > 0) { // refused before any drape, one deviation of the body's girth conceded
    small.bound(-(row.short_m + row.body_uncertainty_m), deviation * row.body_m, row.name,
                "too_small_ease");
    return;
  }
  const FitLimits& limits = row.limits;
  small.bound(ease - limits.too_small_ease, deviation, row.name, "too_small_ease");
  if (policy.refuse_tight)
    small.bound(ease - limits.tight_ease, deviation, row.name, "tight_ease");
  if (strain_counts) // a stouter body takes up the ease first
    small.bound(limits.too_small_strain - row.strain_girth + std::max(0.0, ease),
                std::hypot(GIRTH_STRAIN, body_deviation), row.name, "too_small_strain");
  if (std::isfinite(limits.too_large_ease))
    large.bound(limits.too_large_ease - ease, deviation, row.name, "too_large_ease");
  if (policy.refuse_loose)
    large.bound(limits.loose_ease - ease, deviation, row.name, "loose_ease");
}

/// Strain by which a row may have been stretched on its first body and still not be too small here;
/// nothing where it hung free of that body.
std::optional<double> row_bears(const FitRow& row, bool strain_counts,
                                const std::map<std::string, double>& worn_on) {
  auto girth = worn_on.find(row.name);
  if (girth == worn_on.end())
    girth = worn_on.find("level:" + row.name);
  const double worn_m = row.rest_m * (1 + row.worn_strain);
  // of a free edge the first body's girth is not known: as if it were this one's
  const double worn_on_m = girth == worn_on.end() ? row.body_m : girth->second;
  if (worn_m > (1 + LAY_CLOSE) * worn_on_m)
    return {};
  const double cloth = row.rest_m - row.bridged_m,
               least = cloth - (row.ease_m - row.limits.too_small_ease * row.body_m);
  if (!(least > 0))
    return {}; // openings alone are long enough
  double bears = cloth / least - 1;
  if (strain_counts)
    bears = std::min(bears, (1 + row.limits.too_small_strain) / (1 + row.strain_girth) - 1);
  return std::max(0.0, bears);
}

/// Notes how much more strain than is known a garment bears.
void take_unknown_strain(const FitPolicy& policy, const std::map<std::string, double>& worn_on,
                         bool strain_counts, FitReport& report) {
  const auto at_most = [&](double strain, const std::string& where) {
    if (report.bears && *report.bears <= strain)
      return;
    report.bears = strain;
    report.bears_at = where;
  };
  for (const FitRow& row : report.rows)
    if (const auto bears = row_bears(row, strain_counts, worn_on))
      at_most(*bears, row.name);
  if (!report.bears || !strain_counts)
    return;
  const double p99 = policy.strain_p99(report.garment_class, report.fabric);
  at_most(std::max(0.0, (1 + p99) / (1 + report.strain_p99) - 1), "");
}

} // namespace

void take_probability(const FitPolicy& policy, const std::map<std::string, double>& worn_on,
                      bool strain_counts, FitReport& report) {
  if (report.strain_unknown)
    take_unknown_strain(policy, worn_on, strain_counts, report);
  Least small, large;
  for (const FitRow& row : report.rows)
    add_row(policy, row, strain_counts, small, large);
  if (strain_counts) {
    const double p99 = policy.strain_p99(report.garment_class, report.fabric),
                 most = policy.strain_max(report.garment_class, report.fabric);
    small.bound(p99 - report.strain_p99, STRAIN_SHARE * report.strain_p99, "", "strain_p99");
    small.bound(most - report.strain_max, PLACE_SHARE * report.strain_max, "", "strain_max");
  }
  if (strain_counts && std::isfinite(report.slip_borne_m))
    large.bound(report.slip_borne_m - report.slip_m, SLIP_M, "", "slip_m");
  FitProbability& p = report.probability;
  p = small.least.fits <= large.least.fits ? small.least : large.least;
  p.fits = std::max(0.0, small.least.fits + large.least.fits - 1);
  p.fits = report.fits ? std::max(p.fits, 0.5) : std::min(p.fits, 0.5);
  if (report.verdict == FitVerdict::IMPOSSIBLE)
    p = {0, "", ""};
  if (!report.fits || !report.strain_unknown || !report.bears)
    return;
  const double deviation = policy.strain_p99(report.garment_class, report.fabric);
  const double unstretched = std::erf(*report.bears / (deviation * std::sqrt(2.0)));
  const double both = unstretched * p.fits;
  if (unstretched < p.fits)
    p = {both, report.bears_at, "strain_unknown"};
  p.fits = both;
}

} // namespace sloper::garment
