#include <collision/intersections.hpp>
#include <garment/audit.hpp>

#include <algorithm>
#include <cmath>
#include <set>

namespace sloper::garment {

static void quantiles(std::vector<double>& values, double out[3]) {
  if (values.empty()) return;
  std::sort(values.begin(), values.end());
  const auto last = static_cast<double>(values.size() - 1);
  out[0] = values[static_cast<std::size_t>(0.5 * last)];
  out[1] = values[static_cast<std::size_t>(0.99 * last)];
  out[2] = values.back();
}

static void measure_strain(const Garment& garment, Audit& result) {
  std::vector<double> warp, weft, bias, all;
  std::set<std::array<int, 2>> seen;
  const pattern::PanelMesh& panels = garment.panels;
  for (const pattern::PanelInfo& panel : panels.panels)
    for (int f = panel.first_triangle; f < panel.first_triangle + panel.n_triangles; ++f)
      for (int k = 0; k < 3; ++k) {
        const int a = panels.triangles[f][k], b = panels.triangles[f][(k + 1) % 3];
        const int pa = garment.particle_of[a], pb = garment.particle_of[b];
        if (!seen.insert({std::min(pa, pb), std::max(pa, pb)}).second) continue;
        const Vec2 d = panels.pattern[b] - panels.pattern[a];
        const double scale = garment.rest_scale.empty() ? 1 : garment.rest_scale[f][k], rest = d.norm() * scale;
        if (rest <= 0) continue;
        const double strain = (garment.position[pb] - garment.position[pa]).norm() / rest - 1;
        const double along = std::abs(d.normalized().dot(panel.grain));
        (along > 0.924 ? warp : along < 0.383 ? weft : bias).push_back(strain); // within 22.5 degrees of an axis
        all.push_back(strain);
      }
  quantiles(warp, result.strain_warp);
  quantiles(weft, result.strain_weft);
  quantiles(bias, result.strain_bias);
  double of_all[3] = {};
  quantiles(all, of_all);
  result.strain_p99 = of_all[1];
  result.strain_max = of_all[2];
}

Audit audit(const Garment& garment, const collision::BodyCollider* body) {
  Audit result;
  const std::vector<Triangle> triangles = garment.particle_triangles();
  collision::TriangleTree tree(garment.position, triangles);
  result.self = collision::self_intersections(garment.position, triangles, tree);
  measure_strain(garment, result);
  if (!body) return result;
  result.through = body->faces_through(garment.position, triangles);
  for (std::size_t i = 0; i < garment.position.size(); ++i) {
    const Vec3& p = garment.position[i];
    if (!body->is_inside(p)) continue;
    result.inside.push_back(static_cast<int>(i));
    result.deepest_m = std::max(result.deepest_m, std::abs(body->signed_distance(p, 1e30).distance));
  }
  return result;
}

} // namespace sloper::garment
