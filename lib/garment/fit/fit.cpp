#include <sloper/base/statistics.hpp>
#include <sloper/base/text.hpp>
#include <sloper/garment/fit/fit.hpp>

#include <garment/fit/fit_measure.hpp>
#include <garment/fit/fit_probability.hpp>
#include <garment/fit/garment_regions.hpp>
#include <garment/fit/judge_strain.hpp>
#include <sloper/base/error.hpp>
#include <sloper/base/units.hpp>
#include <sloper/garment/materials.hpp>
#include <sloper/garment/simulate/roll_line_states.hpp>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>
#include <set>

namespace sloper::garment {

namespace {

constexpr double REACH_BEYOND = 0.03; // m above and below a level that cloth must reach, or it may
                                      // slide to where it is wide enough
constexpr double SLIDE_BEYOND =
    0.06; // m as far as cloth that is tight slides at most: three times what was seen, it holds on
constexpr double SLIDE_STRIDE = 0.01; // m between sections of the skin on that path
constexpr double SLID = 0.10;   // m that what hangs from the waist may sink wherever it is; held by
                                // the hip it may more, and that is said
constexpr double TRAILS = 0.01; // m below the soles: such a hem is trodden on
constexpr double CERTAIN_SLIP = 1.1; // of what the policy bears: what has sunk so far does not rise
constexpr double CERTAIN_STRAIN = 1.5; // of what the policy bears: cloth that seems still was seen
                                       // to creep down by a quarter until it was at rest
constexpr double OVER_THE_HAND = 0.02; // m beyond the wrist from which a cuff lies on the hand
/// Why the free edge of a turned collar has no row.
constexpr const char* TURNED_LEAF =
    "it lies on cloth that is turned over, and does not go round the neck";
constexpr double NOT_AT_REST = 0.01; // m that a drape which did not come to rest may still move

/// How large a length is, whatever its sign.
std::string centimetres(double m) {
  return sloper::centimetres(std::abs(m));
}

/// Why a girth is too small. @param goes_round  it was seen to close, stretched
std::string too_small(const FitRow& row, bool goes_round) {
  const std::string where = " at the " + spoken_girth(row.name);
  if (row.ease_m >= 0)
    return "has too little ease" + where + ": " + centimetres(row.ease_m); // a policy asks for some
  const double cloth = row.rest_m - row.bridged_m;
  if (!(cloth > 0))
    return "does not close" + where + " by " + centimetres(row.ease_m);
  if (goes_round)
    return "closes" + where + " only stretched by " +
           whole_percent((row.lying_m - row.rest_m) / cloth) + ": it is " +
           centimetres(row.ease_m) + " too small there";
  return "does not close" + where + " by " + centimetres(row.ease_m) +
         " unless it is stretched by " + whole_percent(-row.ease_m / cloth);
}

/// The limits of a girth, as far as what the garment was cut for and how it was worn move them.
void take_limits(const FitPolicy& policy, const FitReport& report,
                 const std::map<std::string, double>& made_for, FitRow& row) {
  FitLimits& limits = row.limits;
  limits = policy.limits(row.name, report.garment_class, report.fabric);
  limits.too_small_strain = policy.too_small_strain(limits, row.worn_strain, row.name,
                                                    report.garment_class, report.fabric);
  const auto designed_with = [&](double ease) {
    row.cut_ease = ease;
    limits.too_large_ease =
        policy.too_large_ease(limits, ease, row.name, report.garment_class, report.fabric);
    limits.too_small_ease =
        policy.too_small_ease(limits, ease, row.name, report.garment_class, report.fabric);
  };
  for (const std::string& known : {row.name, "level:" + row.name})
    if (const auto girth = made_for.find(known); girth != made_for.end())
      designed_with((row.body_m + row.ease_m) / girth->second - 1);
  if (row.worn_strain > 0) // as much smaller as it was stretched there
    limits.too_small_ease = policy.too_small_ease(limits, 1 / (1 + row.worn_strain) - 1, row.name,
                                                  report.garment_class, report.fabric);
  if (!policy.worn_here)
    return;
  const auto here = policy.worn_here->find(row.name);
  if (here != policy.worn_here->end())
    designed_with(here->second);
}

/// @param at_rest  strain is a fact only of cloth at rest
void judge(bool at_rest, FitRow& row) {
  const FitLimits& limits = row.limits;
  const double share = row.ease_m / row.body_m;
  row.margin_m = std::min(row.ease_m - limits.tight_ease * row.body_m,
                          limits.loose_ease * row.body_m - row.ease_m);
  if (share < limits.too_small_ease) {
    row.verdict = FitVerdict::TOO_SMALL;
    row.rule = {"too_small_ease", limits.too_small_ease};
    row.reason = too_small(row, at_rest && row.lying_m >= GOES_ROUND * row.body_m);
  } else if (at_rest && row.strain_girth > limits.too_small_strain) {
    row.verdict = FitVerdict::TOO_SMALL;
    row.rule = {"too_small_strain", limits.too_small_strain};
    row.reason =
        "is stretched by " + whole_percent(row.strain_girth) + " at the " + spoken_girth(row.name);
  } else if (share < limits.tight_ease) {
    row.verdict = FitVerdict::TIGHT;
    row.rule = {"tight_ease", limits.tight_ease};
    row.reason = "is tight at the " + spoken_girth(row.name) + ": " + (row.ease_m < 0 ? "-" : "") +
                 centimetres(row.ease_m) + " of ease";
  } else if (share > limits.too_large_ease) {
    row.verdict = FitVerdict::TOO_LARGE;
    row.rule = {"too_large_ease", limits.too_large_ease};
    row.reason = "is too large at the " + spoken_girth(row.name) + ": " + centimetres(row.ease_m) +
                 " of ease";
  } else if (share > limits.loose_ease) {
    row.verdict = FitVerdict::LOOSE;
    row.rule = {"loose_ease", limits.loose_ease};
    row.reason = "is loose at the " + spoken_girth(row.name) + ": " + centimetres(row.ease_m) +
                 " of ease" +
                 (row.cut_ease.value_or(0) > limits.loose_ease ? ", as it was cut" : "");
  }
}

void measure_regions(const ClothState& cloth, const std::vector<std::string>& region,
                     FitReport& report) {
  std::map<std::string, std::vector<int>> triangles;
  for (std::size_t f = 0; f < cloth.strains.size(); ++f) {
    const Triangle& t = cloth.garment.panels.triangles[f];
    const auto at = [&](int k) -> const std::string& {
      return region[cloth.garment.particle_of[t[k]]];
    };
    if (at(0) == at(1) && at(1) == at(2))
      triangles[at(0)].push_back(static_cast<int>(f));
  }
  for (const auto& [name, list] : triangles) {
    const StrainFigures figures = strain_of(cloth, list);
    report.regions.push_back({name, static_cast<int>(figures.n), figures.p50, figures.p99,
                              figures.max, figures.direction});
  }
}

/// A cuff that is too small because it lies on the hand: that the sleeve is too long is the reason.
void tell_long_sleeve(const FitLines& lines, FitRow& row) {
  if (row.verdict != FitVerdict::TOO_SMALL || row.name.rfind("sleeve_hem_", 0) != 0)
    return;
  const std::string sleeve = "sleeve_" + row.name.substr(row.name.size() - 1);
  const auto share = lines.coverage.find(sleeve);
  if (share == lines.coverage.end() || share->second <= 1)
    return;
  const double beyond = lines.coverage_m.at(sleeve) * (1 - 1 / share->second);
  if (beyond > OVER_THE_HAND)
    row.reason = "has the " + spoken_girth(row.name) + " " + centimetres(beyond) +
                 " beyond the wrist, on the hand, where it is " + centimetres(row.ease_m) +
                 " too small";
}

bool hangs_from_waist(const FitReport& report) {
  return report.garment_class == "skirt" || report.garment_class == "trousers";
}

/// A waistband slides down to where the body is as wide as itself: what hangs from the waist falls
/// off where its top edge has come below the level of the hip. m from where it was placed, of which
/// `report` tells how far it is.
double slip_borne(const FitPolicy& policy, const FitLines& lines, const body::Body& body,
                  const FitReport& report) {
  const double said = policy.slip_m(report.garment_class, report.fabric);
  if (!hangs_from_waist(report))
    return said;
  const auto top = std::find_if(lines.hems.begin(), lines.hems.end(),
                                [](const FitHem& hem) { return hem.name == "top"; });
  const auto hip = body.levels.find("hip");
  if (top == lines.hems.end() || hip == body.levels.end())
    return std::min(said, SLID);
  return std::min(said, std::max(SLID, report.slip_m + top->height_m - hip->second.y));
}

/// Height of the lowest skin of the legs, m.
double soles_of(const body::Body& body) {
  double y = 1e300;
  for (std::size_t f = 0; f < body.face_part.size(); ++f)
    if (body.face_part[f] == body::Part::LEG_L || body.face_part[f] == body::Part::LEG_R)
      for (int v : body.skin.triangles[f])
        y = std::min(y, body.skin.positions[v].y());
  return y;
}

/// The verdict of all rows, the strain, the slip and the length.
void conclude(const FitPolicy& policy, const std::string& unfit, FitReport& report) {
  const FitRow* worst = nullptr;
  for (const FitRow& row : report.rows) {
    const bool worse = !worst || row.verdict > worst->verdict ||
                       (row.verdict == worst->verdict &&
                        row.margin_m / row.body_m < worst->margin_m / worst->body_m);
    if (worse)
      worst = &row;
    if (&row == report.rows.data() || row.margin_m < report.margin_m) {
      report.margin_m = row.margin_m;
      report.margin_at = row.name;
    }
  }
  const bool slips = report.slip_m > report.slip_borne_m;
  const std::string slides_down = "slides down by " + centimetres(report.slip_m);
  const FitRule slip_rule{"slip_m", report.slip_borne_m};
  if (!worst && (slips || (!policy.worn_here &&
                           !std::isfinite(
                               report.slip_borne_m)))) { // it has slid off all of them, or may have
    report.fits = false;
    report.verdict = FitVerdict::TOO_LARGE;
    report.reason = slips ? slides_down : "does not go around any girth of the body";
    if (slips)
      report.rule = slip_rule;
    return;
  }
  report.verdict = worst ? worst->verdict : FitVerdict::OK; // an apron goes round none
  if (worst)
    report.rule = worst->rule;
  report.reason =
      worst ? worst->reason
            : "does not go around any girth of the body: only strain and slip were judged";
  const bool certain = report.convergence_m == 0 || !unfit.empty();
  if (certain)
    judge_strain(policy, report);
  if (certain && report.verdict <= FitVerdict::TOO_LARGE && slips) {
    report.verdict = FitVerdict::TOO_LARGE;
    report.reason = slides_down;
    report.rule = slip_rule;
  } else if (certain && report.verdict <= FitVerdict::LOOSE && hangs_from_waist(report) &&
             report.slip_m > SLID) {
    report.verdict = FitVerdict::LOOSE;
    report.reason = slides_down + " to where the hip holds it";
  } else if (certain && report.verdict <= FitVerdict::LOOSE && report.below_soles_m > TRAILS) {
    report.verdict = FitVerdict::LOOSE;
    report.reason =
        "is too long: it reaches " + centimetres(report.below_soles_m) + " below the soles";
  }
  report.fits = report.verdict < FitVerdict::TOO_LARGE &&
                !(report.verdict == FitVerdict::TIGHT && policy.refuse_tight);
  if (report.fits && policy.refuse_loose && report.verdict == FitVerdict::LOOSE)
    report.fits = false;
  if (report.fits && policy.refuse_loose) // behind a tight one
    for (const FitRow& row : report.rows)
      if (row.verdict == FitVerdict::LOOSE) {
        report.fits = false;
        report.reason = row.reason;
        report.rule = row.rule;
      }
  if (report.fits && !unfit.empty()) { // measured where it was then, it might be of another class,
                                       // with limits of its own
    report.fits = false;
    report.verdict = FitVerdict::TOO_LARGE;
    report.reason = unfit.rfind("does not close", 0) == 0 ? unfit : unfit + " too far to fit";
  }
}

/// What draping the same garment again changes belongs to the uncertainty.
void add_redrape_spread(const Redrapes& redrapes, FitReport& report) {
  for (FitRow& row : report.rows) {
    const auto found = redrapes.girths.find(row.name);
    if (found == redrapes.girths.end())
      continue;
    const Redrapes::Row& sd = found->second;
    row.garment_uncertainty_m = std::hypot(row.garment_uncertainty_m, sd.ease_m);
    row.ease_uncertainty_m = std::hypot(row.ease_uncertainty_m, sd.ease_m);
    row.strain_uncertainty = std::hypot(row.strain_uncertainty, sd.strain);
    row.gap_uncertainty_m = std::hypot(row.gap_uncertainty_m, sd.gap_m);
  }
  for (FitHem& hem : report.lines.hems)
    if (const auto found = redrapes.hems_m.find(hem.name); found != redrapes.hems_m.end())
      hem.uncertainty_m = std::hypot(hem.uncertainty_m, found->second);
}

} // namespace

FitReport fit_garment(const Garment& garment, const body::Body& body,
                      const collision::BodyCollider& skin, const FitPolicy& policy,
                      const FitHistory& history) {
  if (garment.bind.empty())
    throw input_error("garment.not-bound"_id, "", "/bind", "the garment is not bound to a body",
                      "drape it on the body first");
  FitReport report;
  report.policy = policy.name;
  report.fabric = main_material(garment);
  report.convergence_m = garment.converged ? 0 : NOT_AT_REST;
  report.state = garment.converged ? "at rest" : "not at rest";
  report.hem_height_m = 1e300;
  report.top_height_m = -1e300;
  for (const Vec3& p : garment.position) {
    report.hem_height_m = std::min(report.hem_height_m, p.y());
    report.top_height_m = std::max(report.top_height_m, p.y());
  }
  if (body.has_landmark("foot_tip_l") || body.has_landmark("foot_tip_r"))
    report.below_soles_m = std::max(0.0, soles_of(body) - report.hem_height_m);
  if (history.placed) {
    std::vector<double> sunk;
    for (std::size_t i = 0; i < history.placed->size(); ++i)
      sunk.push_back((*history.placed)[i].y() - garment.position[i].y());
    report.slip_m = sunk.empty() ? 0 : upper_median(sunk);
  }
  const std::vector<std::string> region = regions_of(garment, body);
  report.garment_class = class_of(region);
  const ClothState cloth(garment, skin);
  measure_regions(cloth, region, report);
  std::vector<int> all(cloth.strains.size());
  std::iota(all.begin(), all.end(), 0);
  const StrainFigures total = strain_of(cloth, all);
  report.strain_p99 = total.p99;
  report.strain_max = total.max;

  std::set<std::string> measured;
  std::string why;
  const auto add = [&](std::optional<FitRow> row, const std::string& name) {
    if (!row) {
      if (!why.empty())
        report.left_out.emplace_back(name, why);
      return;
    }
    take_limits(policy, report, history.made_for, *row);
    if (const auto ease = history.source_ease_m.find(row->name);
        ease != history.source_ease_m.end())
      row->source_ease_m = ease->second;
    judge(garment.converged, *row);
    tell_long_sleeve(report.lines, *row);
    report.rows.push_back(std::move(*row));
  };
  for (const FitPlace& place : fit_places(body)) {
    measured.insert(place.name);
    add(measure_place(cloth, place, report.convergence_m, why, history.source), place.name);
  }
  report.lines = fit_lines(garment, body);
  report.lengths =
      fit_lengths(report.lines.hems, garment.bind, history.source_bind, body, report.convergence_m);
  const std::vector<RollLineState> rolled = roll_line_states(garment);
  for (const FitHem& hem : report.lines.hems) {
    if (lies_on_turned_leaf(garment, hem, rolled)) {
      report.left_out.emplace_back(hem.name + " edge", TURNED_LEAF);
      continue;
    }
    add(measure_edge(cloth, body, hem, report.convergence_m, why, history.source),
        hem.name + " edge");
  }
  for (const auto& [name, girth] : body.girths)
    if (!measured.count(name))
      report.left_out.emplace_back(name, "the body document does not say where it was measured");
  add_redrape_spread(garment.redrapes, report);
  if (history.placed)
    report.slip_borne_m = slip_borne(policy, report.lines, body, report);
  conclude(policy, history.unfit, report);
  report.strain_unknown = garment.strain_unknown;
  take_probability(policy, history.made_for, garment.converged || !history.unfit.empty(), report);
  return report;
}

FitReport fit_before_drape(const Garment& garment, const std::vector<Vec3>& source_position,
                           const body::Body& body, const FitPolicy& policy) {
  FitReport report;
  report.policy = policy.name;
  report.state = "placed";
  report.fabric = main_material(garment);
  const std::vector<std::string> region = regions_of(garment, body);
  report.garment_class = class_of(region);
  double worst = 0;
  const auto refuse = [&](const FitPlace& place, const SectionLine& line, const FitLimits& limits,
                          double missing) {
    FitRow row;
    row.name = place.name;
    row.kind = place.kind;
    row.height_m = place.center.y();
    row.body_m = place.body_m;
    row.rest_m = line.rest;
    row.lying_m = line.lying;
    row.ease_m = row.rest_m - row.body_m;
    row.bridged_m = line.bridged;
    row.open = !line.closed();
    row.body_uncertainty_m = row.ease_uncertainty_m = place.body_spread_m;
    row.margin_m = row.ease_m;
    row.short_m = missing;
    row.limits = limits;
    row.verdict = FitVerdict::TOO_SMALL;
    row.rule = {"too_small_ease", limits.too_small_ease};
    row.reason = too_small(row, false);
    report.fits = false;
    report.verdict = row.verdict;
    if (missing / place.body_m > worst) {
      worst = missing / place.body_m;
      report.reason = row.reason;
      report.margin_m = row.margin_m;
      report.margin_at = row.name;
      report.rule = row.rule;
    }
    report.rows.push_back(std::move(row));
  };
  const auto accept = [&](const FitPlace& place, const SectionLine& line, const FitLimits& limits) {
    if (worst == 0)
      report.margin_m =
          std::min(report.margin_m, line.rest - (1 + limits.tight_ease) * place.body_m);
  };
  for (const FitPlace& place : fit_places(body)) {
    if (place.kind == "neck")
      continue; // a collar slides to where it is wide enough
    const std::vector<char> use = cloth_of(garment, place);
    const FitLimits limits = policy.limits(place.name, report.garment_class, report.fabric);
    const double least = place.body_m - place.body_spread_m;
    // Fits if, at the largest strain that the policy bears, it closes around a level within a small
    // shift; or, unstretched, at any level it can slide to.
    std::optional<SectionLine> line;
    double beyond_stretch = 1e300, beyond_rest = 1e300;
    const auto look = [&](double shift) {
      std::string why;
      line = line_around(garment, use, place, shift, why, &source_position);
      if (!line)
        return false;
      const double elsewhere = line->elsewhere - line->bridged, rest = line->rest - line->bridged;
      if (std::abs(shift) <= REACH_BEYOND)
        beyond_stretch = std::min(
            beyond_stretch,
            least - std::max(rest * (1 + limits.too_small_strain), elsewhere) - line->bridged);
      beyond_rest = std::min(beyond_rest, (1 + limits.too_small_ease) * least -
                                              std::max(line->rest, line->elsewhere));
      return true;
    };
    if (!look(-REACH_BEYOND) || !look(REACH_BEYOND) || !look(0))
      continue;
    if (beyond_rest > 0 && !(look(-SLIDE_BEYOND) && look(SLIDE_BEYOND)))
      beyond_rest = 0;
    if (!look(0) || is_bridged_through(place, *line))
      continue;
    const double missing = std::max(beyond_stretch, beyond_rest);
    if (missing > 0)
      refuse(place, *line, limits, missing);
    else
      accept(place, *line, limits);
  }
  const FitLines lines = fit_lines(garment, body);
  report.slip_borne_m = slip_borne(policy, lines, body, report);
  for (const FitHem& hem : lines.hems) {
    if (hem.name != "top")
      continue; // others slide along a limb, over a hand or a foot
    std::string why;
    const auto edge = edge_line(garment, body, hem, why);
    if (!edge)
      continue;
    const FitPlace& place = edge->place;
    const FitLimits limits = policy.limits(place.name, report.garment_class, report.fabric);
    double least = place.body_m, elsewhere = 0;
    for (double shift = -SLIDE_BEYOND; shift <= SLIDE_BEYOND; shift += SLIDE_STRIDE)
      least = std::min(
          least, skin_girth(body, edge->parts, place.center + shift * place.normal, place.normal));
    for (std::size_t i = 0; i < edge->particles.size(); ++i)
      elsewhere += (source_position[edge->particles[i]] -
                    source_position[edge->particles[(i + 1) % edge->particles.size()]])
                       .norm();
    const double missing = (1 + limits.too_small_ease) * (least - place.body_spread_m) -
                           std::max(edge->line.rest, elsewhere);
    if (missing > 0)
      refuse(place, edge->line, limits, missing);
    else
      accept(place, edge->line, limits);
  }
  take_probability(policy, {}, false, report);
  return report;
}

FitBounds early_termination_bounds(const FitPolicy& policy, const FitReport& before) {
  return {CERTAIN_SLIP * before.slip_borne_m,
          CERTAIN_STRAIN * policy.strain_p99(before.garment_class, before.fabric),
          before.margin_m < 0};
}

FitReport impossible_fit(const std::string& reason, const FitPolicy& policy) {
  FitReport report;
  report.policy = policy.name;
  report.state = "not placed";
  report.fits = false;
  report.verdict = FitVerdict::IMPOSSIBLE;
  report.reason = reason;
  report.probability.fits = 0;
  return report;
}

} // namespace sloper::garment
