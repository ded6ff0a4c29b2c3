#include <base/error.hpp>
#include <collision/body_collider.hpp>
#include <render/scene.hpp>

#include <algorithm>
#include <cmath>

namespace sloper::render {

namespace {

void summarise(std::vector<double> values, Legend& legend) {
  if (values.empty()) return;
  std::sort(values.begin(), values.end());
  const auto last = static_cast<double>(values.size() - 1);
  legend.p50 = values[static_cast<std::size_t>(0.5 * last)];
  legend.p99 = values[static_cast<std::size_t>(0.99 * last)];
  legend.largest = values.back();
}

/// Length-weighted mean strain of the edges around each panel vertex.
std::vector<double> vertex_strain(const garment::Garment& g) {
  const pattern::PanelMesh& panels = g.panels;
  std::vector<double> sum(panels.pattern.size(), 0), weight(panels.pattern.size(), 0);
  for (const Triangle& t : panels.triangles)
    for (int k = 0; k < 3; ++k) {
      const int a = t[k], b = t[(k + 1) % 3];
      const double rest = (panels.pattern[b] - panels.pattern[a]).norm();
      if (rest <= 0) continue;
      const double stretched = (g.position[g.particle_of[b]] - g.position[g.particle_of[a]]).norm() - rest;
      for (int v : {a, b}) {
        sum[v] += stretched;
        weight[v] += rest;
      }
    }
  for (std::size_t v = 0; v < sum.size(); ++v) sum[v] /= std::max(weight[v], 1e-12);
  return sum;
}

void color_cloth(Scene& scene, const std::vector<std::vector<double>>& values, const Legend& legend) {
  std::size_t at = 0;
  for (DrawMesh& mesh : scene.meshes) {
    if (!mesh.is_cloth || at >= values.size()) continue;
    for (std::size_t v = 0; v < values[at].size(); ++v) {
      const double span = legend.diverging ? legend.high : legend.high - legend.low;
      mesh.colors[v] = scale_color((values[at][v] - (legend.diverging ? 0 : legend.low)) / std::max(span, 1e-12), legend.diverging);
    }
    ++at;
  }
}

} // namespace

Vec3 scale_color(double t, bool diverging) {
  // Anchors in linear light. Sequential: dark blue - teal - yellow, rising evenly in lightness. Diverging: blue - white - red.
  static const Vec3 sequential[] = {{0.06, 0.02, 0.12}, {0.05, 0.09, 0.27}, {0.02, 0.21, 0.26}, {0.07, 0.42, 0.17}, {0.82, 0.78, 0.04}};
  static const Vec3 apart[] = {{0.01, 0.06, 0.30}, {0.16, 0.35, 0.60}, {0.85, 0.85, 0.83}, {0.75, 0.25, 0.14}, {0.35, 0.01, 0.02}};
  const Vec3* anchors = diverging ? apart : sequential;
  const double s = std::clamp(diverging ? 0.5 * (t + 1) : t, 0.0, 1.0) * 4;
  const int k = std::min(static_cast<int>(s), 3);
  return anchors[k] + (s - k) * (anchors[k + 1] - anchors[k]);
}

Legend apply_map(Scene& scene, Map map) {
  Legend legend;
  if (map == Map::NONE) return legend;
  if (map == Map::PARTS) {
    if (!scene.body) throw Error(ErrorKind::USAGE, "", "--map parts", "needs a body", "give body.json as a document");
    static const Vec3 colors[] = {{0.55, 0.30, 0.10}, {0.10, 0.25, 0.50}, {0.65, 0.45, 0.05}, {0.60, 0.10, 0.20}, {0.05, 0.35, 0.20}, {0.30, 0.15, 0.45}};
    for (DrawMesh& mesh : scene.meshes) {
      if (mesh.is_cloth || mesh.triangles.size() != scene.body->face_part.size()) continue;
      for (std::size_t f = 0; f < mesh.triangles.size(); ++f)
        for (int v : mesh.triangles[f]) mesh.colors[v] = colors[std::min<int>(static_cast<int>(scene.body->face_part[f]), 5)];
    }
    return legend;
  }
  if (scene.garments.empty()) throw Error(ErrorKind::USAGE, "", "--map", "needs a garment with pattern coordinates", "give shirt.json as a document");
  std::vector<std::vector<double>> values;
  std::vector<double> all;
  if (map == Map::STRAIN) {
    for (const garment::Garment& g : scene.garments) values.push_back(vertex_strain(g));
    legend = {"strain", "%", 0, 0, 0, 0, 0, true};
  } else {
    if (!scene.body) throw Error(ErrorKind::USAGE, "", "--map gap", "needs the body too", "give body.json as a document");
    const collision::BodyCollider body(scene.body->skin);
    for (const garment::Garment& g : scene.garments) {
      std::vector<double> gap(g.position.size());
      for (std::size_t i = 0; i < gap.size(); ++i) {
        const auto d = body.signed_distance(g.position[i], 0.3);
        gap[i] = d.triangle < 0 ? 0.3 : d.distance;
      }
      values.emplace_back();
      for (int p : g.particle_of) values.back().push_back(gap[p]);
    }
    legend = {"gap to the skin", "mm", 0, 0, 0, 0, 0, false};
  }
  const double unit = map == Map::STRAIN ? 100 : 1000;
  for (auto& list : values)
    for (double& v : list) all.push_back(v *= unit);
  summarise(all, legend);
  if (map == Map::STRAIN) {
    legend.high = legend.p99 > 5 ? 20 : 5; // fixed ranges, so that pictures can be compared
    legend.low = -legend.high;
  } else {
    legend.high = legend.p99 > 50 ? 150 : 50;
  }
  color_cloth(scene, values, legend);
  return legend;
}

} // namespace sloper::render
