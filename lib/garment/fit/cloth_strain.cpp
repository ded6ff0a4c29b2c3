#include <sloper/garment/fit/cloth_strain.hpp>
#include <sloper/garment/materials.hpp>

#include <algorithm>
#include <cmath>

namespace sloper::garment {

namespace {

using Flat = Eigen::Matrix2d;
using Deformation = Eigen::Matrix<double, 3, 2>;

/// A triangle's relaxed shape over its pattern shape, which is `sides`: the lengths of its edges
/// times their edits.
Flat relaxed(const Flat& sides, const std::array<double, 3>& scale) {
  const double a = sides.col(0).norm() * scale[0],
               b = (sides.col(1) - sides.col(0)).norm() * scale[1],
               c = sides.col(1).norm() * scale[2];
  if (!(a > 0 && c > 0))
    return Flat::Identity();
  const double x = (a * a + c * c - b * b) / (2 * a);
  Flat shape;
  shape << a, x, 0, std::sqrt(std::max(1e-18, c * c - x * x));
  return shape * sides.inverse(); // its turn does not matter: only lengths are asked
}

/// Columns: the sides of a triangle from its first corner, weft and warp coordinates.
Flat sides_in_grain(const Garment& g, const Triangle& t, const Vec2& warp) {
  const Vec2 weft(warp.y(), -warp.x());
  Flat sides;
  for (int k = 0; k < 2; ++k) {
    const Vec2 e = g.panels.pattern[t[k + 1]] - g.panels.pattern[t[0]];
    sides.col(k) << e.dot(weft), e.dot(warp);
  }
  return sides;
}

/// The smaller principal stretch of a deformation, less 1.
double least_stretch(const Deformation& f) {
  const Flat c = f.transpose() * f;
  const double mean = 0.5 * c.trace(), half = std::hypot(0.5 * (c(0, 0) - c(1, 1)), c(0, 1));
  return std::sqrt(std::max(mean - half, 0.0)) - 1;
}

} // namespace

std::vector<TriangleStrain> triangle_strains(const Garment& garment,
                                             const std::vector<Vec3>& position) {
  std::vector<TriangleStrain> strains(garment.panels.triangles.size());
  const double r = std::sqrt(0.5);
  for (const pattern::PanelInfo& panel : garment.panels.panels)
    for (int f = panel.first_triangle; f < panel.first_triangle + panel.n_triangles; ++f) {
      const Triangle& t = garment.panels.triangles[f];
      const Flat sides = sides_in_grain(garment, t, panel.grain.normalized());
      const double area = 0.5 * std::abs(sides.determinant());
      if (area < 1e-12)
        continue;
      Deformation moved;
      for (int k = 0; k < 2; ++k)
        moved.col(k) =
            position[garment.particle_of[t[k + 1]]] - position[garment.particle_of[t[0]]];
      moved = moved * sides.inverse();
      const Flat rest = garment.rest_scale.empty() ? Flat(Flat::Identity())
                                                   : relaxed(sides, garment.rest_scale[f]);
      const auto along = [&](const Vec2& d) {
        return (moved * d).norm() / std::max((rest * d).norm(), 1e-12) - 1;
      };
      const double rising = along({r, r}), falling = along({r, -r});
      strains[f] = {along({0, 1}), along({1, 0}),
                    std::abs(rising) >= std::abs(falling) ? rising : falling, area,
                    least_stretch(moved * rest.inverse())};
    }
  return strains;
}

std::vector<double> contact_pressures(const Garment& garment,
                                      const std::vector<TriangleStrain>& strains,
                                      const collision::BodyCollider& skin) {
  const std::vector<Vec3> normals =
      vertex_normals({garment.position, garment.particle_triangles()});
  std::vector<double> pressures(strains.size(), 0);
  int hint = -1;
  for (const pattern::PanelInfo& panel : garment.panels.panels) {
    const Material& m = material_of(garment, panel.material);
    for (int f = panel.first_triangle; f < panel.first_triangle + panel.n_triangles; ++f) {
      const double tension[] = {m.stretch_weft_n_m * std::max(strains[f].weft, 0.0),
                                m.stretch_warp_n_m * std::max(strains[f].warp, 0.0)};
      if (!(strains[f].area > 0) || !(tension[0] + tension[1] > 0))
        continue;
      const Triangle& t = garment.panels.triangles[f];
      const Vec3 &a = garment.position[garment.particle_of[t[0]]],
                 &b = garment.position[garment.particle_of[t[1]]],
                 &c = garment.position[garment.particle_of[t[2]]];
      const double reach = garment.offset_m + TOUCHING_M;
      const collision::SignedDistance d = skin.signed_distance((a + b + c) / 3, 2 * reach, hint);
      if (d.triangle < 0 || d.distance > reach)
        continue;
      hint = d.triangle;
      const Flat inverse = sides_in_grain(garment, t, panel.grain.normalized()).inverse();
      Deformation moved, turned;
      for (int k = 0; k < 2; ++k) {
        moved.col(k) = garment.position[garment.particle_of[t[k + 1]]] - a;
        turned.col(k) = normals[garment.particle_of[t[k + 1]]] - normals[garment.particle_of[t[0]]];
      }
      moved = moved * inverse;
      turned = turned * inverse;
      for (int k = 0; k < 2; ++k)
        pressures[f] += tension[k] * std::max(0.0, turned.col(k).dot(moved.col(k)) /
                                                       std::max(moved.col(k).squaredNorm(), 1e-12));
    }
  }
  return pressures;
}

double area_quantile(std::vector<Weighted>& values, double q) {
  if (values.empty())
    return 0;
  std::sort(values.begin(), values.end(),
            [](const Weighted& a, const Weighted& b) { return a.value < b.value; });
  double whole = 0, below = 0;
  for (const Weighted& v : values)
    whole += v.area;
  for (const Weighted& v : values)
    if (below += v.area; below >= q * whole)
      return v.value;
  return values.back().value;
}

std::vector<std::optional<double>> strains_around(const Garment& garment,
                                                  const std::vector<TriangleStrain>& strains,
                                                  const std::vector<int>& list) {
  std::vector<Weighted> sums(garment.position.size(), {0, 0}); // strain times area, area
  for (const int f : list) {
    const TriangleStrain& s = strains[f];
    if (!(s.area > 0))
      continue;
    for (const int v : garment.panels.triangles[f]) {
      Weighted& sum = sums[garment.particle_of[v]];
      sum.value += s.area * s.thread();
      sum.area += s.area;
    }
  }
  std::vector<std::optional<double>> places(sums.size());
  for (std::size_t i = 0; i < sums.size(); ++i)
    if (sums[i].area > 0)
      places[i] = sums[i].value / sums[i].area;
  return places;
}

} // namespace sloper::garment
