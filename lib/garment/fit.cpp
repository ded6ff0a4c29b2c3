#include <garment/fit.hpp>

#include <base/error.hpp>
#include <base/units.hpp>
#include <garment/fit_section.hpp>
#include <garment/materials.hpp>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <optional>
#include <set>

namespace sloper::garment {

namespace {

constexpr double AROUND = 0.75;        // turns about the axis from which a line of cloth counts as going round
constexpr double BAND = 0.02;          // m on both sides of the cut in which strain is taken
constexpr double HEIGHT_ERROR = 0.005; // m, least uncertainty of a level's height
constexpr double TOUCHING = 0.003;     // m beyond the contact gap at which cloth still presses

/// Where a girth is measured: the plane, the axis it goes round, and which cloth takes part.
struct Place {
  std::string name, kind;
  Vec3 center, normal;
  double body_m = 0, body_spread_m = 0, height_error_m = HEIGHT_ERROR;
  std::vector<std::string> frames; ///< cloth whose weight is mostly on these; empty: all that is not mostly on the arms
  std::vector<Vec3> outside;       ///< axes that the line must not go round
};

bool is_arm(const std::string& frame) { return frame.find("arm") != std::string::npos; }

/// Triangles that belong to a place.
std::vector<char> cloth_of(const Garment& garment, const Place& place) {
  std::vector<double> share(garment.position.size(), 0);
  for (std::size_t i = 0; i < share.size(); ++i)
    for (const BindWeight& w : garment.bind.particles[i]) {
      const std::string& frame = garment.bind.frames[w.frame];
      const bool belongs = place.frames.empty() ? !is_arm(frame) : std::find(place.frames.begin(), place.frames.end(), frame) != place.frames.end();
      if (belongs) share[i] += w.weight;
    }
  std::vector<char> use(garment.panels.triangles.size(), 0);
  for (std::size_t f = 0; f < use.size(); ++f) {
    double sum = 0;
    for (const int v : garment.panels.triangles[f]) sum += share[garment.particle_of[v]];
    use[f] = sum > 1.5;
  }
  return use;
}

/// The innermost line of cloth that goes round the place, or nothing and why.
std::optional<SectionChain> line_around(const Garment& garment, const std::vector<char>& use, const Place& place, double shift, std::string& why) {
  std::optional<SectionChain> best;
  why = "the garment does not reach it";
  for (SectionChain& chain : cut_garment(garment, use, place.center + shift * place.normal, place.normal)) {
    if (chain.turns(place.center, place.normal) < AROUND) {
      if (!best) why = "the garment does not go round it";
      continue;
    }
    const bool both = std::any_of(place.outside.begin(), place.outside.end(), [&](const Vec3& o) { return chain.turns(o, place.normal) > AROUND; });
    if (both) {
      if (!best) why = "the garment goes round both legs there";
      continue;
    }
    if (!best || chain.rest_length < best->rest_length) best = std::move(chain);
  }
  return best;
}

double girth(const SectionChain& chain, bool rest) { return (rest ? chain.rest_length : chain.length) + (chain.closed ? 0 : chain.opening); }

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

void measure_strain(const Garment& garment, const std::vector<char>& use, const Place& place, FitRow& row) {
  std::vector<std::pair<double, double>> strains; // strain, |cosine to the grain|
  std::set<std::array<int, 2>> seen;
  for (std::size_t f = 0; f < use.size(); ++f) {
    if (!use[f]) continue;
    const Triangle& t = garment.panels.triangles[f];
    for (int k = 0; k < 3; ++k) {
      const int a = t[k], b = t[(k + 1) % 3], p = garment.particle_of[a], q = garment.particle_of[b];
      const Vec3 middle = 0.5 * (garment.position[p] + garment.position[q]);
      if (std::abs((middle - place.center).dot(place.normal)) > BAND || !seen.insert({std::min(p, q), std::max(p, q)}).second) continue;
      const Vec2 d = garment.panels.pattern[b] - garment.panels.pattern[a];
      const double rest = d.norm() * (garment.rest_scale.empty() ? 1 : garment.rest_scale[f][k]);
      if (rest <= 0) continue;
      strains.emplace_back((garment.position[p] - garment.position[q]).norm() / rest - 1,
                           std::abs(d.normalized().dot(panel_of(garment, static_cast<int>(f)).grain)));
    }
  }
  if (strains.empty()) return;
  std::sort(strains.begin(), strains.end());
  const std::size_t at = static_cast<std::size_t>(0.99 * static_cast<double>(strains.size() - 1));
  row.strain_p99 = strains[at].first;
  double cosine = 0;
  for (std::size_t i = at; i < strains.size(); ++i) cosine += strains[i].second / static_cast<double>(strains.size() - at);
  row.strain_direction = cosine > 0.924 ? "warp" : cosine < 0.383 ? "weft" : "bias"; // within 22.5 degrees of an axis
}

void measure_contact(const Garment& garment, const collision::BodyCollider& skin, const SectionChain& chain, FitRow& row) {
  std::vector<double> gaps, pressures;
  int hint = -1;
  const double radius = row.body_m / (2 * units::PI);
  for (const SectionSegment& s : chain.segments) {
    const collision::SignedDistance d = skin.signed_distance(s.a, 1.0, hint);
    if (d.triangle < 0) continue;
    hint = d.triangle;
    gaps.push_back(d.distance);
    const pattern::PanelInfo& panel = panel_of(garment, s.triangle);
    const Material& material = material_of(garment, panel.material);
    const double strain = s.rest > 1e-6 ? std::max(0.0, (s.b - s.a).norm() / s.rest - 1) : 0;
    const double tension = strain * std::min(material.stretch_warp_n_m, material.stretch_weft_n_m);
    pressures.push_back(d.distance < garment.offset_m + TOUCHING ? tension / radius : 0);
  }
  row.gap_p05_m = quantile(gaps, 0.05);
  row.gap_p50_m = quantile(gaps, 0.50);
  row.pressure_p95_pa = quantile(pressures, 0.95);
}

std::string centimetres(double m) {
  char text[32];
  std::snprintf(text, sizeof text, "%.1f cm", std::abs(m) * 100);
  return text;
}

std::string spoken(const std::string& girth) {
  std::string name = girth;
  std::replace(name.begin(), name.end(), '_', ' ');
  if (name.size() > 2 && name.compare(name.size() - 2, 2, " l") == 0) return "left " + name.substr(0, name.size() - 2);
  if (name.size() > 2 && name.compare(name.size() - 2, 2, " r") == 0) return "right " + name.substr(0, name.size() - 2);
  return name;
}

void judge(const FitLimits& limits, FitRow& row) {
  const double share = row.ease_m / row.body_m;
  if (share < limits.too_small_ease) {
    row.verdict = FitVerdict::TOO_SMALL;
    row.reason = "does not close at the " + spoken(row.name) + " by " + centimetres(row.ease_m);
  } else if (row.strain_girth > limits.too_small_strain) {
    row.verdict = FitVerdict::TOO_SMALL;
    row.reason = "is stretched by " + std::to_string(std::lround(100 * row.strain_girth)) + " % at the " + spoken(row.name);
  } else if (share < limits.tight_ease) {
    row.verdict = FitVerdict::TIGHT;
    row.reason = "is tight at the " + spoken(row.name) + ": " + (row.ease_m < 0 ? "-" : "") + centimetres(row.ease_m) + " of ease";
  } else if (share > limits.loose_ease) {
    row.verdict = FitVerdict::LOOSE;
    row.reason = "is loose at the " + spoken(row.name) + ": " + centimetres(row.ease_m) + " of ease";
  }
}

/// Spread of the landmarks that a level's height comes from.
double level_spread(const body::Body& body, const std::string& level) {
  const auto spread = [&](const std::string& landmark) { return body.has_landmark(landmark) ? body.landmarks.at(landmark).spread_m : 0.0; };
  if (level == "bust") return std::max(spread("bust_point_l"), spread("bust_point_r"));
  if (level == "chest_axilla") return std::max(spread("axilla_l"), spread("axilla_r"));
  if (level == "hip") return spread("buttock_back");
  if (level == "abdomen") return spread("abdomen_front");
  return spread(level);
}

std::vector<Place> places_of(const body::Body& body) {
  std::vector<Place> places;
  const auto torso = body.frames.find("torso");
  for (const auto& [name, level] : body.levels) {
    if (!(level.girth_m > 0)) continue;
    Place place{name, "level", Vec3(0, level.y, 0), Vec3::UnitY(), level.girth_m, 0.0, std::max(HEIGHT_ERROR, level_spread(body, name)), {}, {}};
    if (torso != body.frames.end()) {
      const PartFrame& f = torso->second.frame;
      place.center = f.lower + (f.upper - f.lower) * std::max(0.0, (level.y - f.lower.y()) / (f.upper.y() - f.lower.y()));
      place.center.y() = level.y;
    }
    places.push_back(place);
  }
  for (const std::string side : {"l", "r"}) {
    const std::string other = side == "l" ? "r" : "l";
    const auto add = [&](const std::string& name, const Vec3& center, const Vec3& normal, std::vector<std::string> frames, std::vector<Vec3> outside) {
      const auto found = body.girths.find(name + "_" + side);
      if (found == body.girths.end() || !(found->second.value_m > 0)) return;
      places.push_back(
          {name + "_" + side, "limb", center, normal, found->second.value_m, found->second.spread_m, HEIGHT_ERROR, std::move(frames), std::move(outside)});
    };
    const auto has = [&](const std::string& name) { return body.has_landmark(name + "_" + side); };
    const auto at = [&](const std::string& name) { return body.landmark(name + "_" + side); };
    const std::vector<std::string> arm = {"upper_arm_" + side, "forearm_" + side};
    if (has("shoulder_joint") && has("elbow"))
      add("upper_arm", 0.5 * (at("shoulder_joint") + at("elbow")), (at("shoulder_joint") - at("elbow")).normalized(), arm, {});
    if (has("wrist") && has("elbow")) add("wrist", at("wrist"), (at("elbow") - at("wrist")).normalized(), arm, {});
    // Legs are cut level, as the body's are; their cloth hangs on a leg or on the torso above it.
    const auto leg_point = [&](const std::string& s, double y) -> std::optional<Vec3> {
      const auto frame = body.frames.find("leg_" + s);
      if (frame == body.frames.end()) return std::nullopt;
      const PartFrame& f = frame->second.frame;
      return Vec3(f.lower + (f.upper - f.lower) * ((y - f.lower.y()) / (f.upper.y() - f.lower.y())));
    };
    const auto add_leg = [&](const std::string& name, double y) {
      const auto here = leg_point(side, y), there = leg_point(other, y);
      if (here) add(name, *here, Vec3::UnitY(), {}, there ? std::vector<Vec3>{*there} : std::vector<Vec3>{});
    };
    if (body.has_landmark("crotch")) add_leg("thigh", body.landmark("crotch").y() - 0.01);
    if (has("knee")) add_leg("knee", at("knee").y());
  }
  return places;
}

std::optional<FitRow> measure(const Garment& garment, const collision::BodyCollider& skin, const Place& place, std::string& why) {
  const std::vector<char> use = cloth_of(garment, place);
  const auto chain = line_around(garment, use, place, 0, why);
  if (!chain) return std::nullopt;
  FitRow row;
  row.name = place.name;
  row.kind = place.kind;
  row.height_m = place.center.y();
  row.body_m = place.body_m;
  row.open = !chain->closed;
  row.lying_m = girth(*chain, false);
  row.rest_m = girth(*chain, true);
  row.ease_m = row.rest_m - row.body_m;
  row.strain_girth = row.rest_m > 0 ? row.lying_m / row.rest_m - 1 : 0;
  measure_strain(garment, use, place, row);
  measure_contact(garment, skin, *chain, row);
  // How the girth changes within the error of the height, and a chord's shortfall against its arc (edge^2 / 24 r^2).
  double change = 0;
  for (const double shift : {-place.height_error_m, place.height_error_m}) {
    std::string ignored;
    if (const auto moved = line_around(garment, use, place, shift, ignored)) change = std::max(change, std::abs(girth(*moved, true) - row.rest_m));
  }
  const double radius = row.rest_m / (2 * units::PI), edge = row.rest_m / static_cast<double>(chain->segments.size());
  row.garment_uncertainty_m = std::hypot(change, row.rest_m * edge * edge / (24 * radius * radius));
  row.body_uncertainty_m = place.body_spread_m;
  row.ease_uncertainty_m = std::hypot(row.garment_uncertainty_m, row.body_uncertainty_m);
  return row;
}

} // namespace

FitReport fit_garment(const Garment& garment, const body::Body& body, const collision::BodyCollider& skin, const FitPolicy& policy) {
  if (garment.bind.empty()) throw input_error("", "/bind", "the garment is not bound to a body", "drape it on the body first");
  FitReport report;
  report.policy = policy.name;
  report.hem_height_m = 1e300, report.top_height_m = -1e300;
  for (const Vec3& p : garment.position) report.hem_height_m = std::min(report.hem_height_m, p.y()), report.top_height_m = std::max(report.top_height_m, p.y());
  std::set<std::string> measured;
  for (const Place& place : places_of(body)) {
    measured.insert(place.name);
    std::string why;
    auto row = measure(garment, skin, place, why);
    if (!row) {
      report.left_out.emplace_back(place.name, why);
      continue;
    }
    judge(policy.limits(row->name), *row);
    report.rows.push_back(std::move(*row));
  }
  for (const auto& [name, girth] : body.girths)
    if (!measured.count(name)) report.left_out.emplace_back(name, "where it was measured is not told by the body document");

  const FitRow* worst = nullptr;
  for (const FitRow& row : report.rows) {
    const bool worse = !worst || row.verdict > worst->verdict || (row.verdict == worst->verdict && row.ease_m / row.body_m < worst->ease_m / worst->body_m);
    if (worse) worst = &row;
  }
  if (!worst) {
    report.fits = false;
    report.reason = "goes round no girth of the body";
    return report;
  }
  report.verdict = worst->verdict;
  report.fits = !(report.verdict == FitVerdict::TOO_SMALL || (report.verdict == FitVerdict::TIGHT && policy.refuse_tight));
  report.reason = worst->reason;
  if (report.fits && policy.refuse_loose)
    for (const FitRow& row : report.rows)
      if (row.verdict == FitVerdict::LOOSE) report.fits = false, report.reason = row.reason;
  return report;
}

io::Json fit_json(const FitReport& report, const std::string& tool) {
  io::Json document = io::new_document("fit", 1, tool);
  document["fits"] = report.fits;
  document["verdict"] = verdict_name(report.verdict);
  document["reason"] = report.reason;
  document["policy"] = report.policy;
  document["hem_height_m"] = report.hem_height_m;
  document["top_height_m"] = report.top_height_m;
  document["girths"] = io::Json::object();
  for (const FitRow& r : report.rows) {
    io::Json j;
    j["kind"] = r.kind;
    j["height_m"] = r.height_m;
    j["body_m"] = {{"value", r.body_m}, {"uncertainty", r.body_uncertainty_m}};
    j["garment_m"] = {{"rest", r.rest_m}, {"lying", r.lying_m}, {"uncertainty", r.garment_uncertainty_m}};
    j["ease_cm"] = {{"value", 100 * r.ease_m}, {"uncertainty", 100 * r.ease_uncertainty_m}};
    j["ease_percent"] = 100 * r.ease_m / r.body_m;
    j["open"] = r.open;
    j["strain"] = {{"girth", r.strain_girth}, {"p99", r.strain_p99}, {"direction", r.strain_direction}};
    j["gap_m"] = {{"p05", r.gap_p05_m}, {"p50", r.gap_p50_m}};
    j["pressure_p95_pa"] = r.pressure_p95_pa;
    j["verdict"] = verdict_name(r.verdict);
    j["reason"] = r.reason;
    document["girths"][r.name] = j;
  }
  document["left_out"] = io::Json::object();
  for (const auto& [name, why] : report.left_out) document["left_out"][name] = why;
  return document;
}

} // namespace sloper::garment
