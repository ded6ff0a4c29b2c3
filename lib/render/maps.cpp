#include <sloper/base/error.hpp>
#include <sloper/garment/fit/cloth_strain.hpp>
#include <sloper/garment/fit/fit.hpp>
#include <sloper/garment/materials.hpp>
#include <sloper/render/maps.hpp>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>

namespace sloper::render {

namespace {

using garment::Garment;

constexpr double E100_TENSION = 98.0665; // N/m, 100 gf/cm
constexpr double NEARLY_NONE = 0.2;      // share of a panel's vertices
constexpr double FAR = 0.3;              // m: gaps are measured up to here

/// Area-weighted means at panel vertices.
struct VertexMean {
  std::vector<double> sum, weight;
  explicit VertexMean(std::size_t n) : sum(n, 0), weight(n, 0) {}
  void add(const Triangle& t, double value, double w) {
    for (int v : t) {
      sum[v] += w * value;
      weight[v] += w;
    }
  }
  std::vector<double> result() {
    for (std::size_t v = 0; v < sum.size(); ++v)
      sum[v] = weight[v] > 0 ? sum[v] / weight[v] : NO_VALUE;
    return std::move(sum);
  }
};

double strain_value(const Garment& g, int panel, const garment::TriangleStrain& s, Map map) {
  switch (map) {
  case Map::WARP: return s.warp;
  case Map::WEFT: return s.weft;
  case Map::BIAS: return s.bias;
  case Map::LIMIT: {
    const garment::Material& m = garment::material_of(g, g.panels.panels[panel].material);
    return std::max({s.warp * m.stretch_warp_n_m, s.weft * m.stretch_weft_n_m, 0.0}) / E100_TENSION;
  }
  default: return s.thread();
  }
}

/// Values of triangles at panel vertices; the triangles' own, by area, for the legend.
std::vector<double> strain_values(const Garment& g, Map map,
                                  std::vector<garment::Weighted>& by_area) {
  VertexMean mean(g.panels.pattern.size());
  const std::vector<garment::TriangleStrain> strains = garment::triangle_strains(g, g.position);
  for (std::size_t p = 0; p < g.panels.panels.size(); ++p) {
    const pattern::PanelInfo& panel = g.panels.panels[p];
    for (int f = panel.first_triangle; f < panel.first_triangle + panel.n_triangles; ++f) {
      if (!(strains[f].area > 0))
        continue;
      const double value = 100 * strain_value(g, static_cast<int>(p), strains[f], map);
      mean.add(g.panels.triangles[f], value, strains[f].area);
      by_area.push_back({value, strains[f].area});
    }
  }
  return mean.result();
}

/// Signed distances of panel vertices to the skin, m.
std::vector<double> gaps(const Garment& g, const collision::BodyCollider& body) {
  std::vector<double> by_particle(g.position.size());
  for (std::size_t i = 0; i < by_particle.size(); ++i) {
    const auto d = body.signed_distance(g.position[i], FAR);
    by_particle[i] = d.triangle < 0 ? FAR : d.distance;
  }
  std::vector<double> by_vertex;
  for (int p : g.particle_of)
    by_vertex.push_back(by_particle[p]);
  return by_vertex;
}

std::vector<double> spread_values(const Garment& g) {
  if (g.redrapes.spread_m.empty())
    throw Error(ErrorKind::USAGE, "render.input-missing"_id, "", "--map spread",
                "needs a garment that was draped repeatedly", "write it with drape --redrapes");
  std::vector<double> by_vertex;
  for (int p : g.particle_of)
    by_vertex.push_back(1000 * g.redrapes.spread_m[p]);
  return by_vertex;
}

std::vector<double> pressure_values(const Garment& g, const collision::BodyCollider& body,
                                    std::vector<garment::Weighted>& by_area) {
  const std::vector<garment::TriangleStrain> strains = garment::triangle_strains(g, g.position);
  const std::vector<double> pressures = garment::contact_pressures(g, strains, body);
  VertexMean mean(g.panels.pattern.size());
  for (std::size_t f = 0; f < strains.size(); ++f) {
    if (!(strains[f].area > 0))
      continue;
    mean.add(g.panels.triangles[f], pressures[f], strains[f].area);
    by_area.push_back({pressures[f], strains[f].area});
  }
  return mean.result();
}

/// By panel vertex: whether it is a sleeve's. A panel that lies nearly all on the arm or off it is
/// taken as a whole, so that the border is the armhole; one that goes on from the trunk into the
/// sleeve is parted where the arm has the greater weight.
std::vector<char> on_sleeves(const Garment& g) {
  std::vector<char> sleeve;
  for (int particle : g.particle_of) {
    double arm = 0;
    for (const garment::BindWeight& w : g.bind.particles[particle])
      if (g.bind.frames[w.frame].find("arm") != std::string::npos)
        arm += w.weight;
    sleeve.push_back(arm > 0.5);
  }
  for (const pattern::PanelInfo& panel : g.panels.panels) {
    const auto first = sleeve.begin() + panel.first_vertex, last = first + panel.n_vertices;
    const double share = panel.n_vertices > 0
                             ? static_cast<double>(std::count(first, last, 1)) / panel.n_vertices
                             : 0;
    if (share < NEARLY_NONE || share > 1 - NEARLY_NONE)
      std::fill(first, last, share > 0.5);
  }
  return sleeve;
}

std::vector<double> ease_values(const Garment& g, const body::Body& body,
                                const collision::BodyCollider& skin) {
  if (g.bind.empty())
    throw Error(ErrorKind::USAGE, "render.input-missing"_id, "", "--map ease",
                "needs a garment that hangs on a body",
                "give the shirt.json that drape or retarget-garment wrote");
  std::map<double, double> ease; // by height
  for (const garment::FitRow& row :
       garment::fit_garment(g, body, skin, garment::standard_fit_policy()).rows)
    if (row.kind == "level")
      ease[row.height_m] = 100 * row.ease_m;
  if (ease.empty())
    throw Error(ErrorKind::USAGE, "render.no-trunk-level"_id, "", "--map ease",
                "no trunk level goes through this garment");
  const std::vector<char> sleeve = on_sleeves(g);
  std::vector<double> values;
  for (std::size_t v = 0; v < g.particle_of.size(); ++v) {
    const double y = g.position[g.particle_of[v]].y();
    const auto above = ease.lower_bound(y);
    if (sleeve[v])
      values.push_back(NO_VALUE);
    else if (above == ease.end())
      values.push_back(ease.rbegin()->second);
    else if (above == ease.begin())
      values.push_back(above->second);
    else {
      const auto below = std::prev(above);
      values.push_back(below->second + (above->second - below->second) * (y - below->first) /
                                           (above->first - below->first));
    }
  }
  return values;
}

constexpr double ALMOST_ALL = 0.99, ALMOST_NONE = 0.01; // quantiles of the area

/// The legend's quantiles, by area. @returns the size that 99 of 100 parts do not exceed
double summarise(std::vector<garment::Weighted> all, Legend& legend) {
  if (all.empty())
    return 0;
  legend.p50 = garment::area_quantile(all, 0.5);
  legend.p1 = garment::area_quantile(all, ALMOST_NONE);
  legend.p99 = garment::area_quantile(all, ALMOST_ALL);
  legend.least = all.front().value;
  legend.largest = all.back().value;
  for (garment::Weighted& v : all)
    v.value = std::abs(v.value);
  return garment::area_quantile(all, ALMOST_ALL);
}

/// How much lies beyond the ends of the scale, by the weights of the quantiles, so that both say
/// the same.
void count_outside(const std::vector<garment::Weighted>& values, Legend& legend) {
  double all = 0, below = 0, beyond = 0;
  const double slack = 1e-9 * (legend.high - legend.low);
  for (const auto& [value, weight] : values) {
    all += weight;
    if (value < legend.low - slack)
      below += weight;
    if (value > legend.high + slack)
      beyond += weight;
  }
  if (all > 0) {
    legend.below = below / all;
    legend.beyond = beyond / all;
  }
}

/// What the legend of a map says, and the ends that its scale may have: such that the borders
/// between eight colours are round numbers.
struct Scale {
  Map map;
  const char *title, *unit;
  bool diverging;              ///< from -end to end
  std::array<double, 10> ends; ///< rising; 0: no more
};

constexpr Scale SCALES[] = {
    {Map::GAP, "gap to the skin", "mm", false, {40, 80, 120, 160, 240, 320}},
    {Map::PENETRATION, "depth in the skin", "mm", false, {0.8, 4, 8, 16, 40, 80}},
    {Map::PRESSURE, "contact pressure", "Pa", false, {80, 160, 400, 800, 1600, 4000, 8000, 40000}},
    {Map::EASE, "ease at the level", "cm", true, {8, 16, 24, 32, 48, 80}},
    {Map::DIFFERENCE, "difference", "mm", false, {0.8, 1.6, 4, 8, 16, 40, 80, 160, 400, 800}},
    {Map::SPREAD, "spread of re-drapes", "mm", false, {0.8, 1.6, 4, 8, 16, 40, 80, 160}},
    {Map::LIMIT, "share of strain limit", "%", false, {8, 16, 40, 80, 160, 400, 1600}},
    {Map::STRAIN, "strain", "%", true, {4, 8, 12, 20, 40}}};

constexpr int N_COLORS = 8; // of a scale
constexpr int NO_PART_COLOR = 0x909090;
constexpr double NO_VALUE_LIGHT = 0.24; // of cloth without a value, in linear light

/// The first end that holds the value, or the last.
double choose_end(double most, const std::array<double, 10>& ends) {
  double last = 0;
  for (double end : ends) {
    if (end == 0)
      break;
    last = end;
    if (most <= end)
      break;
  }
  return last;
}

/// Title, unit and range of a map. @param most of the values that the range should hold
void choose_scale(Map map, double most, Legend& legend) {
  const Scale* scale = &SCALES[std::size(SCALES) - 1]; // strain, of all directions
  for (const Scale& known : SCALES)
    if (known.map == map)
      scale = &known;
  legend.title = scale->title;
  if (scale->map != map)
    legend.title += ", " + map_names()[static_cast<int>(map)];
  legend.unit = scale->unit;
  legend.diverging = scale->diverging;
  legend.high = choose_end(map == Map::PENETRATION ? legend.largest : most, scale->ends);
}

void color_parts(Scene& scene) {
  if (!scene.body)
    throw Error(ErrorKind::USAGE, "render.input-missing"_id, "", "--map parts", "needs a body",
                "give body.json as a document");
  static const int colors[] = {0xc4a484, 0x7fa3c7, 0xd9b45b, 0xc98a9c, 0x7fb69a, 0x9a8fc0};
  DrawMesh& mesh = scene.meshes[scene.body_mesh];
  DrawMesh split = mesh; // corners of their own, so that parts have sharp borders
  split.positions.clear();
  split.normals.clear();
  split.colors.clear();
  std::map<std::array<int, 2>, int> vertex;
  for (std::size_t f = 0; f < mesh.triangles.size(); ++f)
    for (int& v : split.triangles[f]) {
      const int part = static_cast<int>(scene.body->face_part[f]);
      const auto [found, is_new] =
          vertex.try_emplace({part, v}, static_cast<int>(split.positions.size()));
      if (is_new) {
        split.positions.push_back(mesh.positions[v]);
        split.normals.push_back(mesh.normals[v]);
        split.colors.push_back(linear_color(part < body::N_PARTS ? colors[part] : NO_PART_COLOR));
      }
      v = found->second;
    }
  mesh = std::move(split);
}

} // namespace

const std::vector<std::string>& map_names() {
  static const std::vector<std::string> names = {
      "none",     "strain", "warp",        "weft",       "bias",  "limit", "gap",
      "pressure", "ease",   "penetration", "difference", "parts", "spread"};
  return names;
}

Vec3 scale_color(double t, bool diverging) {
  // Anchors in linear light. Sequential: dark blue - teal - yellow, rising evenly in lightness.
  // Diverging: blue - white - red.
  static const Vec3 sequential[] = {{0.06, 0.02, 0.12},
                                    {0.05, 0.09, 0.27},
                                    {0.02, 0.21, 0.26},
                                    {0.07, 0.42, 0.17},
                                    {0.82, 0.78, 0.04}};
  static const Vec3 apart[] = {{0.01, 0.06, 0.30},
                               {0.16, 0.35, 0.60},
                               {0.85, 0.85, 0.83},
                               {0.75, 0.25, 0.14},
                               {0.35, 0.01, 0.02}};
  const Vec3* anchors = diverging ? apart : sequential;
  const double s = std::clamp(diverging ? 0.5 * (t + 1) : t, 0.0, 1.0) * 4;
  const int k = std::min(static_cast<int>(s), 3);
  return anchors[k] + (s - k) * (anchors[k + 1] - anchors[k]);
}

Vec3 no_value_color() {
  return Vec3::Constant(NO_VALUE_LIGHT);
}

Legend apply_map(Scene& scene, Map map, double limit) {
  Legend legend;
  if (map == Map::NONE)
    return legend;
  if (map == Map::PARTS) {
    color_parts(scene);
    return legend;
  }
  const std::string option = "--map " + map_names()[static_cast<int>(map)];
  if (scene.garments.empty())
    throw Error(ErrorKind::USAGE, "render.input-missing"_id, "", option,
                "needs a garment with pattern coordinates", "give shirt.json as a document");
  std::vector<std::vector<double>> values;
  std::vector<garment::Weighted> by_area; // of maps whose values are the triangles' own
  if (map == Map::DIFFERENCE) {
    if (scene.garments.size() != 2)
      throw Error(ErrorKind::USAGE, "render.not-two-drapes"_id, "", option,
                  "compares two garments, not " + std::to_string(scene.garments.size()),
                  "give two shirt.json of one pattern");
    values.push_back(drape_difference(scene.garments[0], scene.garments[1]));
    for (double& v : values[0])
      v = v == NO_VALUE ? v : 1000 * v;
    const int hidden = scene.garment_mesh[1];
    scene.meshes.erase(scene.meshes.begin() + hidden);
    scene.garments.pop_back();
    scene.garment_mesh.pop_back();
    for (int* mesh : {&scene.garment_mesh[0], &scene.body_mesh})
      if (*mesh > hidden)
        --*mesh;
  } else if (map == Map::SPREAD) {
    for (const Garment& g : scene.garments)
      values.push_back(spread_values(g));
  } else if (map == Map::STRAIN || map == Map::WARP || map == Map::WEFT || map == Map::BIAS ||
             map == Map::LIMIT) {
    for (const Garment& g : scene.garments)
      values.push_back(strain_values(g, map, by_area));
  } else {
    if (!scene.body)
      throw Error(ErrorKind::USAGE, "render.input-missing"_id, "", option, "needs the body too",
                  "give body.json as a document");
    const collision::BodyCollider body(scene.body->skin);
    for (const Garment& g : scene.garments) {
      if (map == Map::PRESSURE)
        values.push_back(pressure_values(g, body, by_area));
      if (map == Map::EASE)
        values.push_back(ease_values(g, *scene.body, body));
      if (map != Map::GAP && map != Map::PENETRATION)
        continue;
      values.push_back(gaps(g, body));
      for (double& v : values.back())
        v = 1000 * (map == Map::GAP ? v : std::max(0.0, -v));
    }
  }
  if (by_area.empty())
    for (const auto& list : values)
      for (const double v : list)
        if (v != NO_VALUE)
          by_area.push_back({v, 1});
  const double most = summarise(by_area, legend);
  choose_scale(map, most, legend);
  if (limit > 0)
    legend.high = limit;
  legend.low = legend.diverging ? -legend.high : 0;
  count_outside(by_area, legend);
  for (const auto& list : values)
    legend.has_gaps |= std::count(list.begin(), list.end(), NO_VALUE) > 0;
  constexpr double LAST = N_COLORS - 1;
  for (int k = 0; k < N_COLORS; ++k) {
    const double from_middle = (k - 0.5 * LAST) / (0.5 * LAST);
    legend.steps.push_back(
        scale_color(legend.diverging ? from_middle : k / LAST, legend.diverging));
  }
  for (std::size_t g = 0; g < values.size(); ++g)
    scene.meshes[scene.garment_mesh[g]].values = values[g];
  return legend;
}

std::string values_csv(const Scene& scene, const Legend& legend) {
  std::string text =
      "document,panel,s,t,x_m,y_m,z_m," +
      (legend.title.empty() ? "value" : legend.title.substr(0, legend.title.find(','))) + "_" +
      (legend.unit == "%" ? "percent" : legend.unit) + "\n";
  std::replace(text.begin(), text.end(), ' ', '_');
  char buffer[32];
  auto number = [&](double x) {
    return std::string(buffer, std::to_chars(buffer, buffer + sizeof buffer, x).ptr);
  };
  for (std::size_t g = 0; g < scene.garments.size(); ++g) {
    const Garment& garment = scene.garments[g];
    const std::vector<double>& values = scene.meshes[scene.garment_mesh[g]].values;
    for (std::size_t v = 0; v < garment.particle_of.size(); ++v) {
      const pattern::StableId& id = garment.panels.ids[v];
      const Vec3& p = garment.position[garment.particle_of[v]];
      std::string panel = garment.panels.panels[id.panel].name;
      if (panel.find_first_of(",\"\n") != std::string::npos) {
        for (std::size_t at = 0; (at = panel.find('"', at)) != std::string::npos; at += 2)
          panel.insert(at, 1, '"');
        panel = "\"" + panel + "\"";
      }
      text += std::to_string(g + 1) + "," + panel + "," + number(id.s) + "," + number(id.t) + "," +
              number(p.x()) + "," + number(p.y()) + "," + number(p.z()) + "," +
              (values.empty() || values[v] == NO_VALUE ? "" : number(values[v])) + "\n";
    }
  }
  return text;
}

} // namespace sloper::render
