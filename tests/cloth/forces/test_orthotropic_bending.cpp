/// Bending by direction: exact on cylinders along any direction of the pattern, whatever the mesh;
/// forces and matrices against the energy; softening.
#include <support/force_checks.hpp>

#include <array>
#include <cmath>
#include <set>
#include <sloper/cloth/forces/bending.hpp>
#include <sloper/cloth/forces/dihedral_bending.hpp>
#include <sloper/cloth/forces/orthotropic_bending.hpp>

using namespace sloper;
using namespace sloper::cloth;

namespace {

Fabric directional(double warp, double weft, double bias) {
  Fabric f;
  f.bend_warp_n_m = warp;
  f.bend_weft_n_m = weft;
  f.bend_bias_n_m = bias;
  return f;
}

/// The grid with inner particles moved in the plane, in the pattern and in space.
Grid make_uneven_grid(int n, double size, const Fabric& fabric, std::uint64_t seed) {
  const Grid even = make_grid(n, size, fabric);
  const double step = size / (n - 1);
  Random random(seed);
  std::vector<Vec2> flat;
  for (int k = 0; k < n * n; ++k) {
    const bool inner = k % n > 0 && k % n < n - 1 && k / n > 0 && k / n < n - 1;
    flat.emplace_back((k % n) * step + (inner ? random.uniform(-0.25, 0.25) * step : 0),
                      (k / n) * step + (inner ? random.uniform(-0.25, 0.25) * step : 0));
  }
  std::vector<RestTriangle> triangles = even.mesh.triangles;
  for (RestTriangle& t : triangles)
    for (int c = 0; c < 3; ++c)
      t.flat[c] = flat[t.particle[c]];
  Grid out{make_cloth_mesh(n * n, triangles, {fabric}), {}};
  for (const Vec2& p : flat)
    out.x.emplace_back(p.x(), 0, -p.y());
  return out;
}

/// The sheet rolled on a cylinder of this radius, curved along the direction at `angle` from warp.
std::vector<Vec3> rolled(const std::vector<Vec3>& flat, double radius, double angle) {
  std::vector<Vec3> out;
  for (const Vec3& p : flat) {
    const double u = p.x(), v = -p.z(), along = v * std::cos(angle) + u * std::sin(angle),
                 across = v * std::sin(angle) - u * std::cos(angle);
    out.emplace_back(radius * std::sin(along / radius), radius * (1 - std::cos(along / radius)),
                     across);
  }
  return out;
}

std::vector<double> flat_rest(const Grid& g) {
  return std::vector<double>(g.mesh.hinges.size());
}

std::set<std::array<int, 2>> ordered(const std::vector<std::array<int, 2>>& pairs) {
  std::set<std::array<int, 2>> out;
  for (const auto& [a, b] : pairs)
    out.insert({std::min(a, b), std::max(a, b)});
  return out;
}

double energy_of(const Grid& g, const std::vector<Vec3>& x, bool by_angles) {
  return by_angles ? OrthotropicBendingEffect(g.mesh, flat_rest(g)).energy(x)
                   : OrthotropicBendingEffect(g.mesh).energy(x);
}

} // namespace

TEST(OrthotropicBending, a_cylinder_along_any_direction_has_the_energy_of_that_direction) {
  const double size = 0.1, radius = 0.2;
  for (const Fabric& fabric : {directional(2e-5, 1e-5, 1.2e-5), directional(1e-5, 4e-5, 0.5e-5),
                               directional(1e-5, 1e-5, 2e-5), directional(3e-5, 1e-5, 0)}) {
    const Grid g = make_uneven_grid(13, size, fabric, 3);
    for (int degrees : {0, 20, 45, 70, 90, 135}) {
      const double angle = degrees * M_PI / 180,
                   exact = 0.5 * rigidity_along(plate_rigidity(fabric), angle) * size * size /
                           (radius * radius);
      const auto x = rolled(g.x, radius, angle);
      EXPECT_NEAR(energy_of(g, x, false) / exact, 1, 0.003) << degrees << " degrees";
      EXPECT_NEAR(energy_of(g, x, true) / exact, 1, 0.003) << degrees << " degrees, angles";
    }
  }
}

TEST(OrthotropicBending, the_rigidities_given_are_those_along_warp_weft_and_bias) {
  for (double bias : {0.2e-5, 0.7e-5, 1.5e-5, 4e-5}) {
    const PlateRigidity plate = plate_rigidity(directional(2e-5, 1e-5, bias));
    EXPECT_NEAR(rigidity_along(plate, 0), 2e-5, 1e-18);
    EXPECT_NEAR(rigidity_along(plate, M_PI / 2), 1e-5, 1e-18);
    EXPECT_NEAR(rigidity_along(plate, M_PI / 4), bias, 1e-18);
    EXPECT_GE(plate.twist, 0);
    EXPECT_LE(std::abs(plate.coupling), std::sqrt(2e-10) * (1 + 1e-12)) << "not stable";
  }
  EXPECT_NEAR(rigidity_along(plate_rigidity(directional(2e-5, 2e-5, 0)), 0.3), 2e-5, 1e-18)
      << "alike in all directions";
}

