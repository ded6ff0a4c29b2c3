#include <garment/simulate/audit.hpp>
#include <sloper/collision/intersections.hpp>
#include <sloper/garment/fit/cloth_strain.hpp>

#include <algorithm>
#include <cmath>

namespace sloper::garment {

static void measure_strain(const Garment& garment, Audit& result) {
  std::vector<Weighted> warp, weft, bias, thread;
  for (const TriangleStrain& s : triangle_strains(garment, garment.position)) {
    if (!(s.area > 0))
      continue;
    warp.push_back({s.warp, s.area});
    weft.push_back({s.weft, s.area});
    bias.push_back({s.bias, s.area});
    thread.push_back({s.thread(), s.area});
  }
  const auto quantiles = [](std::vector<Weighted>& values, double out[3]) {
    if (values.empty())
      return;
    out[0] = area_quantile(values, 0.5);
    out[1] = area_quantile(values, 0.99);
    out[2] = values.back().value;
  };
  quantiles(warp, result.strain_warp);
  quantiles(weft, result.strain_weft);
  quantiles(bias, result.strain_bias);
  double of_all[3] = {};
  quantiles(thread, of_all);
  result.strain_p99 = of_all[1];
  result.strain_max = of_all[2];
}

Audit audit(const Garment& garment, const collision::BodyCollider* body) {
  Audit result;
  const std::vector<Triangle> triangles = garment.particle_triangles();
  collision::TriangleTree tree(garment.position, triangles);
  result.self = collision::self_intersections(garment.position, triangles, tree);
  measure_strain(garment, result);
  if (!body)
    return result;
  result.through = body->faces_through(garment.position, triangles);
  for (std::size_t i = 0; i < garment.position.size(); ++i) {
    const Vec3& p = garment.position[i];
    if (!body->is_inside(p))
      continue;
    result.inside.push_back(static_cast<int>(i));
    result.deepest_m =
        std::max(result.deepest_m, std::abs(body->signed_distance(p, 1e30).distance));
  }
  return result;
}

} // namespace sloper::garment
