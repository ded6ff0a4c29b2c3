#include <garment/drapemeter/shadow.hpp>
#include <garment/fit/fit_section.hpp>
#include <sloper/base/error.hpp>
#include <sloper/collision/skin_cache.hpp>
#include <sloper/garment/fit/cloth_strain.hpp>
#include <sloper/garment/fit/fit.hpp>
#include <sloper/garment/redrape/spread.hpp>
#include <sloper/geometry/triangle_mesh.hpp>
#include <sloper/io/json.hpp>

#include <algorithm>
#include <cmath>

namespace sloper::garment {

namespace {

constexpr double SHADOW_CELL = 0.002; // m
constexpr double LEVEL_STEP = 0.1;    // m: heights at which pairs are cut, as compare-drape does

struct Distance {
  double rms, max;
};
Distance distance_of(const Garment& a, const Garment& b) {
  double sum = 0, most = 0;
  for (std::size_t i = 0; i < a.position.size(); ++i) {
    const double d2 = (a.position[i] - b.position[i]).squaredNorm();
    sum += d2;
    most = std::max(most, d2);
  }
  return {std::sqrt(sum / static_cast<double>(a.position.size())), std::sqrt(most)};
}

/// The free edge that lies lowest, in order; empty where there is none.
std::vector<int> lowest_free_edge(const std::vector<Triangle>& triangles,
                                  const std::vector<Vec3>& position) {
  std::map<int, std::vector<int>> next;
  for (const auto& [a, b] : free_edges_of(triangles)) {
    next[a].push_back(b);
    next[b].push_back(a);
  }
  std::vector<int> best;
  double lowest = 1e300;
  std::map<int, bool> seen;
  for (const auto& [start, unused] : next) {
    if (seen[start])
      continue;
    std::vector<int> loop{start};
    seen[start] = true;
    for (bool goes_on = true; goes_on;) {
      goes_on = false;
      for (int to : next[loop.back()])
        if (!seen[to]) {
          loop.push_back(to);
          goes_on = seen[to] = true;
          break;
        }
    }
    double height = 0;
    for (int p : loop)
      height += position[p].y() / static_cast<double>(loop.size());
    if (loop.size() >= 3 && height < lowest) {
      lowest = height;
      best = std::move(loop);
    }
  }
  return best;
}

/// Length of cloth in a level cut, without sleeves, m.
double cut_length(const Garment& garment, double height) {
  std::vector<char> use(garment.panels.triangles.size(), 1);
  for (const pattern::PanelInfo& panel : garment.panels.panels)
    if (panel.part.rfind("arm", 0) == 0)
      std::fill_n(use.begin() + panel.first_triangle, panel.n_triangles, 0);
  double length = 0;
  for (const SectionChain& chain : cut_garment(garment, use, Vec3(0, height, 0), Vec3::UnitY()))
    length += chain.length;
  return length;
}

/// What one drape is measured by.
struct Measured {
  double strain_p50 = 0, strain_p99 = 0;
  std::vector<double> cuts; ///< m, at heights that are the same for all
};

Measured measure(const Garment& garment, const std::vector<double>& heights) {
  Measured out;
  std::vector<Weighted> values;
  for (const TriangleStrain& s : triangle_strains(garment, garment.position))
    if (s.area > 0)
      values.push_back({std::abs(s.thread()), s.area});
  out.strain_p50 = area_quantile(values, 0.5);
  out.strain_p99 = area_quantile(values, 0.99);
  for (double height : heights)
    out.cuts.push_back(cut_length(garment, height));
  return out;
}

using Samples = std::map<std::string, std::map<std::string, std::vector<double>>>;

/// Those that every drape has.
std::map<std::string, std::map<std::string, SpreadFigure>> figures_of(const Samples& samples,
                                                                      std::size_t n) {
  std::map<std::string, std::map<std::string, SpreadFigure>> out;
  for (const auto& [row, figures] : samples)
    for (const auto& [name, values] : figures)
      if (values.size() == n)
        out[row][name] = spread_figure(values);
  return out;
}

std::vector<double> spread_of_places(const std::vector<const Garment*>& drapes) {
  const auto n = static_cast<double>(drapes.size());
  std::vector<double> out;
  for (std::size_t i = 0; i < drapes[0]->position.size(); ++i) {
    Vec3 mean = Vec3::Zero();
    for (const Garment* g : drapes)
      mean += g->position[i] / n;
    double sum = 0;
    for (const Garment* g : drapes)
      sum += (g->position[i] - mean).squaredNorm();
    out.push_back(std::sqrt(sum / (n - 1)));
  }
  return out;
}

double flat_area(const Garment& garment) {
  double sum = 0;
  for (const TriangleStrain& s : triangle_strains(garment, garment.position))
    sum += s.area;
  return sum;
}

} // namespace

double SpreadFigure::error() const {
  return n > 0 ? sd / std::sqrt(static_cast<double>(n)) : 0;
}

SpreadFigure spread_figure(const std::vector<double>& values) {
  SpreadFigure out;
  out.n = static_cast<int>(values.size());
  for (double v : values)
    out.mean += v / static_cast<double>(values.size());
  for (double v : values)
    out.sd += (v - out.mean) * (v - out.mean);
  out.sd = out.n > 1 ? std::sqrt(out.sd / (out.n - 1)) : 0;
  return out;
}

Spread measure_spread(const RedrapeSet& set, const body::Body* body) {
  Spread out;
  out.count = static_cast<int>(set.garments.size());
  if (!set.garments.empty())
    for (const pattern::PanelInfo& panel : set.garments[0].panels.panels)
      out.panels.push_back(panel.name);
  out.to_medoid_m.assign(set.garments.size(), -1);
  std::vector<const Garment*> drapes;
  std::vector<std::size_t> number;
  for (std::size_t k = 0; k < set.garments.size(); ++k)
    if (set.garments[k].converged) {
      drapes.push_back(&set.garments[k]);
      number.push_back(k);
    }
  out.at_rest = static_cast<int>(drapes.size());
  if (drapes.size() < 2) {
    out.medoid = drapes.empty() ? 0 : static_cast<int>(number[0]);
    return out;
  }
  const std::vector<Triangle> triangles = drapes[0]->particle_triangles();
  double low = 1e300, high = -1e300;
  for (const Garment* g : drapes) {
    if (g->position.size() != drapes[0]->position.size())
      throw input_error("drape.meshes-differ"_id, "", "", "the drapes have not the same mesh");
    for (const Vec3& p : g->position) {
      low = std::min(low, p.y());
      high = std::max(high, p.y());
    }
  }
  std::vector<double> heights;
  for (double k = std::ceil(low / LEVEL_STEP); k * LEVEL_STEP <= high; ++k)
    heights.push_back(k * LEVEL_STEP);

  std::vector<Measured> measured;
  std::vector<double> p50, p99, folds, shadow, percent;
  const double flat = flat_area(*drapes[0]);
  for (const Garment* g : drapes) {
    measured.push_back(measure(*g, heights));
    p50.push_back(measured.back().strain_p50);
    p99.push_back(measured.back().strain_p99);
    std::vector<Vec3> rim;
    for (int p : lowest_free_edge(triangles, g->position))
      rim.push_back(g->position[p]);
    folds.push_back(count_folds(rim));
    shadow.push_back(shadow_area(triangles, g->position, SHADOW_CELL));
    percent.push_back(flat > 0 ? 100 * shadow.back() / flat : 0);
  }
  out.strain_p50 = spread_figure(p50);
  out.strain_p99 = spread_figure(p99);
  out.folds = spread_figure(folds);
  out.shadow_m2 = spread_figure(shadow);
  out.drape_percent = spread_figure(percent);

  std::map<std::string, std::vector<double>> pairs;
  std::vector<std::vector<double>> rms(drapes.size(), std::vector<double>(drapes.size(), 0));
  for (std::size_t a = 0; a < drapes.size(); ++a)
    for (std::size_t b = a + 1; b < drapes.size(); ++b) {
      const Distance d = distance_of(*drapes[a], *drapes[b]);
      rms[a][b] = rms[b][a] = d.rms;
      double cut = 0;
      for (std::size_t h = 0; h < heights.size(); ++h)
        cut = std::max(cut, std::abs(measured[a].cuts[h] - measured[b].cuts[h]));
      pairs["rms_mm"].push_back(1000 * d.rms);
      pairs["max_mm"].push_back(1000 * d.max);
      pairs["strain_p99"].push_back(std::abs(p99[a] - p99[b]));
      pairs["girth_cm"].push_back(100 * cut);
    }
  for (const auto& [name, values] : pairs)
    out.pairs[name] = spread_figure(values);
  std::size_t medoid = 0;
  double least = 1e300;
  for (std::size_t a = 0; a < drapes.size(); ++a) {
    double sum = 0;
    for (double r : rms[a])
      sum += r * r;
    if (sum < least) {
      least = sum;
      medoid = a;
    }
  }
  out.medoid = static_cast<int>(number[medoid]);
  for (std::size_t a = 0; a < drapes.size(); ++a)
    out.to_medoid_m[number[a]] = rms[medoid][a];
  out.particles_m = spread_of_places(drapes);
  if (!body || drapes[0]->bind.empty())
    return out;

  const collision::BodyCollider skin = collision::make_collider(body->skin, body->skin_cache.get());
  Samples rows, hems;
  for (const Garment* g : drapes) {
    const FitReport fit = fit_garment(*g, *body, skin, standard_fit_policy());
    for (const FitRow& row : fit.rows) {
      auto& figures = rows[row.name];
      figures["lying_cm"].push_back(100 * row.lying_m);
      figures["ease_cm"].push_back(100 * row.ease_m);
      figures["strain_p99"].push_back(row.strain_p99);
      figures["gap_p50_mm"].push_back(1000 * row.gap_p50_m);
    }
    for (const FitHem& hem : fit.lines.hems) {
      hems[hem.name]["height_cm"].push_back(100 * hem.height_m);
      hems[hem.name]["length_cm"].push_back(100 * hem.length_m);
    }
  }
  out.girths = figures_of(rows, drapes.size());
  out.hems = figures_of(hems, drapes.size());
  return out;
}

void keep_spread(const Spread& spread, Garment& garment) {
  garment.redrapes = {};
  if (spread.at_rest < 2)
    return;
  garment.redrapes.count = spread.at_rest;
  garment.redrapes.spread_m = spread.particles_m;
  for (const auto& [row, figures] : spread.girths)
    garment.redrapes.girths[row] = {1e-2 * figures.at("ease_cm").sd, figures.at("strain_p99").sd,
                                    1e-3 * figures.at("gap_p50_mm").sd};
  for (const auto& [hem, figures] : spread.hems)
    garment.redrapes.hems_m[hem] = 1e-2 * figures.at("height_cm").sd;
}

io::Json spread_json(const Spread& spread, const RedrapeRequest& request, const std::string& tool) {
  const auto figure = [](const SpreadFigure& f) {
    return io::Json{{"mean", f.mean}, {"sd", f.sd}, {"error", f.error()}};
  };
  const auto table = [&](const auto& rows) {
    io::Json out = io::Json::object();
    for (const auto& [row, figures] : rows)
      for (const auto& [name, f] : figures)
        out[row][name] = figure(f);
    return out;
  };
  io::Json document = io::new_document("spread", 1, tool);
  document["redrapes"] = spread.count;
  document["at_rest"] = spread.at_rest;
  document["seed"] = request.seed;
  document["jitter"] = {{"turn_rad", request.jitter.turn_rad},
                        {"offset_m", request.jitter.offset_m},
                        {"order_m", request.jitter.order_m}};
  document["panels"] = spread.panels;
  document["medoid"] = spread.medoid;
  document["to_medoid_mm"] = io::Json::array();
  for (double d : spread.to_medoid_m)
    document["to_medoid_mm"].push_back(d < 0 ? io::Json() : io::Json(1000 * d));
  document["pairs"] = io::Json::object();
  for (const auto& [name, f] : spread.pairs)
    document["pairs"][name] = figure(f);
  document["strain_p50"] = figure(spread.strain_p50);
  document["strain_p99"] = figure(spread.strain_p99);
  document["folds"] = figure(spread.folds);
  document["shadow_m2"] = figure(spread.shadow_m2);
  document["drape_percent"] = figure(spread.drape_percent);
  document["girths"] = table(spread.girths);
  document["hems"] = table(spread.hems);
  std::vector<double> all = spread.particles_m;
  std::sort(all.begin(), all.end());
  const auto quantile = [&](double q) {
    return all.empty()
               ? 0
               : 1000 * all[static_cast<std::size_t>(q * static_cast<double>(all.size() - 1))];
  };
  document["places_mm"] = {{"p50", quantile(0.5)}, {"p95", quantile(0.95)}, {"max", quantile(1)}};
  return document;
}

} // namespace sloper::garment