TEST(OrthotropicBending, a_strip_cut_on_the_bias_twists_and_so_seems_softer_than_its_cylinder) {
  EXPECT_NEAR(bias_of_strip(1e-5, 1e-5, 1e-5), 1e-5, 1e-18) << "alike in all directions";
  // The compliance of that plate along the bias is the strip's.
  const double bias = bias_of_strip(2e-5, 1e-5, 1.1e-5);
  const PlateRigidity plate = plate_rigidity(directional(2e-5, 1e-5, bias));
  EXPECT_NEAR(4 / (1 / plate.warp + 1 / plate.weft + 1 / plate.twist), 1.1e-5, 1e-17);
  EXPECT_NEAR(bias_of_strip(2e-5, 1e-5, 3e-5), 3.75e-5, 1e-18) << "no more than a quarter more";
  EXPECT_NEAR(bias_of_strip(2e-5, 1e-5, 0.1e-5), 0.125e-5, 1e-18);
}

TEST(OrthotropicBending, a_sheet_without_inner_triangles_still_resists) {
  // A strap one triangle wide: the hinges leave a direction open, and the smallest curvature is
  // taken.
  const Fabric fabric = directional(1e-5, 1e-5, 1e-5);
  std::vector<RestTriangle> triangles;
  std::vector<Vec3> x;
  std::vector<Vec2> flat;
  for (int k = 0; k < 12; ++k) {
    flat.emplace_back(k % 2 ? 0.008 : 0, 0.005 * k);
    x.emplace_back(flat.back().x(), 0, -flat.back().y());
  }
  for (int k = 0; k + 2 < 12; ++k) {
    const std::array<int, 3> p = k % 2 ? std::array{k, k + 2, k + 1} : std::array{k, k + 1, k + 2};
    triangles.push_back({{p[0], p[1], p[2]}, {flat[p[0]], flat[p[1]], flat[p[2]]}, 0});
  }
  const Grid g{make_cloth_mesh(12, triangles, {fabric}), x};
  const double area = 10 * 0.5 * 0.008 * 0.01, exact = 0.5 * 1e-5 * area / (0.1 * 0.1);
  EXPECT_NEAR(energy_of(g, rolled(x, 0.1, 0), false) / exact, 1, 0.2);
}

TEST(OrthotropicBending, force_is_minus_energy_gradient) {
  for (double soft : {0.0, 0.6}) {
    Fabric fabric = directional(2e-5, 0.8e-5, 1.1e-5);
    fabric.bend_soft_share = soft;
    fabric.bend_soft_radius_m = 0.02;
    const Grid g = make_uneven_grid(5, 0.1, fabric, 4);
    std::vector<double> rest(g.mesh.hinges.size());
    for (std::size_t h = 0; h < rest.size(); ++h)
      rest[h] = 0.3 * std::sin(static_cast<double>(h));
    OrthotropicBendingEffect vectors(g.mesh), angles(g.mesh, rest);
    expect_gradient(vectors, g.mesh, jittered(g.x, 0.004, 10));
    expect_gradient(angles, g.mesh, jittered(g.x, 0.004, 11));
    expect_rigid_motion_invariance(vectors, g.mesh, jittered(g.x, 0.004, 12));
    expect_rigid_motion_invariance(angles, g.mesh, jittered(g.x, 0.004, 12));
  }
}

TEST(OrthotropicBending, stiffness_with_rest_angles_is_minus_force_gradient) {
  const Grid g = make_uneven_grid(5, 0.1, directional(2e-5, 0.8e-5, 1.1e-5), 4);
  const auto x = jittered(g.x, 0.003, 14);
  std::vector<double> rest;
  for (const Hinge& h : g.mesh.hinges)
    rest.push_back(hinge_angle(h, x));
  OrthotropicBendingEffect angles(g.mesh, rest); // exact at the rest angles
  EXPECT_LT(angles.energy(x), 1e-20);
  expect_jacobian(angles, g.mesh, x, 1e-5);
}

