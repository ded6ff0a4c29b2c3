#include <garment/fit.hpp>

#include <base/error.hpp>
#include <base/units.hpp>
#include <garment/fit_places.hpp>
#include <garment/fit_section.hpp>
#include <garment/materials.hpp>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <optional>
#include <set>

namespace sloper::garment {

namespace {

constexpr double AROUND = 0.75;       // turns about the axis from which a line of cloth counts as going round
constexpr double LARGEST_OPEN = 0.4;  // turns that arms and openings may leave bare of a trunk level
constexpr double BAND = 0.02;         // m on both sides of the cut in which strain is taken
constexpr double TOUCHING = 0.003;    // m beyond the contact gap at which cloth still presses
constexpr double REACH_BEYOND = 0.03; // m above and below a level that cloth must reach, or it may slide to where it is wide enough
constexpr double NOT_AT_REST = 0.01;  // m that a drape which did not come to rest may still move

/// The innermost line of cloth that goes round the place, or nothing and why.
std::optional<SectionLine> line_around(const Garment& garment, const std::vector<char>& use, const FitPlace& place, double shift, std::string& why,
                                       const std::vector<Vec3>* elsewhere = nullptr) {
  const Vec3 center = place.center + shift * place.normal;
  std::vector<SectionChain> chains = cut_garment(garment, use, center, place.normal, elsewhere);
  why = chains.empty() ? "the garment does not reach it" : "the garment does not go round it";
  const SectionChain* best = nullptr;
  for (const SectionChain& chain : chains) {
    if (chain.turns(center, place.normal) < AROUND) continue;
    const bool both = std::any_of(place.outside.begin(), place.outside.end(), [&](const Vec3& o) { return chain.turns(o, place.normal) > AROUND; });
    if (both) {
      if (!best) why = "the garment goes round both legs there";
      continue;
    }
    if (!best || chain.rest_length < best->rest_length) best = &chain;
  }
  if (best) {
    SectionLine line;
    line.bridged = best->closed ? 0 : best->opening;
    line.lying = best->length + line.bridged, line.rest = best->rest_length + line.bridged, line.elsewhere = best->elsewhere + line.bridged;
    line.chains.push_back(*best);
    return line;
  }
  if (place.kind != "level") return std::nullopt;
  return assemble_line(std::move(chains), center, place.normal, LARGEST_OPEN);
}

double quantile(std::vector<double>& values, double q) {
  if (values.empty()) return 0;
  std::sort(values.begin(), values.end());
  return values[static_cast<std::size_t>(q * static_cast<double>(values.size() - 1))];
}

const pattern::PanelInfo& panel_of(const Garment& garment, int triangle) {
  for (const pattern::PanelInfo& panel : garment.panels.panels)
    if (triangle < panel.first_triangle + panel.n_triangles) return panel;
  return garment.panels.panels.back();
}

/// An edge of the cloth: particles, strain, |cosine to the grain|.
struct Edge {
  int p, q;
  double strain, cosine;
};

std::vector<Edge> edges_with_strain(const Garment& garment) {
  std::vector<Edge> edges;
  std::set<std::array<int, 2>> seen;
  for (const pattern::PanelInfo& panel : garment.panels.panels)
    for (int f = panel.first_triangle; f < panel.first_triangle + panel.n_triangles; ++f)
      for (int k = 0; k < 3; ++k) {
        const int a = garment.panels.triangles[f][k], b = garment.panels.triangles[f][(k + 1) % 3];
        const int p = garment.particle_of[a], q = garment.particle_of[b];
        if (!seen.insert({std::min(p, q), std::max(p, q)}).second) continue;
        const Vec2 d = garment.panels.pattern[b] - garment.panels.pattern[a];
        const double rest = d.norm() * (garment.rest_scale.empty() ? 1 : garment.rest_scale[f][k]);
        if (rest > 0) edges.push_back({p, q, (garment.position[p] - garment.position[q]).norm() / rest - 1, std::abs(d.normalized().dot(panel.grain))});
      }
  return edges;
}

struct StrainFigures {
  std::size_t n = 0;
  double p50 = 0, p99 = 0, max = 0;
  std::string direction;
};

StrainFigures figures_of(std::vector<std::pair<double, double>> strains) {
  StrainFigures figures;
  figures.n = strains.size();
  if (strains.empty()) return figures;
  std::sort(strains.begin(), strains.end());
  const auto at = [&](double q) { return static_cast<std::size_t>(q * static_cast<double>(strains.size() - 1)); };
  figures.p50 = strains[at(0.5)].first, figures.p99 = strains[at(0.99)].first, figures.max = strains.back().first;
  double cosine = 0;
  for (std::size_t i = at(0.99); i < strains.size(); ++i) cosine += strains[i].second / static_cast<double>(strains.size() - at(0.99));
  figures.direction = cosine > 0.924 ? "warp" : cosine < 0.383 ? "weft" : "bias"; // within 22.5 degrees of an axis
  return figures;
}

StrainFigures strain_near(const Garment& garment, const std::vector<Edge>& edges, const std::vector<char>& belongs, const FitPlace& place, double band) {
  std::vector<std::pair<double, double>> strains;
  for (const Edge& e : edges)
    if (belongs[e.p] && belongs[e.q] && std::abs((0.5 * (garment.position[e.p] + garment.position[e.q]) - place.center).dot(place.normal)) <= band)
      strains.emplace_back(e.strain, e.cosine);
  return figures_of(std::move(strains));
}

void measure_contact(const Garment& garment, const collision::BodyCollider& skin, const SectionLine& line, FitRow& row) {
  std::vector<double> gaps, pressures;
  int hint = -1;
  double modulus = 0;
  const double radius = row.body_m / (2 * units::PI);
  for (const SectionChain& chain : line.chains)
    for (const SectionSegment& s : chain.segments) {
      const collision::SignedDistance d = skin.signed_distance(s.a, 1.0, hint);
      if (d.triangle < 0) continue;
      hint = d.triangle;
      gaps.push_back(d.distance);
      const Material& material = material_of(garment, panel_of(garment, s.triangle).material);
      modulus = std::max(modulus, std::min(material.stretch_warp_n_m, material.stretch_weft_n_m));
      const double strain = s.rest > 1e-6 ? std::max(0.0, (s.b - s.a).norm() / s.rest - 1) : 0;
      const double tension = strain * std::min(material.stretch_warp_n_m, material.stretch_weft_n_m);
      pressures.push_back(d.distance < garment.offset_m + TOUCHING ? tension / radius : 0);
    }
  row.gap_p05_m = quantile(gaps, 0.05);
  row.gap_p50_m = quantile(gaps, 0.50);
  row.pressure_p95_pa = quantile(pressures, 0.95);
  row.pressure_uncertainty_pa = row.strain_uncertainty * modulus / radius;
}

std::string centimetres(double m) {
  char text[32];
  std::snprintf(text, sizeof text, "%.1f cm", std::abs(m) * 100);
  return text;
}

std::string percent(double share) { return std::to_string(std::lround(100 * share)) + " %"; }

/// @param at_rest  strain is a fact only of cloth at rest
void judge(const FitLimits& limits, bool at_rest, FitRow& row) {
  const double share = row.ease_m / row.body_m;
  row.margin_m = std::min(row.ease_m - limits.tight_ease * row.body_m, limits.loose_ease * row.body_m - row.ease_m);
  if (share < limits.too_small_ease) {
    row.verdict = FitVerdict::TOO_SMALL;
    row.reason = "does not close at the " + spoken_girth(row.name) + " by " + centimetres(row.ease_m);
  } else if (at_rest && row.strain_girth > limits.too_small_strain) {
    row.verdict = FitVerdict::TOO_SMALL;
    row.reason = "is stretched by " + percent(row.strain_girth) + " at the " + spoken_girth(row.name);
  } else if (share < limits.tight_ease) {
    row.verdict = FitVerdict::TIGHT;
    row.reason = "is tight at the " + spoken_girth(row.name) + ": " + (row.ease_m < 0 ? "-" : "") + centimetres(row.ease_m) + " of ease";
  } else if (share > limits.loose_ease) {
    row.verdict = FitVerdict::LOOSE;
    row.reason = "is loose at the " + spoken_girth(row.name) + ": " + centimetres(row.ease_m) + " of ease";
  }
}

std::optional<FitRow> measure(const Garment& garment, const std::vector<Edge>& edges, const collision::BodyCollider& skin, const FitPlace& place,
                              double convergence, std::string& why) {
  const std::vector<char> use = cloth_of(garment, place);
  const auto line = line_around(garment, use, place, 0, why);
  if (!line) return std::nullopt;
  FitRow row;
  row.name = place.name;
  row.kind = place.kind;
  row.height_m = place.center.y();
  row.body_m = place.body_m;
  row.open = !line->closed();
  row.bridged_m = line->bridged;
  row.lying_m = line->lying;
  row.rest_m = line->rest;
  row.ease_m = row.rest_m - row.body_m;
  row.strain_girth = row.rest_m > 0 ? row.lying_m / row.rest_m - 1 : 0;
  std::vector<char> belongs(garment.position.size(), 0);
  for (std::size_t f = 0; f < use.size(); ++f)
    if (use[f])
      for (const int v : garment.panels.triangles[f]) belongs[garment.particle_of[v]] = 1;
  const StrainFigures strain = strain_near(garment, edges, belongs, place, BAND), half = strain_near(garment, edges, belongs, place, 0.5 * BAND);
  row.strain_p99 = strain.p99;
  row.strain_direction = strain.direction;
  row.strain_uncertainty = std::abs(strain.p99 - half.p99);
  // How the girth changes within the error of the height, and a chord's shortfall against its arc (edge^2 / 24 r^2).
  double change = 0;
  for (const double shift : {-place.height_error_m, place.height_error_m}) {
    std::string ignored;
    if (const auto moved = line_around(garment, use, place, shift, ignored)) change = std::max(change, std::abs(moved->rest - row.rest_m));
  }
  const double radius = row.rest_m / (2 * units::PI), edge = row.rest_m / static_cast<double>(std::max<std::size_t>(line->n_segments(), 1));
  row.garment_uncertainty_m = std::hypot(change, row.rest_m * edge * edge / (24 * radius * radius), convergence);
  row.body_uncertainty_m = place.body_spread_m;
  row.ease_uncertainty_m = std::hypot(row.garment_uncertainty_m, row.body_uncertainty_m);
  row.gap_uncertainty_m = std::hypot(edge * edge / (8 * radius), convergence);
  measure_contact(garment, skin, *line, row);
  return row;
}

/// Frame on which a particle hangs most.
const std::string& main_frame(const Garment& garment, std::size_t particle) {
  const auto& weights = garment.bind.particles[particle];
  const auto most = std::max_element(weights.begin(), weights.end(), [](const BindWeight& a, const BindWeight& b) { return a.weight < b.weight; });
  return garment.bind.frames[most->frame];
}

double axilla_height(const body::Body& body) {
  double y = 1e300;
  for (const char* name : {"axilla_l", "axilla_r"})
    if (body.has_landmark(name)) y = std::min(y, body.landmark(name).y());
  return y;
}

std::string region_of(const Garment& garment, std::size_t particle, double axilla_y) {
  const std::string& frame = main_frame(garment, particle);
  const std::string side = !frame.empty() && frame.back() == 'l' ? "left " : "right ";
  if (frame.find("arm_") != std::string::npos) return side + "sleeve";
  if (frame.rfind("leg_", 0) == 0) return side + "leg";
  if (frame == "lower_body") return "skirt";
  if (frame == "head") return "collar"; // or a hood
  return garment.position[particle].y() > axilla_y ? "shoulders" : "trunk";
}

std::string class_of(const std::vector<std::string>& region) {
  std::map<std::string, double> share;
  for (const std::string& name : region) share[name] += 1.0 / static_cast<double>(region.size());
  const double legs = share["left leg"] + share["right leg"], above = share["shoulders"];
  const bool top = above > 0.02;
  if (legs > 0.2 && legs > share["skirt"]) return top ? "whole" : "trousers";
  if (share["skirt"] > 0.2) return top ? "dress" : "skirt";
  return top || share["trunk"] > 0.9 ? "top" : "skirt";
}

std::string main_fabric(const Garment& garment) {
  std::map<std::string, int> triangles;
  for (const pattern::PanelInfo& panel : garment.panels.panels) triangles[material_of(garment, panel.material).name] += panel.n_triangles;
  if (triangles.empty()) return {};
  return std::max_element(triangles.begin(), triangles.end(), [](const auto& a, const auto& b) { return a.second < b.second; })->first;
}

void measure_regions(const std::vector<Edge>& edges, const std::vector<std::string>& region, FitReport& report) {
  std::map<std::string, std::vector<std::pair<double, double>>> strains;
  for (const Edge& e : edges)
    if (region[e.p] == region[e.q]) strains[region[e.p]].emplace_back(e.strain, e.cosine);
  for (const auto& [name, values] : strains) {
    const StrainFigures figures = figures_of(values);
    report.regions.push_back({name, static_cast<int>(figures.n), figures.p50, figures.p99, figures.max, figures.direction});
  }
}

void judge_strain(const FitPolicy& policy, FitReport& report) {
  const double p99 = policy.strain_p99(report.garment_class, report.fabric), most = policy.strain_max(report.garment_class, report.fabric);
  if (report.verdict == FitVerdict::TOO_SMALL || (report.strain_p99 <= p99 && report.strain_max <= most)) return;
  const bool by_p99 = report.strain_p99 > p99;
  const FitRegion* worst = nullptr;
  for (const FitRegion& r : report.regions)
    if (!worst || (by_p99 ? r.strain_p99 > worst->strain_p99 : r.strain_max > worst->strain_max)) worst = &r;
  const std::string where = worst ? (worst->name == "trunk" || worst->name == "shoulders" ? " over the " : " on the ") + worst->name : "";
  report.verdict = FitVerdict::TOO_SMALL;
  report.reason = by_p99 ? "is stretched by " + percent(worst ? worst->strain_p99 : report.strain_p99) + where + "; the cloth bears " + percent(p99)
                         : "is stretched by " + percent(report.strain_max) + " at one place" + where + "; the cloth bears " + percent(most);
}

/// The verdict of all rows, the strain and the slip.
void conclude(const FitPolicy& policy, bool beyond_bounds, FitReport& report) {
  const FitRow* worst = nullptr;
  for (const FitRow& row : report.rows) {
    const bool worse = !worst || row.verdict > worst->verdict || (row.verdict == worst->verdict && row.ease_m / row.body_m < worst->ease_m / worst->body_m);
    if (worse) worst = &row;
    if (&row == report.rows.data() || row.margin_m < report.margin_m) report.margin_m = row.margin_m, report.margin_at = row.name;
  }
  if (!worst) {
    report.fits = false;
    report.verdict = FitVerdict::TOO_LARGE;
    report.reason = "goes round no girth of the body";
    return;
  }
  report.verdict = worst->verdict;
  report.reason = worst->reason;
  const bool certain = report.convergence_m == 0 || beyond_bounds;
  if (certain) judge_strain(policy, report);
  if (certain && report.verdict < FitVerdict::TOO_LARGE && report.slip_m > policy.slip_m(report.garment_class, report.fabric)) {
    report.verdict = FitVerdict::TOO_LARGE;
    report.reason = "slides down by " + centimetres(report.slip_m);
  }
  report.fits = report.verdict < FitVerdict::TOO_LARGE && !(report.verdict == FitVerdict::TIGHT && policy.refuse_tight);
  if (report.fits && policy.refuse_loose)
    for (const FitRow& row : report.rows)
      if (row.verdict == FitVerdict::LOOSE) report.fits = false, report.reason = row.reason;
}

} // namespace

FitReport fit_garment(const Garment& garment, const body::Body& body, const collision::BodyCollider& skin, const FitPolicy& policy,
                      const std::vector<Vec3>* placed, bool beyond_bounds) {
  if (garment.bind.empty()) throw input_error("", "/bind", "the garment is not bound to a body", "drape it on the body first");
  FitReport report;
  report.policy = policy.name;
  report.fabric = main_fabric(garment);
  report.convergence_m = garment.converged ? 0 : NOT_AT_REST;
  report.hem_height_m = 1e300, report.top_height_m = -1e300;
  for (const Vec3& p : garment.position) report.hem_height_m = std::min(report.hem_height_m, p.y()), report.top_height_m = std::max(report.top_height_m, p.y());
  if (placed) {
    std::vector<double> sunk;
    for (std::size_t i = 0; i < placed->size(); ++i) sunk.push_back((*placed)[i].y() - garment.position[i].y());
    report.slip_m = quantile(sunk, 0.5);
  }
  std::vector<std::string> region;
  for (std::size_t i = 0; i < garment.position.size(); ++i) region.push_back(region_of(garment, i, axilla_height(body)));
  report.garment_class = class_of(region);
  const std::vector<Edge> edges = edges_with_strain(garment);
  measure_regions(edges, region, report);
  std::vector<std::pair<double, double>> all;
  for (const Edge& e : edges) all.emplace_back(e.strain, e.cosine);
  const StrainFigures total = figures_of(std::move(all));
  report.strain_p99 = total.p99, report.strain_max = total.max;

  std::set<std::string> measured;
  for (const FitPlace& place : fit_places(body)) {
    measured.insert(place.name);
    std::string why;
    auto row = measure(garment, edges, skin, place, report.convergence_m, why);
    if (!row) {
      report.left_out.emplace_back(place.name, why);
      continue;
    }
    judge(policy.limits(row->name, report.garment_class, report.fabric), garment.converged, *row);
    report.rows.push_back(std::move(*row));
  }
  for (const auto& [name, girth] : body.girths)
    if (!measured.count(name)) report.left_out.emplace_back(name, "where it was measured is not told by the body document");
  report.lines = fit_lines(garment, body);
  conclude(policy, beyond_bounds, report);
  return report;
}

FitBounds hopeless_beyond(const FitPolicy& policy, const FitReport& before) {
  return {1.5 * policy.slip_m(before.garment_class, before.fabric), 1.5 * policy.strain_p99(before.garment_class, before.fabric)};
}

FitReport fit_before_drape(const Garment& placed, const std::vector<Vec3>& source_position, const body::Body& body, const FitPolicy& policy) {
  FitReport report;
  report.policy = policy.name;
  report.fabric = main_fabric(placed);
  std::vector<std::string> region;
  for (std::size_t i = 0; i < placed.position.size(); ++i) region.push_back(region_of(placed, i, axilla_height(body)));
  report.garment_class = class_of(region);
  double worst = 0;
  for (const FitPlace& place : fit_places(body)) {
    if (place.kind == "neck") continue; // a collar slides to where it is wide enough
    const std::vector<char> use = cloth_of(placed, place);
    const double limit = policy.limits(place.name, report.garment_class, report.fabric).too_small_strain;
    std::optional<SectionLine> line;
    double missing = 1e300;
    for (const double shift : {-REACH_BEYOND, REACH_BEYOND, 0.0}) {
      std::string why;
      line = line_around(placed, use, place, shift, why, &source_position);
      if (!line) break;
      const double reach = std::max((line->rest - line->bridged) * (1 + limit), line->elsewhere - line->bridged) + line->bridged;
      missing = std::min(missing, place.body_m - place.body_spread_m - reach);
    }
    if (!line) continue;
    if (missing <= 0) continue;
    FitRow row;
    row.name = place.name, row.kind = place.kind, row.height_m = place.center.y(), row.body_m = place.body_m;
    row.rest_m = line->rest, row.lying_m = line->lying, row.ease_m = row.rest_m - row.body_m;
    row.bridged_m = line->bridged, row.open = !line->closed();
    row.body_uncertainty_m = row.ease_uncertainty_m = place.body_spread_m;
    row.margin_m = row.ease_m;
    row.verdict = FitVerdict::TOO_SMALL;
    row.reason = "does not close at the " + spoken_girth(row.name) + " by " + centimetres(row.ease_m);
    report.fits = false;
    report.verdict = row.verdict;
    if (missing / place.body_m > worst) worst = missing / place.body_m, report.reason = row.reason, report.margin_m = row.margin_m, report.margin_at = row.name;
    report.rows.push_back(std::move(row));
  }
  return report;
}

FitReport impossible_fit(const std::string& reason, const FitPolicy& policy) {
  FitReport report;
  report.policy = policy.name;
  report.fits = false;
  report.verdict = FitVerdict::IMPOSSIBLE;
  report.reason = reason;
  return report;
}

} // namespace sloper::garment
