#include <support/shapes.hpp>

#include <garment/fit/fit_measure.hpp>
#include <garment/simulate/audit.hpp>
#include <sloper/collision/body_collider.hpp>
#include <sloper/garment/fit/cloth_strain.hpp>
#include <sloper/garment/materials.hpp>

#include <gtest/gtest.h>

#include <cmath>

namespace sloper::garment {

namespace {

/// Cloth on a cylinder about y, weft around it, rest lengths those of the pattern: stretched where
/// the pattern is shorter.
Garment tube(double radius, double around, double along) {
  Garment g;
  const int n = 96, rows = 24;
  pattern::PanelInfo p;
  p.name = "tube";
  for (int r = 0; r <= rows; ++r)
    for (int c = 0; c <= n; ++c) {
      const double angle = 2 * M_PI * c / n;
      g.particle_of.push_back(std::ssize(g.position));
      g.position.emplace_back(radius * std::sin(angle), 0.4 * r / rows, radius * std::cos(angle));
      g.panels.pattern.emplace_back(2 * M_PI * radius / (1 + around) * c / n,
                                    0.4 / (1 + along) * r / rows);
      g.panels.ids.push_back({0, 0.0, 0.0});
    }
  for (int r = 0; r < rows; ++r)
    for (int c = 0; c < n; ++c) {
      const int a = r * (n + 1) + c, b = a + 1, d = a + n + 1;
      g.panels.triangles.push_back({a, b, d + 1});
      g.panels.triangles.push_back({a, d + 1, d});
    }
  p.n_vertices = static_cast<int>(g.position.size());
  p.n_triangles = static_cast<int>(g.panels.triangles.size());
  g.panels.panels.push_back(p);
  g.panels.placed = g.position;
  return g;
}

} // namespace

// A flat triangle beside a seam, its edges 6 % longer at most, was 34 % higher and had a skirt
// refused.
TEST(cloth_strain, the_largest_is_that_of_a_place_and_not_of_one_triangle) {
  Garment g = tube(0.15, 0.02, 0);
  const int inner = 12 * 97 + 40; // far from both edges
  g.position[inner].y() +=
      0.008; // half of a cell: triangles above it are pressed together, those below are drawn out
  const collision::BodyCollider skin(shapes::cylinder(0.149, -0.2, 0.6, 96));
  const ClothState cloth(g, skin);
  double single = 0;
  std::vector<int> all;
  for (std::size_t f = 0; f < cloth.strains.size(); ++f) {
    single = std::max(single, cloth.strains[f].thread());
    all.push_back(static_cast<int>(f));
  }
  const StrainFigures figures = strain_of(cloth, all);
  EXPECT_GT(single, 0.3);
  EXPECT_LT(figures.max, 0.5 * single);
  EXPECT_GT(figures.max, 0.02) << "but more than elsewhere";
}

TEST(cloth_strain, threads_and_diagonals_of_a_stretched_tube_are_those_that_were_made) {
  const Garment g = tube(0.15, 0.1, 0.02);
  for (const TriangleStrain& s : triangle_strains(g, g.position)) {
    EXPECT_NEAR(s.weft, 0.1, 1e-3); // chords for arcs
    EXPECT_NEAR(s.warp, 0.02, 1e-9);
    EXPECT_NEAR(s.bias, std::sqrt(0.5 * (1.1 * 1.1 + 1.02 * 1.02)) - 1, 1e-3);
    EXPECT_NEAR(s.thread(), s.weft, 1e-12);
  }
}

TEST(cloth_strain, edited_rest_lengths_count) {
  Garment g = tube(0.15, 0, 0);
  g.rest_scale.assign(g.panels.triangles.size(), {1 / 1.05, 1 / 1.05, 1 / 1.05});
  for (const TriangleStrain& s : triangle_strains(g, g.position))
    EXPECT_NEAR(s.warp, 0.05, 1e-9);
}

TEST(cloth_strain, the_audit_tells_the_same_strain) {
  const Garment g = tube(0.15, 0.1, 0.02);
  const Audit a = audit(g, nullptr);
  EXPECT_NEAR(a.strain_weft[1], 0.1, 1e-3);
  EXPECT_NEAR(a.strain_warp[2], 0.02, 1e-9);
  EXPECT_NEAR(a.strain_p99, 0.1, 1e-3);
}

TEST(cloth_strain, a_stretched_tube_presses_with_tension_over_radius_where_it_touches) {
  const double radius = 0.15;
  const Garment g = tube(radius, 0.1, 0.02);
  const double expected = material_of(g, "").stretch_weft_n_m * 0.1 /
                          radius; // the warp runs straight down and presses nowhere
  std::vector<Weighted> touching, away;
  const std::vector<TriangleStrain> strains = triangle_strains(g, g.position);
  for (const double p : contact_pressures(
           g, strains, collision::BodyCollider(shapes::cylinder(radius - 0.001, -0.2, 0.6, 96))))
    touching.push_back({p, 1});
  EXPECT_NEAR(area_quantile(touching, 0.5), expected, 0.02 * expected);
  for (const double p : contact_pressures(
           g, strains, collision::BodyCollider(shapes::cylinder(radius - 0.02, -0.2, 0.6, 96))))
    EXPECT_EQ(p, 0);
  const Garment slack = tube(radius, -0.05, -0.05);
  for (const double p :
       contact_pressures(slack, triangle_strains(slack, slack.position),
                         collision::BodyCollider(shapes::cylinder(radius - 0.001, -0.2, 0.6, 96))))
    EXPECT_EQ(p, 0);
}

TEST(cloth_strain, quantiles_are_by_area) {
  std::vector<Weighted> values = {{3, 1}, {1, 8}, {2, 1}};
  EXPECT_EQ(area_quantile(values, 0.5), 1);
  EXPECT_EQ(area_quantile(values, 0.85), 2);
  EXPECT_EQ(area_quantile(values, 1), 3);
}

} // namespace sloper::garment
