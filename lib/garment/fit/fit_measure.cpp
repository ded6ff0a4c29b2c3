#include <garment/fit/fit_measure.hpp>
#include <sloper/base/statistics.hpp>

#include <sloper/base/units.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace sloper::garment {

namespace {

constexpr double AROUND =
    0.75; // turns about the axis from which a line of cloth counts as going round
constexpr double LARGEST_OPEN = 0.4; // turns that arms and openings may leave bare of a trunk level
constexpr double BAND = 0.02;        // m on both sides of the cut in which strain is taken
constexpr double EDGE_HEIGHT = 0.005; // m by which the plane of a free edge is uncertain
constexpr double SLANT = 0.05; // of a neck line that it may change within the error of its height
constexpr double LEAST_ROUND =
    0.3; // of a circle's area at the same length: less is the rim of a flat piece or crumpled cloth
constexpr double STEEPEST = 0.5; // upward part of the normal of an edge round the trunk: a panel
                                 // that nothing is sewn to stands upright
constexpr double GATHERED =
    0.2; // of a line that it is shorter than its cloth: fold by fold cloth is
         // as long as it lies, and only stitches hold it pressed together
constexpr double WIDER_THAN_NECK =
    1.2; // of the neck base: a section this long goes through the shoulders

double quantile(std::vector<double>& values, double q) {
  return values.empty() ? 0 : lower_quantile(values, q);
}

FitRow row_of(const FitPlace& place, const SectionLine& line) {
  FitRow row;
  row.name = place.name;
  row.kind = place.kind;
  row.height_m = place.center.y();
  row.body_m = place.body_m;
  row.open = !line.closed();
  row.bridged_m = line.bridged;
  row.lying_m = line.lying;
  row.rest_m = line.rest;
  row.strain_girth = row.rest_m > 0 ? row.lying_m / row.rest_m - 1 : 0;
  row.gathered = row.strain_girth < -GATHERED;
  row.ease_m = (row.gathered ? row.lying_m : row.rest_m) - row.body_m;
  return row;
}

/// @param other  the same of fewer or more triangles: how much the figure depends on which are
/// taken
void take_strain(const StrainFigures& strain, const StrainFigures& other, FitRow& row) {
  row.strain_p99 = strain.p99;
  row.strain_direction = strain.direction;
  row.strain_uncertainty = std::abs(strain.p99 - other.p99);
}

/// Gap and pressure along the line, and what all figures are uncertain by.
/// @param change  m, of the garment's girth within the error of the place
void finish_row(const ClothState& cloth, const FitPlace& place, const SectionLine& line,
                double change, double convergence, FitRow& row) {
  // A chord falls short of its arc by edge^2 / 24 r^2 of its length, and lies edge^2 / 8 r inside
  // it.
  const double radius = row.rest_m / (2 * units::PI),
               edge = row.rest_m / static_cast<double>(std::max<std::size_t>(line.n_segments(), 1));
  row.garment_uncertainty_m =
      std::hypot(change, row.rest_m * edge * edge / (24 * radius * radius), convergence);
  row.body_uncertainty_m = place.body_spread_m;
  row.ease_uncertainty_m = std::hypot(row.garment_uncertainty_m, row.body_uncertainty_m);
  row.gap_uncertainty_m = std::hypot(edge * edge / (8 * radius), convergence);
  std::vector<double> gaps, pressures;
  int hint = -1;
  for (const SectionChain& chain : line.chains)
    for (const SectionSegment& s : chain.segments) {
      pressures.push_back(cloth.pressures[s.triangle]);
      const collision::SignedDistance d = cloth.skin.signed_distance(s.a, 1.0, hint);
      if (d.triangle < 0)
        continue;
      hint = d.triangle;
      gaps.push_back(d.distance);
    }
  row.gap_p05_m = quantile(gaps, 0.05);
  row.gap_p50_m = quantile(gaps, 0.50);
  row.pressure_p95_pa = quantile(pressures, 0.95);
  // As the strain that it comes from.
  const double strain = std::max(row.strain_p99, 1e-6);
  row.pressure_uncertainty_pa =
      row.pressure_p95_pa * std::min(1.0, row.strain_uncertainty / strain);
}

/// A loop's particles in order, or nothing where it is no simple one.
std::vector<int> in_order(const std::vector<std::array<int, 2>>& edges) {
  std::map<int, std::vector<int>> next;
  for (const auto& e : edges) {
    next[e[0]].push_back(e[1]);
    next[e[1]].push_back(e[0]);
  }
  for (const auto& [particle, others] : next)
    if (others.size() != 2)
      return {};
  std::vector<int> loop{next.begin()->first};
  for (int last = -1; loop.size() <= edges.size();) {
    const std::vector<int>& others = next[loop.back()];
    const int to = others[0] == last ? others[1] : others[0];
    if (to == loop.front())
      break;
    last = loop.back();
    loop.push_back(to);
  }
  return loop.size() == edges.size() ? loop : std::vector<int>{};
}

/// The edge's line with its triangles and rest lengths.
SectionLine line_of(const Garment& garment, const std::vector<int>& loop) {
  struct Side {
    int triangle;
    double rest;
  };
  std::map<std::array<int, 2>, Side> sides;
  for (std::size_t i = 0; i < loop.size(); ++i) {
    const int a = loop[i], b = loop[(i + 1) % loop.size()];
    sides[{std::min(a, b), std::max(a, b)}] = {-1, 0};
  }
  for (std::size_t f = 0; f < garment.panels.triangles.size(); ++f)
    for (int k = 0; k < 3; ++k) {
      const int u = garment.panels.triangles[f][k], v = garment.panels.triangles[f][(k + 1) % 3];
      const auto found = sides.find({std::min(garment.particle_of[u], garment.particle_of[v]),
                                     std::max(garment.particle_of[u], garment.particle_of[v])});
      if (found == sides.end())
        continue;
      const double scale = garment.rest_scale.empty() ? 1 : garment.rest_scale[f][k];
      found->second = {static_cast<int>(f),
                       scale * (garment.panels.pattern[v] - garment.panels.pattern[u]).norm()};
    }
  SectionChain chain;
  chain.closed = true;
  for (std::size_t i = 0; i < loop.size(); ++i) {
    const int a = loop[i], b = loop[(i + 1) % loop.size()];
    const Side& side = sides.at({std::min(a, b), std::max(a, b)});
    chain.segments.push_back({side.triangle, garment.position[a], garment.position[b], side.rest});
    chain.length += (garment.position[b] - garment.position[a]).norm();
    chain.rest_length += side.rest;
  }
  SectionLine line;
  line.lying = chain.length;
  line.rest = chain.rest_length;
  line.chains.push_back(std::move(chain));
  return line;
}

/// What a free edge goes round, by the name of its hem.
struct EdgeKind {
  const char *hem, *row;
  std::vector<body::Part> parts;
};
const EdgeKind* kind_of(const std::string& hem) {
  using body::Part;
  static const std::vector<EdgeKind> KINDS = {
      {"neck", "neck_edge", {Part::HEAD, Part::TORSO}},
      {"left sleeve", "sleeve_hem_l", {Part::ARM_L}},
      {"right sleeve", "sleeve_hem_r", {Part::ARM_R}},
      {"left leg", "leg_hem_l", {Part::LEG_L}},
      {"right leg", "leg_hem_r", {Part::LEG_R}},
      {"top", "top_edge", {Part::TORSO, Part::LEG_L, Part::LEG_R}}};
  for (const EdgeKind& kind : KINDS)
    if (hem == kind.hem)
      return &kind;
  return nullptr;
}

/// Whether a line is open where cloth was left out, as at an arm.
bool ends_at_left_out(const Garment& garment, const std::vector<char>& use,
                      const SectionLine& line) {
  std::vector<char> left_out(garment.position.size(), 0);
  for (std::size_t f = 0; f < use.size(); ++f)
    for (int k = 0; k < 3 && !use[f]; ++k)
      left_out[garment.particle_of[garment.panels.triangles[f][k]]] = 1;
  const auto borders = [&](const SectionSegment& s) {
    const Triangle& t = garment.panels.triangles[s.triangle];
    return std::any_of(t.begin(), t.end(), [&](int v) { return left_out[garment.particle_of[v]]; });
  };
  return std::any_of(line.chains.begin(), line.chains.end(), [&](const SectionChain& c) {
    return borders(c.segments.front()) || borders(c.segments.back());
  });
}

/// Triangles that have a particle of the set; the set grows by theirs.
std::vector<int> ring_of(const Garment& garment, std::vector<char>& in) {
  std::vector<int> ring;
  for (std::size_t f = 0; f < garment.panels.triangles.size(); ++f) {
    const Triangle& t = garment.panels.triangles[f];
    if (std::any_of(t.begin(), t.end(), [&](int v) { return in[garment.particle_of[v]]; }))
      ring.push_back(static_cast<int>(f));
  }
  for (const int f : ring)
    for (const int v : garment.panels.triangles[f])
      in[garment.particle_of[v]] = 1;
  return ring;
}

} // namespace

