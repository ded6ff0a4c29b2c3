#include <garment/simulate/audit.hpp>
#include <sloper/base/parallel.hpp>
#include <sloper/collision/intersections.hpp>
#include <sloper/garment/fit/cloth_strain.hpp>

#include <algorithm>
#include <cmath>

namespace sloper::garment {

static constexpr std::size_t PARTICLE_GRAIN = 128;

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

std::vector<int> inside_body(const std::vector<Vec3>& positions,
                             const collision::BodyCollider& body) {
  std::vector<char> inside(positions.size(), 0);
  parallel_for(positions.size(), PARTICLE_GRAIN, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i)
      inside[i] = static_cast<char>(body.is_inside(positions[i]));
  });
  std::vector<int> found;
  for (std::size_t i = 0; i < inside.size(); ++i)
    if (inside[i])
      found.push_back(static_cast<int>(i));
  return found;
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
  result.inside = inside_body(garment.position, *body);
  for (const int i : result.inside)
    result.deepest_m = std::max(
        result.deepest_m, std::abs(body->signed_distance(garment.position[i], 1e30).distance));
  return result;
}

} // namespace sloper::garment
