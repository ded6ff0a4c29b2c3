/// The effects that a scene may ask for: forces against their energies, matrices against their
/// forces, and what each is for.
#include <support/force_checks.hpp>

#include <cmath>
#include <sloper/cloth/forces/attachments.hpp>
#include <sloper/cloth/forces/bending.hpp>
#include <sloper/cloth/forces/dihedral_bending.hpp>
#include <sloper/cloth/forces/edge_spring.hpp>
#include <sloper/cloth/forces/elastic_band.hpp>
#include <sloper/cloth/forces/membrane.hpp>
#include <sloper/cloth/forces/pins.hpp>
#include <sloper/cloth/forces/pressure.hpp>
#include <sloper/cloth/forces/shear.hpp>
#include <sloper/cloth/forces/triangle_stretch.hpp>
#include <sloper/cloth/forces/wind.hpp>

using namespace sloper;
using namespace sloper::cloth;

namespace {

std::vector<Vec3> scaled(std::vector<Vec3> x, double by) {
  for (Vec3& p : x)
    p *= by;
  return x;
}

/// A closed octahedron of radius r.
Grid make_octahedron(double r) {
  Grid g;
  g.x = {{r, 0, 0}, {-r, 0, 0}, {0, r, 0}, {0, -r, 0}, {0, 0, r}, {0, 0, -r}};
  std::vector<RestTriangle> triangles;
  const double side = r * std::sqrt(2.0);
  for (int a : {0, 1})
    for (int b : {2, 3})
      for (int c : {4, 5}) {
        const bool even = (a + b + c) % 2 == 0; // of the signs: outward orientation
        triangles.push_back({{a, even ? b : c, even ? c : b},
                             {Vec2(0, 0), Vec2(side, 0), Vec2(side / 2, side * std::sqrt(0.75))},
                             0});
      }
  g.mesh = make_cloth_mesh(6, triangles, {Fabric{}});
  return g;
}

} // namespace

TEST(TriangleStretch, force_is_minus_energy_gradient_also_when_shrunk) {
  const Grid g = make_grid(5, 0.1);
  TriangleStretchEffect plain(g.mesh),
      shrunk(g.mesh, std::vector<Shrink>(g.mesh.triangles.size(), {0.8, 0.9}));
  expect_gradient(plain, g.mesh, jittered(g.x, 0.004, 1));
  expect_gradient(shrunk, g.mesh, jittered(g.x, 0.004, 2));
}

TEST(TriangleStretch, moves_with_the_cloth) {
  const Grid g = make_grid(5, 0.1);
  TriangleStretchEffect effect(g.mesh, std::vector<Shrink>(g.mesh.triangles.size(), {0.8, 0.9}));
  expect_rigid_motion_invariance(effect, g.mesh, jittered(g.x, 0.004, 3));
}

TEST(TriangleStretch, stiffness_is_minus_force_gradient) {
  const Grid g = make_grid(5, 0.1);
  TriangleStretchEffect effect(g.mesh);
  expect_jacobian(effect, g.mesh, jittered(scaled(g.x, 1.2), 0.0005, 4), 1e-5);
  expect_jacobian(effect, g.mesh, jittered(g.x, 0.004, 4), 1e-5, true);
  expect_jacobian(effect, g.mesh, jittered(scaled(g.x, 0.9), 0.0005, 5), 1e-5, true);
}

TEST(TriangleStretch, a_shrunk_square_is_at_rest_at_b_u_by_b_v) {
  const Grid g = make_grid(5, 0.1);
  TriangleStretchEffect effect(g.mesh, std::vector<Shrink>(g.mesh.triangles.size(), {0.8, 0.9}));
  auto x = g.x;
  for (Vec3& p : x)
    p = Vec3(0.8 * p.x(), 0, 0.9 * p.z()); // weft lies along x, warp along z
  EXPECT_LT(effect.energy(x), 1e-20);
  EXPECT_GT(effect.energy(g.x), 1e-3);
}

TEST(TriangleStretch, follows_rest_lengths_that_an_edit_changed) {
  const Grid g = make_grid(5, 0.1);
  std::vector<RestTriangle> triangles = g.mesh.triangles;
  const std::vector<std::array<double, 3>> scale(triangles.size(), {1.1, 1.1, 1.1});
  const ClothMesh longer = make_cloth_mesh(25, triangles, {Fabric{}}, scale);
  TriangleStretchEffect stretch(longer);
  MembraneEffect membrane(longer);
  EXPECT_LT(stretch.energy(scaled(g.x, 1.1)), 1e-18);
  EXPECT_LT(membrane.energy(scaled(g.x, 1.1)), 1e-18);
  EXPECT_GT(stretch.energy(g.x), 1e-3);
}