StrainFigures strain_of(const ClothState& cloth, const std::vector<int>& triangles) {
  StrainFigures figures;
  std::vector<Weighted> values;
  for (const int f : triangles)
    if (const TriangleStrain& s = cloth.strains[f]; s.area > 0)
      values.push_back({s.thread(), s.area});
  figures.n = values.size();
  if (values.empty())
    return figures;
  figures.p50 = area_quantile(values, 0.5);
  figures.p99 = area_quantile(values, 0.99);
  figures.max = values.front().value;
  for (const auto& place : strains_around(cloth.garment, cloth.strains, triangles))
    if (place)
      figures.max = std::max(figures.max, *place);
  double warp = 0, weft = 0;
  for (const int f : triangles)
    if (const TriangleStrain& s = cloth.strains[f]; s.area > 0 && s.thread() >= figures.p99)
      (s.thread() == s.warp ? warp : weft) += s.area;
  figures.direction = warp > weft ? "warp" : "weft";
  return figures;
}

std::optional<SectionLine> line_around(const Garment& garment, const std::vector<char>& use,
                                       const FitPlace& place, double shift, std::string& why,
                                       const std::vector<Vec3>* elsewhere) {
  const Vec3 center = place.center + shift * place.normal;
  std::vector<SectionChain> chains = cut_garment(garment, use, center, place.normal, elsewhere);
  why = chains.empty() ? "the garment does not reach it" : "the garment does not go round it";
  const SectionChain* best = nullptr;
  bool is_divided = false;
  for (const SectionChain& chain : chains) {
    if (chain.turns(center, place.normal) < AROUND)
      continue;
    if (std::any_of(place.inside.begin(), place.inside.end(),
                    [&](const Vec3& axis) { return chain.turns(axis, place.normal) < AROUND; })) {
      is_divided = true;
      continue;
    }
    const bool both = std::any_of(place.outside.begin(), place.outside.end(), [&](const Vec3& o) {
      return chain.turns(o, place.normal) > AROUND;
    });
    if (both) {
      if (!best)
        why = "the garment goes round both legs there";
      continue;
    }
    if (!best || chain.rest_length < best->rest_length)
      best = &chain;
  }
  if (best) {
    SectionLine line;
    line.bridged = best->closed ? 0 : best->opening;
    line.lying = best->length + line.bridged;
    line.rest = best->rest_length + line.bridged;
    line.elsewhere = best->elsewhere + line.bridged;
    line.chains.push_back(*best);
    return line;
  }
  if (is_divided)
    why = "the cloth divides into legs there";
  if (place.kind != "level" || is_divided)
    return std::nullopt;
  return assemble_line(std::move(chains), center, place.normal, LARGEST_OPEN);
}