TEST(OrthotropicBending, stiffness_bounds_the_force_gradient_and_couples_no_more_than_hinges) {
  for (const Fabric& fabric :
       {directional(1e-5, 1e-5, 0), directional(2e-5, 0.8e-5, 1.1e-5), directional(5e-5, 1e-6, 0)})
    for (std::uint64_t seed : {4, 5, 6}) {
      const Grid g = make_uneven_grid(6, 0.1, fabric, seed);
      const int n = g.mesh.n_particles;
      OrthotropicBendingEffect effect(g.mesh);
      BendingEffect hinges(g.mesh);
      Couplings couplings, of_hinges;
      effect.declare(couplings);
      hinges.declare(of_hinges);
      const std::set<std::array<int, 2>> allowed = ordered(of_hinges.isotropic);
      for (const std::array<int, 2>& pair : ordered(couplings.isotropic))
        EXPECT_TRUE(allowed.contains(pair)) << pair[0] << " and " << pair[1];
      BlockMatrix matrix(n, couplings);
      effect.bind(matrix);
      Eigen::MatrixXd exact(n, n); // of one coordinate: forces are linear
      std::vector<Vec3> x(n, Vec3::Zero());
      for (int k = 0; k < n; ++k) {
        x[k].x() = 1;
        BlockMatrix unused(n, couplings);
        const auto force = force_of(effect, n, x, unused);
        for (int i = 0; i < n; ++i)
          exact(i, k) = -force[i].x();
        x[k].x() = 0;
      }
      force_of(effect, n, g.x, matrix);
      const Eigen::MatrixXd upper = dense(matrix), all = upper.selfadjointView<Eigen::Upper>();
      Eigen::MatrixXd given(n, n);
      for (int i = 0; i < n; ++i)
        for (int k = 0; k < n; ++k)
          given(i, k) = all(3 * i, 3 * k);
      const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(1.5 * given - exact);
      EXPECT_GT(eigen.eigenvalues()[0], -1e-9 * eigen.eigenvalues().tail(1)[0]);
      if (fabric.bend_warp_n_m > 10 * fabric.bend_weft_n_m)
        continue; // no cloth; the soft direction then has far more than its own
      for (double degrees : {0.0, 30.0, 45.0, 90.0}) {
        const auto bent = rolled(g.x, 0.3, degrees * M_PI / 180);
        Eigen::VectorXd height(n);
        for (int i = 0; i < n; ++i)
          height[i] = bent[i].y();
        EXPECT_GT(height.dot(exact * height), 0.3 * height.dot(given * height)) << degrees;
      }
    }
}

TEST(OrthotropicBending, stiffness_is_definite_also_where_it_softens) {
  Fabric fabric = directional(2e-5, 0.8e-5, 0.2e-5);
  fabric.bend_soft_share = 0.8;
  const Grid g = make_uneven_grid(4, 0.05, fabric, 5);
  for (bool by_angles : {false, true}) {
    OrthotropicBendingEffect effect(g.mesh, by_angles ? std::optional(flat_rest(g)) : std::nullopt);
    Couplings couplings;
    effect.declare(couplings);
    BlockMatrix matrix(g.mesh.n_particles, couplings);
    effect.bind(matrix);
    force_of(effect, g.mesh.n_particles, jittered(g.x, 0.01, 15), matrix);
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(
        Eigen::MatrixXd(dense(matrix).selfadjointView<Eigen::Upper>()));
    EXPECT_GT(eigen.eigenvalues()[0], -1e-9 * eigen.eigenvalues().tail(1)[0]);
  }
}

TEST(OrthotropicBending, a_softening_fabric_loses_its_share_where_it_curves_sharply) {
  Fabric fabric = directional(1e-5, 1e-5, 1e-5);
  fabric.bend_soft_share = 0.5;
  fabric.bend_soft_radius_m = 0.01;
  const Fabric linear = directional(1e-5, 1e-5, 1e-5);
  const Grid soft = make_grid(21, 0.02, fabric), plain = make_grid(21, 0.02, linear);
  auto left = [&](double radius) {
    const auto x = rolled(soft.x, radius, 0.4);
    return energy_of(soft, x, false) / energy_of(plain, x, false);
  };
  EXPECT_NEAR(left(1), 1, 0.001);
  EXPECT_NEAR(left(0.01), 0.5 + std::sqrt(2.0) - 1, 0.003); // E at 1 / radius = bend_soft_radius_m
  EXPECT_LT(left(0.003), 0.75);
}

TEST(OrthotropicBending, a_pressed_fold_has_no_moment) {
  Grid g = make_grid(5, 0.1, directional(1e-5, 1e-5, 1e-5));
  auto x = g.x; // folded along the middle column of particles
  for (Vec3& p : x)
    if (p.x() > 0.0501)
      p = Vec3(0.05, p.x() - 0.05, p.z());
  EXPECT_GT(energy_of(g, x, true), 1e-6);
  for (Hinge& h : g.mesh.hinges)
    h.pressed = std::abs(g.x[h.particle[0]].x() - 0.05) < 1e-9 &&
                std::abs(g.x[h.particle[1]].x() - 0.05) < 1e-9;
  EXPECT_LT(energy_of(g, x, true), 1e-20);
}
