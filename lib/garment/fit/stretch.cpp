#include <sloper/base/text.hpp>
#include <sloper/garment/fit/stretch.hpp>

#include <sloper/garment/fit/cloth_strain.hpp>
#include <sloper/garment/fit/fit_policy.hpp>
#include <sloper/garment/materials.hpp>
#include <sloper/io/files.hpp>

#include <algorithm>
#include <cstdio>

namespace sloper::garment {

namespace {

constexpr double GROSS = 0.1;        // of any fabric: woven cloth near its limit
constexpr double WORN_TENSION = 100; // N/m, twice a wearing load: knits give more than GROSS to it
constexpr double FURTHER = 1.5; // times the strain on its own body: within that it hangs as it did
constexpr double TIMES_AT_ONE_PLACE =
    3; // times the bound, around one particle: 30 % of woven cloth
constexpr double TELLING_SHARE =
    0.002; // of the particles held in a pinch: fewer are in any garment

/// The first panel that has a vertex at a particle.
std::string panel_of(const Garment& garment, int particle) {
  for (const pattern::PanelInfo& panel : garment.panels.panels)
    for (int v = panel.first_vertex; v < panel.first_vertex + panel.n_vertices; ++v)
      if (garment.particle_of[v] == particle)
        return panel.name;
  return "";
}

std::string strain_text(double strain) {
  return percent(strain, strain < 0.1 ? 1 : 0);
}

std::string stretch_text(const Stretch& s, const Garment& garment, const io::Json& quality) {
  const int held = quality.value("particles_held", 0);
  return "a hundredth of its cloth is stretched by " + strain_text(s.p99) +
         " or more, most in panel " + s.panel + " (" + strain_text(s.panel_p99) + "), at most by " +
         strain_text(s.max) + " at " + sloper::place_text(s.place.x(), s.place.y(), s.place.z()) +
         " m" +
         (held > TELLING_SHARE * static_cast<double>(garment.position.size())
              ? ", and " + std::to_string(held) + " particles are caught"
              : "");
}

} // namespace

Stretch stretch_of(const Garment& garment) {
  Stretch result;
  const std::vector<TriangleStrain> strains = triangle_strains(garment, garment.position);
  std::vector<int> list;
  std::vector<Weighted> all;
  double softest = 1e300;
  for (const pattern::PanelInfo& panel : garment.panels.panels) {
    const Material& material = material_of(garment, panel.material);
    softest = std::min({softest, material.stretch_warp_n_m, material.stretch_weft_n_m});
    std::vector<Weighted> own;
    for (int f = panel.first_triangle; f < panel.first_triangle + panel.n_triangles; ++f) {
      if (!(strains[f].area > 0))
        continue;
      list.push_back(f);
      own.push_back({strains[f].thread(), strains[f].area});
    }
    all.insert(all.end(), own.begin(), own.end());
    if (const double p99 = area_quantile(own, 0.99);
        result.panel.empty() || p99 > result.panel_p99) {
      result.panel_p99 = p99;
      result.panel = panel.name;
    }
  }
  const auto places = strains_around(garment, strains, list);
  std::size_t most = places.size();
  for (std::size_t i = 0; i < places.size(); ++i)
    if (places[i] && *places[i] > result.max) {
      result.max = *places[i];
      most = i;
    }
  if (most < places.size()) {
    result.place = garment.position[most];
    result.place_panel = panel_of(garment, static_cast<int>(most));
  }
  result.p99 = std::max(area_quantile(all, 0.99), 0.0);
  result.panel_p99 = std::max(result.panel_p99, 0.0);
  result.bound = std::max(GROSS, WORN_TENSION / softest);
  return result;
}

std::optional<std::string> stretched_place(const Stretch& s) {
  if (s.p99 > s.bound || s.max < TIMES_AT_ONE_PLACE * s.bound)
    return std::nullopt;
  return "one place is stretched by " + strain_text(s.max) + ", in panel " + s.place_panel +
         " at " + sloper::place_text(s.place.x(), s.place.y(), s.place.z()) +
         " m, though 99 % of the cloth is by less than " + strain_text(s.p99);
}

std::optional<double> stretch_elsewhere(const Garment& garment, const std::string& skin_sha256) {
  if (garment.body_sha256.empty() || skin_sha256.empty() || garment.body_sha256 == skin_sha256)
    return std::nullopt;
  return stretch_of(garment).p99;
}

void judge_stretch(Garment& garment, DrapeOutcome& outcome, const Start& start,
                   std::optional<double> before, std::vector<Message>& findings,
                   Reporter& reporter) {
  if (start.body.empty() || garment.particle_of.empty())
    return;
  DrapeReport& report = outcome.report;
  const Stretch now = stretch_of(garment);
  const bool failed =
      before && now.p99 > std::max(standard_fit_policy().strain_p99("", ""), FURTHER * *before);
  const std::string file = io::file_name(start.file), body = io::file_name(start.body);
  if (const auto place = stretched_place(now); place && !failed) {
    findings.push_back(
        {"drape.stretched-place"_id,
         file + " on " + body + ": " + *place +
             ": look there (render-png --map strain), it is drawn over something or caught"});
    reporter.warning(findings.back());
  }
  if (!failed && (before || !report.converged || now.p99 <= now.bound))
    return;
  const std::string retarget = "retarget-garment --garment ";
  findings.push_back(
      {"drape.stretched"_id,
       file + " on " + body + ": " + stretch_text(now, garment, report.quality) + "; " +
           (failed ? "it comes from another body, and draping does not put it on this one: " +
                         retarget + file + " --to " + body + " does"
                   : retarget + "FILE --to " + body + " --fit FIT tells how it fits")});
  reporter.warning(findings.back());
  if (!failed || !report.converged)
    return;
  report.converged = garment.converged = false;
  report.stop_reason = StopReason::AT_REST_STRETCHED;
  report.stop_detail = strain_text(now.p99) + ", on its own body by " + strain_text(*before);
  outcome.document["converged"] = false;
  outcome.document["stop_reason"] = stop_text(report);
}

} // namespace sloper::garment