TEST(TriangleStretch, one_percent_compression_makes_the_assembled_exact_matrix_indefinite) {
  const Grid g = make_grid(5, 0.1);
  for (bool exact : {true, false}) {
    TriangleStretchEffect stretch(g.mesh);
    MembraneEffect membrane(g.mesh);
    for (Effect* effect : {static_cast<Effect*>(&stretch), static_cast<Effect*>(&membrane)}) {
      Couplings couplings;
      effect->declare(couplings);
      BlockMatrix matrix(g.mesh.n_particles, couplings);
      effect->bind(matrix);
      force_of(*effect, g.mesh.n_particles, scaled(g.x, 0.99), matrix);
      if (exact)
        effect->add_indefinite_part(scaled(g.x, 0.99), matrix);
      const double h = 1.0 / 30; // with the inertia of the paper's own step
      for (int i = 0; i < g.mesh.n_particles; ++i)
        matrix.add_diagonal(i, g.mesh.mass[i] / (h * h) * Mat3::Identity());
      const double least =
          Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(dense(matrix)).eigenvalues()[0];
      if (exact)
        EXPECT_LT(least, -0.1) << effect->name();
      else
        EXPECT_GT(least, 0) << effect->name();
    }
  }
}

TEST(Membrane, force_is_minus_energy_gradient) {
  const Grid g = make_grid(5, 0.1);
  MembraneEffect effect(g.mesh);
  expect_gradient(effect, g.mesh, jittered(g.x, 0.004, 6));
}

TEST(Membrane, moves_with_the_cloth) {
  const Grid g = make_grid(5, 0.1);
  MembraneEffect effect(g.mesh);
  expect_rigid_motion_invariance(effect, g.mesh, jittered(g.x, 0.004, 7));
}

TEST(Membrane, stiffness_is_minus_force_gradient) {
  const Grid g = make_grid(5, 0.1);
  MembraneEffect effect(g.mesh);
  expect_jacobian(effect, g.mesh, jittered(scaled(g.x, 1.1), 0.002, 8), 1e-5, true);
  expect_jacobian(effect, g.mesh, jittered(scaled(g.x, 0.9), 0.002, 9), 1e-5, true);
}

TEST(Membrane, a_strip_pulled_along_the_warp_has_the_stretch_stiffness_and_narrows_by_poisson) {
  Fabric fabric;
  fabric.stretch_warp_n_m = 2000;
  fabric.stretch_weft_n_m = 1000;
  fabric.poisson = 0.3;
  const Grid g = make_grid(6, 0.1, fabric);
  MembraneEffect effect(g.mesh);
  const double strain = 1e-5;
  auto energy = [&](double narrowing) {
    auto x = g.x;
    for (Vec3& p : x)
      p = Vec3(p.x() * (1 - narrowing * strain), 0, p.z() * (1 + strain));
    return effect.energy(x) / 0.01;
  };
  double best = 0;
  for (double n = 0; n < 0.6; n += 0.001)
    if (energy(n) < energy(best))
      best = n;
  EXPECT_NEAR(best, 0.3, 0.002);
  EXPECT_NEAR(energy(best), 0.5 * 2000 * strain * strain,
              1e-3 * energy(best)); // to first order in strain
}

TEST(DihedralBending, force_is_minus_energy_gradient_with_rest_angles) {
  const Grid g = make_grid(5, 0.1);
  std::vector<double> rest(g.mesh.hinges.size());
  for (std::size_t h = 0; h < rest.size(); ++h)
    rest[h] = 0.3 * std::sin(static_cast<double>(h));
  DihedralBendingEffect effect(g.mesh, rest);
  expect_gradient(effect, g.mesh, jittered(g.x, 0.004, 10));
  expect_rigid_motion_invariance(effect, g.mesh, jittered(g.x, 0.004, 10));
}

TEST(DihedralBending, stiffness_is_minus_force_gradient_at_the_rest_angle) {
  const Grid g = make_grid(5, 0.1);
  const auto x = jittered(g.x, 0.003, 11);
  std::vector<double> rest;
  for (const Hinge& h : g.mesh.hinges)
    rest.push_back(hinge_angle(h, x));
  DihedralBendingEffect effect(g.mesh, rest);
  EXPECT_LT(effect.energy(x), 1e-20);
  expect_jacobian(effect, g.mesh, x, 1e-5);
}

TEST(DihedralBending, agrees_with_the_isometric_model_for_small_angles) {
  const Grid g = make_grid(9, 0.1);
  auto x = g.x;
  for (Vec3& p : x)
    p.y() = 0.05 * p.x() * p.x();
  DihedralBendingEffect dihedral(g.mesh);
  BendingEffect isometric(g.mesh);
  EXPECT_NEAR(dihedral.energy(x), isometric.energy(x), 1e-3 * isometric.energy(x));
}