bool is_bridged_through(const FitPlace& place, const SectionLine& line) {
  return line.bridged > 0 && line.lying < GOES_ROUND * (place.body_m - place.body_spread_m);
}

std::optional<FitRow> measure_place(const ClothState& cloth, const FitPlace& place,
                                    double convergence, std::string& why,
                                    const std::vector<Vec3>* source) {
  const Garment& garment = cloth.garment;
  const std::vector<char> use = cloth_of(garment, place);
  const auto line = line_around(garment, use, place, 0, why, source);
  if (!line)
    return std::nullopt;
  FitRow row = row_of(place, *line);
  if (source && line->rest > 0)
    row.worn_strain = line->elsewhere / line->rest - 1;
  const auto within = [&](double band) {
    std::vector<int> near;
    for (std::size_t f = 0; f < use.size(); ++f) {
      Vec3 middle = Vec3::Zero();
      for (const int v : garment.panels.triangles[f])
        middle += garment.position[garment.particle_of[v]] / 3;
      if (use[f] && std::abs((middle - place.center).dot(place.normal)) <= band)
        near.push_back(static_cast<int>(f));
    }
    return strain_of(cloth, near);
  };
  take_strain(within(BAND), within(0.5 * BAND), row);
  // How the girth changes within the error of the height, and how much wider it opens: openings
  // whose sides lie flatter than 45 degrees, above the level and below it, are a hem that crosses
  // it, and the bridges over them cut through the body. An arm pit just above the level opens on
  // one side alone.
  const bool cut_open =
      row.open && (line->chains.size() == 1 || !ends_at_left_out(garment, use, *line));
  double change = 0, widens = std::numeric_limits<double>::infinity();
  for (const double shift : {-place.height_error_m, place.height_error_m}) {
    std::string ignored;
    const auto moved = line_around(garment, use, place, shift, ignored);
    if (moved)
      change = std::max(change, std::abs(moved->rest - row.rest_m));
    if (moved)
      widens = std::min(widens, std::abs(moved->bridged - line->bridged));
  }
  if (cut_open && widens > 2 * place.height_error_m * static_cast<double>(line->chains.size()))
    return why = "a hem crosses it", std::nullopt;
  if (is_bridged_through(place, *line))
    return why = "the bridge over its opening cuts through the body", std::nullopt;
  if (place.kind == "neck" && change > SLANT * row.rest_m)
    return why = "the cloth crosses it at a slant", std::nullopt; // shoulders, not a neck
  finish_row(cloth, place, *line, change, convergence, row);
  return row;
}

