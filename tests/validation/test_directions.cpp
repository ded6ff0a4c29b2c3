/// Cantilever strips cut from a fabric that bends by direction, at 0, 45 and 90 degrees to warp:
/// each hangs as the heavy elastica of its own rigidity.
#include "at_rest.hpp"
#include "elastica.hpp"
#include "figures.hpp"

#include <gtest/gtest.h>
#include <sloper/cloth/forces/gravity.hpp>
#include <sloper/cloth/forces/membrane.hpp>
#include <sloper/cloth/forces/orthotropic_bending.hpp>
#include <sloper/cloth/forces/pins.hpp>

using namespace sloper;
using namespace sloper::cloth;

namespace {

/// H/W of a clamped strip of n cells along its length of 0.1 m and m across, cut at `angle` from
/// warp; its rigidities times `scale`.
double strip(double angle, double scale, int n, int m, bool by_angles) {
  const double length = 0.1, dx = length / (n + 0.5), density = 0.2;
  Fabric fabric;
  fabric.density_kg_m2 = density;
  fabric.stretch_warp_n_m = fabric.stretch_weft_n_m = 2000;
  fabric.shear_n_m = 500;
  fabric.poisson = 0;
  fabric.damping_s = 0;
  fabric.bend_warp_n_m = 2e-4 * scale;
  fabric.bend_weft_n_m = 1e-4 * scale;
  fabric.bend_bias_n_m = 1.2e-4 * scale;
  fabric.bend_n_m = 1.5e-4 * scale;
  // Three columns are clamped: the hinges over the third one carry a whole cell's curvature, half
  // of it behind the clamp (test_elastica.cpp), and the first keeps the sheet's edge away from
  // there, where triangles take their neighbours' curvature.
  HexSheet s = make_hex_sheet(n + 2, dx, m, fabric);
  // The strip runs along +x of the sheet; warp is +y of the pattern, so the pattern is turned.
  std::vector<RestTriangle> triangles = s.mesh.triangles;
  const double turn = 0.5 * M_PI - angle, c = std::cos(turn), q = std::sin(turn);
  for (RestTriangle& t : triangles)
    for (Vec2& p : t.flat)
      p = Vec2(c * p.x() - q * p.y(), q * p.x() + c * p.y());
  const ClothMesh mesh = make_cloth_mesh(static_cast<int>(s.x.size()), triangles, {fabric});
  ClothSolver solver(mesh, s.x);
  solver.emplace<MembraneEffect>(mesh);
  if (by_angles)
    solver.emplace<OrthotropicBendingEffect>(mesh, std::vector<double>(mesh.hinges.size()));
  else
    solver.emplace<OrthotropicBendingEffect>(mesh);
  solver.emplace<GravityEffect>(mesh, Vec3(0, -9.80665, 0));
  std::vector<Pin> pins;
  for (int k = 0; k < 3; ++k)
    for (int p : s.columns[k])
      pins.push_back({p, s.x[p], 1e4, Vec3::Zero()});
  solver.emplace<PinsEffect>(pins);
  EXPECT_GT(go_to_rest(solver), 0);
  Vec3 tip = Vec3::Zero();
  for (int p : s.columns.back())
    tip += solver.x()[p] / static_cast<double>(s.columns.back().size());
  return -tip.y() / (tip.x() - 1.5 * dx);
}

void expect_strips(bool by_angles, int across, double bound) {
  for (double gamma = 2; gamma < 80 && !by_angles; gamma *= 1.2)
    plot_point("directions", "Romero et al. 2021", gamma, elastica_ratio(gamma));
  // Twice as wide as long: a narrow strip that is cut aslant twists too, and a mesh's free edges
  // are softer by the share of the width that their triangles take (README.md).
  const double weight = 0.2 * 9.80665 * 1e-3; // rho g L^3
  for (double scale : {0.3, 1.0, 4.0})
    for (int degrees : {0, 45, 90}) {
      double of_direction = degrees == 45 ? 1.2e-4 : 1e-4; // N m
      if (degrees == 0)
        of_direction = 2e-4;
      const double rigidity = scale * of_direction, exact = elastica_ratio(weight / rigidity),
                   ours = strip(degrees * M_PI / 180, scale, 16, across, by_angles);
      print_figure("H/W of a strip cut at " + std::to_string(degrees) + " degrees, Gamma " +
                       std::to_string(weight / rigidity).substr(0, 4),
                   ours, exact);
      plot_point("directions", std::to_string(degrees) + " degrees" + (by_angles ? ", angles" : ""),
                 weight / rigidity, ours);
      EXPECT_NEAR(ours / exact, 1, bound) << degrees << " degrees, scale " << scale;
    }
}

} // namespace

TEST(Directions, strips_cut_at_0_45_and_90_degrees_hang_by_their_own_rigidity) {
  expect_strips(false, 30, 0.03);
}
TEST(Directions, and_so_they_do_with_rest_angles) {
  expect_strips(true, 30, 0.03);
}