TEST(Pins, hold_with_the_force_they_report) {
  const Grid g = make_grid(3, 0.1);
  PinsEffect effect({{0, g.x[0] + Vec3(0.01, 0.02, 0), 500, Vec3::Zero()},
                     {4, g.x[4] + Vec3(0, 0.03, 0.01), 800, Vec3::UnitY()}});
  expect_gradient(effect, g.mesh, g.x, false);
  expect_jacobian(effect, g.mesh, g.x, 1e-6);
  EXPECT_LT((effect.force(0, g.x) - Vec3(5, 10, 0)).norm(), 1e-12);
  EXPECT_LT((effect.force(1, g.x) - Vec3(0, 0, 8)).norm(), 1e-12) << "free along y";
}

TEST(Attachments, pull_and_never_push) {
  const Grid g = make_grid(3, 0.1);
  AttachmentsEffect effect(
      {{0, g.x[0] + Vec3(0, 0.2, 0.1), 0.1, 50}, {4, g.x[4] + Vec3(0, 0.05, 0), 0.1, 50}});
  expect_gradient(effect, g.mesh, jittered(g.x, 0.004, 12), false);
  expect_jacobian(effect, g.mesh, g.x, 1e-5);
  AttachmentsEffect slack({{0, g.x[0] + Vec3(0, 0.05, 0), 0.1, 50}});
  EXPECT_EQ(slack.energy(g.x), 0);
}

TEST(ElasticBand, force_is_minus_energy_gradient_where_taut_and_slack) {
  const Grid g = make_grid(5, 0.1);
  ElasticBandEffect effect({{0, 1, 0.02, 30}, {1, 2, 0.02, 30}, {3, 2, 0.05, 30}});
  expect_gradient(effect, g.mesh, jittered(g.x, 0.002, 13));
  expect_jacobian(effect, g.mesh, jittered(g.x, 0.002, 13), 1e-5);
  EXPECT_EQ(effect.tension(2, g.x), 0) << "slack";
  EXPECT_NEAR(effect.tension(0, g.x), 30 * (0.025 / 0.02 - 1), 1e-9);
}

TEST(Wind, pushes_a_plate_with_half_rho_c_v_squared_per_area) {
  const Grid g = make_grid(5, 0.1);
  WindOptions options;
  options.velocity = Vec3(0, 5, 0); // across the plate
  WindEffect effect(g.mesh.particle_triangles(), options);
  BlockMatrix matrix(g.mesh.n_particles, {});
  effect.begin_step(g.x, 0.1);
  Vec3 total = Vec3::Zero();
  for (const Vec3& f : force_of(effect, g.mesh.n_particles, g.x, matrix))
    total += f;
  EXPECT_NEAR(total.y(), 0.5 * 1.2 * 1.2 * 25 * 0.01, 1e-9);
  EXPECT_NEAR(total.x(), 0, 1e-12);
  expect_gradient(effect, g.mesh, jittered(g.x, 0.002, 14), false);
}

TEST(Wind, of_still_air_takes_energy_from_cloth_that_moves) {
  const Grid g = make_grid(5, 0.1);
  WindEffect effect(g.mesh.particle_triangles(), {});
  const double h = 0.01;
  const Vec3 v(0, 3, 1);
  auto x = g.x;
  effect.begin_step(x, h);
  for (Vec3& p : x)
    p += h * v;
  effect.begin_step(x, h);
  BlockMatrix matrix(g.mesh.n_particles, {});
  std::vector<Vec3> force(x.size(), Vec3::Zero()), product(x.size());
  std::vector<ContactElement> elements;
  StepContext c{x, h, force, matrix, elements};
  effect.add(c);
  matrix.multiply(std::vector<Vec3>(x.size(), h * v),
                  product); // D/h dx: the drag over a step at this velocity
  double power = 0;
  for (std::size_t i = 0; i < x.size(); ++i)
    power += (force[i] - product[i]).dot(v);
  EXPECT_NEAR(power, -0.5 * 1.2 * (1.2 * 27 + 0.02 * 1) * 0.01, 1e-6);
}

TEST(Pressure, is_the_gradient_of_the_volume_of_a_closed_cloth) {
  const Grid g = make_octahedron(0.1);
  PressureEffect effect(g.mesh.particle_triangles(), 200);
  EXPECT_NEAR(-effect.energy(g.x), 200 * 4.0 / 3 * 1e-3, 1e-12);
  expect_gradient(effect, g.mesh, jittered(g.x, 0.01, 15));
  expect_rigid_motion_invariance(effect, g.mesh, jittered(g.x, 0.01, 15));
}

TEST(Pressure, pushes_an_open_sheet_with_p_times_area) {
  const Grid g = make_grid(5, 0.1);
  PressureEffect effect(g.mesh.particle_triangles(), 200);
  BlockMatrix matrix(g.mesh.n_particles, {});
  Vec3 total = Vec3::Zero();
  for (const Vec3& f : force_of(effect, g.mesh.n_particles, g.x, matrix))
    total += f;
  EXPECT_LT((total - Vec3(0, 2, 0)).norm(), 1e-9) << total.transpose();
  expect_gradient(effect, g.mesh, jittered(g.x, 0.01, 16),
                  false); // the rim's correction holds where add() was called
}