std::optional<EdgeLine> edge_line(const Garment& garment, const body::Body& body, const FitHem& hem,
                                  std::string& why) {
  why.clear();
  const EdgeKind* kind = kind_of(hem.name);
  if (!kind)
    return std::nullopt;
  EdgeLine edge{{kind->row, "edge", Vec3::Zero(), Vec3::Zero(), 0, 0, EDGE_HEIGHT, {}, {}},
                {},
                kind->parts,
                in_order(hem.edges)};
  FitPlace& place = edge.place;
  const std::vector<int>& loop = edge.particles;
  if (loop.empty())
    return std::nullopt;
  for (const int p : loop)
    place.center += garment.position[p] / static_cast<double>(loop.size());
  for (std::size_t i = 0; i < loop.size(); ++i)
    place.normal += (garment.position[loop[i]] - place.center)
                        .cross(garment.position[loop[(i + 1) % loop.size()]] - place.center);
  edge.line = line_of(garment, loop);
  const double round = 2 * units::PI * place.normal.norm() /
                       (edge.line.lying * edge.line.lying); // 4 pi area / length^2: 1 for a circle
  if (!(round > LEAST_ROUND))
    return why = "its edge does not go around the body", std::nullopt;
  place.normal = (place.normal.y() < 0 ? Vec3(-place.normal) : place.normal).normalized();
  const bool of_limb = kind->parts.size() == 1;
  if (!of_limb && place.normal.y() < STEEPEST)
    return why = "its edge does not go round the trunk", std::nullopt;
  place.body_m = skin_girth(body, kind->parts, place.center, place.normal);
  if (!(place.body_m > 0))
    return why = "the skin has no section in its plane", std::nullopt;
  const auto base = body.girths.find("neck_base");
  if (hem.name == "neck" && base != body.girths.end() &&
      place.body_m > WIDER_THAN_NECK * base->second.value_m)
    return why = "it lies on the shoulders, wider than a neck", std::nullopt;
  place.body_spread_m = LEAST_GIRTH_SPREAD;
  for (const double shift : {-EDGE_HEIGHT, EDGE_HEIGHT})
    if (const double moved =
            skin_girth(body, kind->parts, place.center + shift * place.normal, place.normal);
        moved > 0)
      place.body_spread_m = std::max(place.body_spread_m, std::abs(moved - place.body_m));
  return edge;
}

std::optional<FitRow> measure_edge(const ClothState& cloth, const body::Body& body,
                                   const FitHem& hem, double convergence, std::string& why,
                                   const std::vector<Vec3>* source) {
  const Garment& garment = cloth.garment;
  auto edge = edge_line(garment, body, hem, why);
  if (!edge)
    return std::nullopt;
  // An edge that rises and falls around a belly is shorter than the skin's section by its plane; at
  // rest no closed line around the skin is shorter than what it goes around.
  if (garment.converged)
    edge->place.body_m = std::min(edge->place.body_m, edge->line.lying);
  FitRow row = row_of(edge->place, edge->line);
  if (source && edge->line.rest > 0) {
    double worn = 0;
    for (std::size_t i = 0; i < edge->particles.size(); ++i)
      worn += ((*source)[edge->particles[i]] -
               (*source)[edge->particles[(i + 1) % edge->particles.size()]])
                  .norm();
    row.worn_strain = worn / edge->line.rest - 1;
  }
  std::vector<char> in(garment.position.size(), 0);
  for (const int p : edge->particles)
    in[p] = 1;
  const StrainFigures first = strain_of(cloth, ring_of(garment, in));
  take_strain(first, strain_of(cloth, ring_of(garment, in)), row);
  finish_row(cloth, edge->place, edge->line, 0, convergence, row);
  return row;
}

} // namespace sloper::garment
